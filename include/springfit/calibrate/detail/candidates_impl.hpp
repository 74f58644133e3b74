// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numeric>

#include <springfit/calibrate/candidates.hpp>
#include <springfit/calibrate/detail/windows_in_time.hpp>
#include <springfit/core/stage.hpp>
#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/score/frequency.hpp>
#include <springfit/score/motion_error.hpp>

namespace springfit {

namespace detail {

/// Newton iterations in which a network must come to rest: one that needs more is of no use.
inline constexpr int scoring_iterations = 60;
inline constexpr int quick_iterations = 25; ///< the same where it need not be tried hard

/// Elastic energy that motions put into the network, summed over all their frames, J; a preload at rest does not count.
template <int Dim>
double energy_in(const SpringNetwork<Dim, double>& network, const std::vector<Motion<Dim, double>>& motions) {
    const double at_rest = elastic_energy(network, network.rest_positions);
    double energy = 0;
    for (const auto& motion : motions) {
        for (const auto& positions : motion.positions) {
            energy += elastic_energy(network, positions) - at_rest;
        }
    }
    return energy;
}

/// Makes candidates, one kind after another.
template <int Dim>
class CandidateMaker {
public:
    CandidateMaker(const std::vector<NamedNetwork<Dim>>& given, const RecordedCases<Dim, double>& cases,
                   const CalibrateOptions& options)
        : m_given(given), m_cases(cases), m_options(options), m_stiffness_damping(cases.stiffness_damping),
          m_knows_damping(cases.knows_damping) {}

    [[nodiscard]] Candidates<Dim> make() {
        take_given();
        const Method method = m_options.method;
        // Whoever cut the recording short does not wait for the long fit.
        if (method == Method::trajectory || (matches_motion(method) && !m_cases.interrupted)) {
            try {
                match_motion();
            } catch (const InvalidArgument& error) { // as of a recording with uneven frames
                m_result.warnings.push_back({.code = WarningCode::motion_not_matched,
                                             .about = "trajectory",
                                             .message = text("motion is not matched: ", error.what()),
                                             .advice = {},
                                             .values = {}});
            }
        }
        if (method != Method::closed_form && method != Method::trajectory && !m_result.interrupted) {
            fit_accelerations();
        }
        compare();
        return std::move(m_result);
    }

    /// The same given networks, and the matching of a candidate of theirs gone on with.
    [[nodiscard]] Candidates<Dim> go_on(const Candidate<Dim>& candidate) {
        m_start = candidate.trajectory->theta;
        m_stiffness_damping = candidate.stiffness_damping;
        m_knows_damping = true;
        take_given();
        match_motion();
        compare();
        return std::move(m_result);
    }

private:
    void take_given() {
        for (const auto& named : m_given) {
            Candidate<Dim> candidate{.name = named.name, .network = named.network};
            candidate.n_clamped = named.n_clamped;
            candidate.caveat = named.caveat;
            set_damping(candidate.network);
            m_result.all.push_back(std::move(candidate));
        }
    }

    /// Tells all candidates what they have in common, and how stiff each is.
    void compare() {
        const double energy = energy_in(m_result.all.front().network, m_cases.training.motions);
        for (auto& candidate : m_result.all) {
            candidate.stiffness_damping = m_stiffness_damping;
            candidate.relative_stiffness = energy_in(candidate.network, m_cases.training.motions) / energy;
        }
    }

    void set_damping(SpringNetwork<Dim, double>& network) const {
        network.damping = m_options.damping == DampingRule::ratio
                              ? mass_stiffness_damping(network, m_options.zeta)
                              : stiffness_proportional_damping(network, m_stiffness_damping);
    }

    /// The given network that is nearest to the half of the training equilibria that move least; the first where there
    /// are none.
    [[nodiscard]] const SpringNetwork<Dim, double>& nearest() const {
        const auto& training = m_cases.training;
        std::vector<std::pair<double, std::size_t>> by_size;
        for (std::size_t c = 0; c < training.size(); ++c) {
            const auto& motion = training.motions[c];
            if (training.is_static(c)) {
                by_size.emplace_back((motion.positions.front() - motion.rest_positions).norm(), c);
            }
        }
        std::sort(by_size.begin(), by_size.end());
        std::vector<std::size_t> numbers;
        for (std::size_t c = 0; c < (by_size.size() + 1) / 2; ++c) {
            numbers.push_back(by_size[c].second);
        }
        const auto statics = training.subset(numbers);
        const auto scenarios = statics.scenarios();
        std::size_t best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t c = 0; c < m_given.size() && !statics.empty(); ++c) {
            const double error =
                motion_error(
                    m_result.all[c].network, scenarios, statics.motions, {},
                    {.max_iterations = quick_iterations, .stop_at_failure = true, .execution = m_options.execution})
                    .error;
            if (error < least) {
                least = error;
                best = c;
            }
        }
        return m_result.all[best].network;
    }

    /// Numbers of the training cases that a fit learns from: the equilibria or the motions in time, or what there is.
    [[nodiscard]] std::vector<std::size_t> learnt_from(bool equilibria) const {
        std::vector<std::size_t> all(m_cases.training.size());
        std::iota(all.begin(), all.end(), std::size_t(0));
        std::vector<std::size_t> own;
        std::copy_if(all.begin(), all.end(), std::back_inserter(own),
                     [&](std::size_t c) { return m_cases.training.is_static(c) == equilibria; });
        return own.empty() || m_options.learn_from_all ? all : own;
    }

    void match_motion() {
        SpringNetwork<Dim, double> prior = m_options.start ? m_result.all[*m_options.start].network : nearest();
        const auto motions = m_cases.training.subset(learnt_from(true)).motions;
        const bool in_time =
            std::any_of(motions.begin(), motions.end(), [](const auto& motion) { return motion.n_frames() > 1; });
        TrajectoryOptions how;
        how.execution = m_options.execution;
        how.prior_weight = m_options.prior_weight;
        if (in_time) {
            how.horizon = m_options.horizon;
            how.steps_per_frame =
                m_options.steps_per_frame > 0 ? m_options.steps_per_frame : steps_per_frame(motions, how.horizon);
            how.parameters.damping.fit = m_options.damping == DampingRule::fitted && (prior.damping.array() > 0).any();
        }
        Stage stage(m_options.progress, "fit trajectory");
        if (in_time && m_options.damping == DampingRule::proportional && !m_knows_damping) {
            const auto found = find_damping(prior, motions, how, m_options.damping_ratio, stage.part());
            m_stiffness_damping = found.beta;
            m_start = found.theta;
            for (auto& candidate : m_result.all) {
                set_damping(candidate.network);
            }
            set_damping(prior);
        }
        if (m_options.damping == DampingRule::proportional) {
            how.parameters.damping_per_stiffness = m_stiffness_damping;
        }
        for (bool is_refined = false;; is_refined = true) {
            std::optional<Candidate<Dim>> candidate = matched(prior, motions, how, stage);
            m_result.interrupted = stage.stopped();
            if (!candidate) {
                return;
            }
            if (in_time) { // halved steps tell the error of the integrator
                candidate->steps_per_frame = how.steps_per_frame;
                auto finer = how;
                finer.steps_per_frame *= 2;
                const double misfit = candidate->trajectory->misfit;
                candidate->step_error = std::abs(window_misfit(candidate->network, motions, finer) / misfit - 1);
                const bool is_last = is_refined || m_options.steps_per_frame > 0 ||
                                     how.steps_per_frame == most_steps_per_frame || stage.stopped();
                if (candidate->step_error > step_error_limit && !is_last) { // it falls with the square of the steps
                    const double more = std::sqrt(candidate->step_error / step_error_limit);
                    how.steps_per_frame =
                        static_cast<int>(std::min<double>(most_steps_per_frame, std::ceil(how.steps_per_frame * more)));
                    m_start = candidate->trajectory->theta;
                    continue;
                }
            }
            candidate->seconds = stage.seconds();
            m_result.all.push_back(std::move(*candidate));
            return;
        }
    }

    /// The prior, matched to motions; none where nothing usable came about.
    [[nodiscard]] std::optional<Candidate<Dim>> matched(const SpringNetwork<Dim, double>& prior,
                                                        const std::vector<Motion<Dim, double>>& motions,
                                                        const TrajectoryOptions& how, Stage& stage) const {
        const TrajectoryProblem<Dim> problem(prior, motions, how);
        GaussNewtonOptions engine;
        engine.start = m_start;
        engine.max_iterations = m_options.matching_iterations;
        engine.tolerance = m_options.matching_tolerance;
        engine.progress = [&, report = stage.part()](const Progress& progress) {
            const bool is_late = m_options.matching_seconds && stage.seconds() > *m_options.matching_seconds;
            return report(progress) && !is_late;
        };
        Candidate<Dim> candidate{.name = "trajectory", .network = prior};
        auto& report = candidate.trajectory.emplace(gauss_newton(problem, engine));
        if (!usable(report.status)) {
            return std::nullopt;
        }
        if (report.status == Status::interrupted && !stage.stopped()) {
            report.status = Status::iteration_limit; // its time is a budget like another
        }
        apply(problem, report, candidate.network);
        if (m_options.damping == DampingRule::ratio) {
            set_damping(candidate.network);
        }
        candidate.data_share.resize(prior.n_springs());
        for (Index e = 0; e < prior.n_springs(); ++e) {
            candidate.data_share(e) = report.data_share(problem.parameters().unknown(MotionParameter::stiffness, e));
        }
        return candidate;
    }

    void fit_accelerations() {
        // The prior is what a spring gets that no motion excites.
        const SpringNetwork<Dim, double> prior = m_result.all[m_options.start.value_or(0)].network;
        const Stopwatch assembling;
        AccelerationOptions<double> how;
        how.parameters.damping.fit = m_options.damping == DampingRule::fitted;
        if (m_options.damping == DampingRule::proportional) {
            how.parameters.damping_per_stiffness = m_stiffness_damping;
        }
        const AccelerationProblem problem = [&] {
            const Stage stage(m_options.progress, "assemble objective");
            AccelerationObjective<Dim, double> objective(prior, how, m_options.execution);
            for (std::size_t c : learnt_from(false)) {
                objective.add(m_cases.training.motions[c]);
            }
            return std::move(objective).problem();
        }();
        const double assembly = assembling.seconds();
        const auto add = [&](const std::string& name, const auto& solve) {
            Stage stage(m_options.progress, "fit " + name);
            Candidate<Dim> candidate{.name = name, .network = prior};
            const AccelerationReport& report = candidate.acceleration.emplace(solve(stage.part()));
            m_result.interrupted = m_result.interrupted || stage.stopped();
            if (!usable(report.status)) {
                return;
            }
            apply(problem, report, candidate.network);
            if (m_options.damping == DampingRule::ratio) {
                set_damping(candidate.network);
            }
            candidate.seconds = assembly + stage.seconds();
            m_result.all.push_back(std::move(candidate));
        };
        if (m_options.method == Method::automatic && m_options.one_pass) {
            add("one_pass",
                [&](const ProgressCallback&) { return one_pass(problem, {.execution = m_options.execution}); });
        }
        if (m_options.method == Method::automatic || m_options.method == Method::dominant_term) {
            add("dominant_term", [&](ProgressCallback progress) {
                DominantTermOptions sweeps;
                sweeps.execution = m_options.execution;
                sweeps.progress = std::move(progress);
                return dominant_term(problem, sweeps);
            });
        }
        if ((m_options.method == Method::automatic || m_options.method == Method::exact) && !m_result.interrupted) {
            add("exact", [&](ProgressCallback progress) {
                ExactOptions solver;
                solver.execution = m_options.execution;
                solver.progress = std::move(progress);
                return m_options.exact_solver ? m_options.exact_solver(problem, solver) : exact(problem, solver);
            });
        }
    }

    const std::vector<NamedNetwork<Dim>>& m_given;
    const RecordedCases<Dim, double>& m_cases;
    const CalibrateOptions& m_options;
    double m_stiffness_damping; ///< beta of D = beta K, s
    bool m_knows_damping;
    Values<double> m_start{}; ///< of matching; empty: the prior
    Candidates<Dim> m_result;
};

/// Throws InvalidArgument for what candidates cannot be made from.
template <int Dim>
void check_given(const std::vector<NamedNetwork<Dim>>& given, const RecordedCases<Dim, double>& cases,
                 const CalibrateOptions& options) {
    require(!given.empty(), "given", "a network to start from", "none");
    require(options.zeta >= 0 && std::isfinite(options.zeta), "zeta", "a value not below 0", options.zeta);
    require(!options.start || *options.start < given.size(), "start", text("a number in [0, ", given.size(), ")"),
            options.start.value_or(0));
    require(options.prior_weight >= 0 && std::isfinite(options.prior_weight), "prior_weight", "a weight not below 0",
            options.prior_weight);
    require(options.horizon >= 0, "horizon", "0 or a number of frames", options.horizon);
    require(options.steps_per_frame >= 0, "steps_per_frame", "0 or a number of steps", options.steps_per_frame);
    require(options.matching_iterations >= 0, "matching_iterations", "a number not below 0",
            options.matching_iterations);
    require(options.matching_tolerance > 0, "matching_tolerance", "a positive value", options.matching_tolerance);
    require(!options.matching_seconds || *options.matching_seconds > 0, "matching_seconds", "a positive time, s",
            options.matching_seconds.value_or(0));
    require(!options.damping_ratio || (*options.damping_ratio >= 0 && *options.damping_ratio < 1), "damping_ratio",
            "a part of critical in [0, 1)", options.damping_ratio.value_or(0));
    for (const auto& named : given) {
        validate(named.network);
        require(named.network.stiffness.size() > 0 && named.network.stiffness.maxCoeff() > 0,
                text("network ", named.name), "stiffness to start from, as of a closed form (van_gelder, closed_forms)",
                "none above 0");
    }
    validate(cases, given.front().network.n_nodes());
}

} // namespace detail

template <int Dim>
Candidates<Dim> make_candidates(const std::vector<NamedNetwork<Dim>>& given, const RecordedCases<Dim, double>& cases,
                                const CalibrateOptions& options) {
    detail::check_given(given, cases, options);
    return detail::CandidateMaker<Dim>(given, cases, options).make();
}

} // namespace springfit
