// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <springfit/fit/acceleration/problem.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/network/spring_network.hpp>

namespace springfit {

/// A network with values to start from and to compare with, such as those of a closed form.
template <int Dim>
struct NamedNetwork {
    std::string name;
    SpringNetwork<Dim, double> network;
    Index n_clamped = 0;  ///< springs that the formula makes negative and that were set to 0
    std::string caveat{}; ///< for what the formula is exact, where not for this body
};

/// The errors of a network on a set of cases.
struct CaseScores {
    double error = std::numeric_limits<double>::infinity(); ///< of the whole set; infinite until it is scored in full
    double noise = 0;                                       ///< error that the noise of the recording alone makes
    std::vector<std::size_t> cases;                         ///< numbers in the case set
    std::vector<double> errors;                             ///< of each of them; 1 where it failed
    std::vector<Status> statuses; ///< how each ended; `interrupted` where it was not reached, which counts as 1

    /// The error beside the noise, sqrt(error^2 - noise^2): that of the network.
    [[nodiscard]] double beside_noise() const {
        return noise > 0 ? std::sqrt(std::max(error * error - noise * noise, 0.)) : error;
    }
    [[nodiscard]] bool is_scored() const { return error < std::numeric_limits<double>::infinity(); }
    /// Cases that the network could not be simulated in.
    [[nodiscard]] std::size_t n_failed() const {
        return n_tried() - static_cast<std::size_t>(std::count(statuses.begin(), statuses.end(), Status::converged));
    }
    /// Cases that it was simulated in, or was to be.
    [[nodiscard]] std::size_t n_tried() const {
        return statuses.size() -
               static_cast<std::size_t>(std::count(statuses.begin(), statuses.end(), Status::interrupted));
    }
};

/// A network beside others, with its fit and its errors.
template <int Dim>
struct Candidate {
    std::string name;
    SpringNetwork<Dim, double> network;
    /// Of an acceleration fit; `calibrate` makes it in units in which the first network has size, mass and mean
    /// stiffness 1.
    std::optional<AccelerationReport> acceleration{};
    std::optional<TrajectoryReport> trajectory{}; ///< of matching of motion
    Values<double>
        data_share{}; ///< of each spring, of matching of motion: above 1/2 the data set its stiffness, else the prior
    Index n_clamped = 0;
    std::string caveat{};
    double stiffness_damping = 0; ///< beta of D = beta K, s: the reference's, or found where that is not known
    int steps_per_frame = 0;      ///< of the integrator, where motions in time were matched
    double step_error = 0;        ///< then, what halved steps change of the misfit, as a part of it
    double seconds = 0;           ///< of its fit, with the set-up of its problem
    CaseScores held_out{};
    CaseScores training{}; ///< on a sample of what fits learn from, where any was asked for
    /// Elastic energy in the reference's training motion beside that of the first network: below 1 the springs resist
    /// that motion less.
    double relative_stiffness = 1;

    /// Springs and cells that a step goes through.
    [[nodiscard]] Index n_parts() const { return network.n_springs() + network.n_cells(); }

    /// How its fit ended; `converged` for a network that was given.
    [[nodiscard]] Status status() const {
        return acceleration ? acceleration->status : trajectory ? trajectory->status : Status::converged;
    }
};

} // namespace springfit
