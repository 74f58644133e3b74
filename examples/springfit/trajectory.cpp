// SPDX-License-Identifier: BSD-3-Clause
// Matching of motion as a candidate.

#include <springfit/network/damping.hpp>

#include "candidates.hpp"
#include "interrupt.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

template <int Dim>
std::optional<Candidate<Dim>> match_motion(const SpringNetwork<Dim, double>& prior, const ReferenceCases<Dim>& cases,
                                           const FitOptions& options, const Execution& execution) {
    TrajectoryOptions how;
    how.execution = execution;
    how.prior_weight = 1e-5; // cases are many enough to say more than a closed form does
    std::vector<Motion<Dim, double>> learnt;
    for (const auto& motion : cases.training.motions) {
        if (motion.n_frames() == 1) {
            learnt.push_back(motion);
        }
    }
    if (learnt.empty()) {
        learnt = cases.training.motions;
        how.horizon = 12;
        how.parameters.damping.fit = options.damping == "fitted" && (prior.damping.array() > 0).any();
    }
    if (options.damping == "proportional") {
        how.parameters.damping_per_stiffness = cases.stiffness_damping;
    }
    Stage stage("fit trajectory");
    try {
        const TrajectoryProblem<Dim> problem(prior, learnt, how);
        GaussNewtonOptions engine;
        const auto report_progress = stage.callback();
        const Timer timer;
        bool out_of_time = false;
        engine.progress = [&](const Progress& progress) {
            out_of_time = timer.seconds() > options.fit_seconds;
            return report_progress(progress) && !out_of_time;
        };
        Candidate<Dim> candidate;
        candidate.name = "trajectory";
        candidate.network = prior;
        candidate.trajectory = gauss_newton(problem, engine);
        if (!usable(candidate.trajectory->status)) {
            return std::nullopt;
        }
        if (candidate.trajectory->status == Status::interrupted && out_of_time && !interrupted()) {
            candidate.trajectory->status = Status::iteration_limit;
        }
        apply(problem, *candidate.trajectory, candidate.network);
        if (options.damping == "ratio") {
            candidate.network.damping = mass_stiffness_damping(candidate.network, options.zeta.value_or(0.05));
        }
        candidate.data_share.resize(prior.n_springs());
        for (Index e = 0; e < prior.n_springs(); ++e) {
            candidate.data_share(e) =
                candidate.trajectory->data_share(problem.parameters().unknown(MotionParameter::stiffness, e));
        }
        candidate.seconds = stage.seconds();
        return candidate;
    } catch (const InvalidArgument& error) { // as of a recording with uneven frames
        std::fprintf(stderr, "warning: motion is not matched: %s\n", error.what());
        return std::nullopt;
    }
}

io::Json describe(const TrajectoryReport& fit) {
    return {{"status", to_string(fit.status)},
            {"objective_start", fit.objective_start},
            {"objective", fit.objective},
            {"misfit_start", fit.misfit_start},
            {"misfit", fit.misfit},
            {"iterations", fit.iterations},
            {"evaluations", fit.evaluations},
            {"stepped_back", fit.rejected},
            {"set_by_data", fit.n_set_by_data()},
            {"set_by_prior", fit.theta.size() - fit.n_set_by_data()}};
}

template std::optional<Candidate<2>> match_motion<2>(const SpringNetwork<2, double>&, const ReferenceCases<2>&,
                                                     const FitOptions&, const Execution&);
template std::optional<Candidate<3>> match_motion<3>(const SpringNetwork<3, double>&, const ReferenceCases<3>&,
                                                     const FitOptions&, const Execution&);

} // namespace program
