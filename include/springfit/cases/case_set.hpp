// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/load_case.hpp>
#include <springfit/core/warning.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/motion/resample.hpp>
#include <springfit/motion/smoothing.hpp>

namespace springfit {

/// Load cases with what the reference did under each. A motion of one frame is an equilibrium.
template <int Dim, std::floating_point Scalar>
struct CaseSet {
    std::vector<LoadCase<Dim, Scalar>> cases;
    std::vector<Motion<Dim, Scalar>> motions; ///< `motions[c]` is that of `cases[c]`

    [[nodiscard]] std::size_t size() const { return cases.size(); }
    [[nodiscard]] bool empty() const { return cases.empty(); }
    [[nodiscard]] bool is_static(std::size_t c) const { return motions[c].n_frames() == 1; }

    void add(LoadCase<Dim, Scalar> load_case, Motion<Dim, Scalar> motion) {
        cases.push_back(std::move(load_case));
        motions.push_back(std::move(motion));
    }

    [[nodiscard]] std::vector<Scenario<Dim, Scalar>> scenarios() const {
        std::vector<Scenario<Dim, Scalar>> all;
        for (const auto& load_case : cases) {
            all.push_back(load_case.scenario);
        }
        return all;
    }

    /// Copies of these cases.
    [[nodiscard]] CaseSet subset(const std::vector<std::size_t>& numbers) const {
        CaseSet chosen;
        for (std::size_t c : numbers) {
            chosen.add(cases[c], motions[c]);
        }
        return chosen;
    }
};

/// The recorded cases of a reference: those that fits learn from, and those that judge them, which no fit sees.
template <int Dim, std::floating_point Scalar>
struct RecordedCases {
    CaseSet<Dim, Scalar> training;
    CaseSet<Dim, Scalar> held_out;
    Scalar stiffness_damping = 0; ///< beta of D = beta K, s, of the reference as far as it is known
    bool knows_damping = true;    ///< else it is found with the fit
    Scalar strain = 0;            ///< that loads were scaled to; 0: not known
    Scalar deformation = 0;       ///< that loads in time were scaled to at most, as a part of the size; 0: not known
    Scalar period = 0;            ///< of the slowest motion that the loads excite, s; 0: not known
    bool interrupted = false;     ///< not all that were asked for are there
    std::vector<Warning> warnings;

    /// Adds a case where its role belongs.
    void add(LoadCase<Dim, Scalar> load_case, Motion<Dim, Scalar> motion) {
        auto& set = load_case.role == CaseRole::training ? training : held_out;
        set.add(std::move(load_case), std::move(motion));
    }

    /// Adds the cases and warnings of another recording of the same body.
    void add(RecordedCases other) {
        for (auto* set : {&other.training, &other.held_out}) {
            for (std::size_t c = 0; c < set->size(); ++c) {
                add(std::move(set->cases[c]), std::move(set->motions[c]));
            }
        }
        interrupted = interrupted || other.interrupted;
        warnings.insert(warnings.end(), other.warnings.begin(), other.warnings.end());
    }
};

/// Throws InvalidArgument unless every case has a motion of `n_nodes` nodes with at least one frame, and there are both
/// cases to learn from and cases that judge.
template <int Dim, std::floating_point Scalar>
void validate(const RecordedCases<Dim, Scalar>& recorded, Index n_nodes) {
    for (const auto* set : {&recorded.training, &recorded.held_out}) {
        const char* name = set == &recorded.training ? "training" : "held_out";
        require(!set->empty(), name, "at least one case", "none");
        require(set->motions.size() == set->cases.size(), name, text(set->cases.size(), " motions, one per case"),
                set->motions.size());
        for (std::size_t c = 0; c < set->size(); ++c) {
            const auto& motion = set->motions[c];
            require(motion.n_nodes() == n_nodes, text(name, " motion ", motion.name),
                    text(n_nodes, " nodes, as the network"), motion.n_nodes());
            require(motion.n_frames() > 0, text(name, " motion ", motion.name), "at least one frame", "none");
            validate(motion);
            validate(set->cases[c].scenario, n_nodes);
        }
    }
}

namespace detail {

/// Noise beside the motion, above which a recording is smoothed [our definition]; below it, the frames are as good.
inline constexpr double least_noise = 0.003;

/// Root mean square displacement of a coordinate of the nodes that were seen and are not clamped, m.
template <int Dim, std::floating_point Scalar>
Scalar mean_displacement(const Motion<Dim, Scalar>& motion) {
    const FreeNodes free(motion.n_nodes(), motion.clamped);
    Scalar sum = 0;
    Scalar count = 0;
    for (std::size_t t = 0; t < motion.positions.size(); ++t) {
        for_observed(motion, t, free.nodes(), [&](int i) {
            sum += (motion.positions[t].col(i) - motion.rest_positions.col(i)).squaredNorm();
            count += Dim;
        });
    }
    return count > 0 ? std::sqrt(sum / count) : Scalar(0);
}

/// True where two frames are the same beside how far the body has moved from rest.
template <int Dim, std::floating_point Scalar>
bool are_equal(const Points<Dim, Scalar>& a, const Points<Dim, Scalar>& b, const Points<Dim, Scalar>& rest) {
    return (a - b).norm() <= Scalar(1e-6) * (b - rest).norm();
}

/// True where nothing moves: one frame, or several that are the same.
template <int Dim, std::floating_point Scalar>
bool is_still(const Motion<Dim, Scalar>& motion) {
    return std::all_of(motion.positions.begin(), motion.positions.end(), [&](const auto& frame) {
        return are_equal<Dim, Scalar>(frame, motion.positions.front(), motion.rest_positions);
    });
}

} // namespace detail

/// The nodes that are at their rest position, to the last bit, in every frame: in a recording that names no clamps they
/// are taken as held.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<int> still_nodes(const Motion<Dim, Scalar>& motion) {
    std::vector<int> nodes;
    for (Index i = 0; i < motion.n_nodes(); ++i) {
        const bool still = std::all_of(motion.positions.begin(), motion.positions.end(), [&](const auto& frame) {
            return (frame.col(i) - motion.rest_positions.col(i)).isZero(0);
        });
        if (still) {
            nodes.push_back(static_cast<int>(i));
        }
    }
    return nodes;
}

/// Motions and equilibria that were recorded elsewhere, each replayed as a load case.
///
/// A motion of one frame, or of equal ones, is an equilibrium. Of several motions, and of several equilibria, the last
/// quarter is held out, at least one; of a single motion the last third of its time where there is nothing else to hold
/// out. Equilibria that repeat an earlier one are left out, and motions with uneven frames are resampled, both with a
/// warning. Of a motion with noise (`noise_level` above 0.3 % of its displacements), what is learnt from is smoothed,
/// and what judges stays as it was recorded but starts from the smoothed state. Throws InvalidArgument for none, for a
/// motion of fewer than 4 frames, and where nothing is left to judge by.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] RecordedCases<Dim, Scalar> split_motions(std::vector<Motion<Dim, Scalar>> motions) {
    require(!motions.empty(), "motions", "at least one", "none");
    RecordedCases<Dim, Scalar> recorded;
    recorded.knows_damping = false;
    const auto warn = [&](WarningCode code, const Motion<Dim, Scalar>& motion, std::string_view message) {
        recorded.warnings.push_back({.code = code,
                                     .about = motion.name,
                                     .message = text(motion.name, ": ", message),
                                     .advice = {},
                                     .values = {}});
    };
    std::vector<Motion<Dim, Scalar>> in_time, at_rest;
    for (auto& motion : motions) {
        require(motion.n_frames() > 0, text("motion ", motion.name), "at least one frame", "none");
        if (detail::is_still(motion)) {
            Motion<Dim, Scalar> frame = excerpt(motion, 0, 1);
            const bool is_new = std::none_of(at_rest.begin(), at_rest.end(), [&](const auto& other) {
                return detail::are_equal<Dim, Scalar>(other.positions.front(), frame.positions.front(),
                                                      frame.rest_positions);
            });
            if (is_new) {
                at_rest.push_back(std::move(frame));
            } else {
                warn(WarningCode::repeated_case, motion, "repeats an earlier equilibrium, and is left out");
            }
            continue;
        }
        require(motion.n_frames() >= 4, text("motion ", motion.name), "at least 4 frames, or one, an equilibrium",
                motion.n_frames());
        if (!has_even_frames(motion)) {
            warn(WarningCode::resampled, motion, "its frames are not evenly spaced, and were resampled");
            motion = resample(motion);
        }
        in_time.push_back(std::move(motion));
    }
    std::vector<Motion<Dim, Scalar>> estimated; // beneath the noise, of those in time
    for (auto& motion : in_time) {
        const Scalar noise = noise_level(motion);
        const Scalar part = noise / detail::mean_displacement(motion);
        if (part > Scalar(detail::least_noise)) {
            motion.noise = noise;
            const double percent = 100 * static_cast<double>(part);
            warn(WarningCode::noisy_recording, motion,
                 text("a noise of about ", noise, " m, ", percent,
                      " % of its motion, is in its positions; it is smoothed to learn from"));
        }
        estimated.push_back(smoothed(motion, motion.noise));
    }
    const auto keep = [&](CaseRole role, Motion<Dim, Scalar> motion, const Motion<Dim, Scalar>& estimate) {
        LoadCase<Dim, Scalar> load_case{.scenario = replay(estimate)};
        load_case.role = role;
        recorded.add(std::move(load_case), role == CaseRole::training ? estimate : std::move(motion));
    };
    for (const bool is_in_time : {true, false}) {
        auto& set = is_in_time ? in_time : at_rest;
        const auto& estimates = is_in_time ? estimated : at_rest;
        const std::size_t n = set.size();
        const std::size_t n_held_out = n > 1 ? std::max<std::size_t>(1, n / 4) : 0;
        for (std::size_t m = 0; m < n; ++m) {
            if (n == 1 && is_in_time && at_rest.size() < 2) { // nothing else to judge by
                const Index last = set[0].n_frames();
                const Index split = 2 * last / 3;
                keep(CaseRole::training, excerpt(set[0], 0, split), excerpt(estimated[0], 0, split));
                keep(CaseRole::unseen_load, excerpt(set[0], split, last), excerpt(estimated[0], split, last));
            } else {
                keep(m + n_held_out < n ? CaseRole::training : CaseRole::unseen_load, set[m], estimates[m]);
            }
        }
    }
    require(!recorded.held_out.empty(), "motions",
            "two equilibria that differ, or a motion in time, to learn from one "
            "and judge by the other",
            text(at_rest.size(), " equilibrium"));
    return recorded;
}

} // namespace springfit
