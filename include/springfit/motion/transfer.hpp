// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <springfit/mesh/corner_mesh.hpp>
#include <springfit/motion/motion.hpp>

namespace springfit {

/// Values at target points as weighted sums of values at source nodes: `targets = sources * weights`.
///
/// Built from a mesh of the source nodes by `cgal::interpolation`, or by hand. Every column sums to 1.
template <std::floating_point ScalarType>
struct Interpolation {
    using Scalar = ScalarType;

    SparseMatrix<Scalar> weights; ///< [n_sources x n_targets], one column per target

    [[nodiscard]] Index n_sources() const { return weights.rows(); }
    [[nodiscard]] Index n_targets() const { return weights.cols(); }
};

/// Throws InvalidArgument unless the weights of every target are finite and sum to 1.
template <std::floating_point Scalar>
void validate(const Interpolation<Scalar>& interpolation, std::string_view name) {
    const Scalar tolerance = 1000 * std::numeric_limits<Scalar>::epsilon();
    for (Index target = 0; target < interpolation.n_targets(); ++target) {
        const Scalar sum = interpolation.weights.col(target).sum();
        if (!(std::abs(sum - 1) <= tolerance)) {
            throw InvalidArgument(name, "weights that sum to 1", text(sum, " at target ", target));
        }
    }
}

/// Values at the targets: m_c = sum_i w_ic q_i `[Dim x n_targets]`. O(weights).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> interpolate(const Interpolation<Scalar>& interpolation,
                                              const Points<Dim, Scalar>& at_sources) {
    require(at_sources.cols() == interpolation.n_sources(), "values", text(interpolation.n_sources(), " sources"),
            at_sources.cols());
    return at_sources * interpolation.weights;
}

/// Forces at the targets handed to the sources, f_i = sum_c w_ic f_c `[Dim x n_sources]`: the adjoint of `interpolate`,
/// so that the work on any motion of the sources is the same and the total force is kept. O(weights).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> restrict_forces(const Interpolation<Scalar>& interpolation,
                                                  const Points<Dim, Scalar>& at_targets) {
    require(at_targets.cols() == interpolation.n_targets(), "forces", text(interpolation.n_targets(), " targets"),
            at_targets.cols());
    return at_targets * interpolation.weights.transpose();
}

/// Masses at the targets handed to the sources, m_i = sum_c w_ic m_c `[n_sources]`; the total is kept.
///
/// Throws InvalidArgument where a source gets no mass: the targets are then too coarse for the sources. O(weights).
template <std::floating_point Scalar>
[[nodiscard]] Values<Scalar> restrict_masses(const Interpolation<Scalar>& interpolation,
                                             const Values<Scalar>& at_targets) {
    require(at_targets.size() == interpolation.n_targets(), "masses", text(interpolation.n_targets(), " targets"),
            at_targets.size());
    const Values<Scalar> masses = interpolation.weights * at_targets;
    for (Index i = 0; i < masses.size(); ++i) {
        if (!(masses(i) > 0)) {
            throw InvalidArgument("masses", "a share of the mass for every node", text(masses(i), " kg at node ", i));
        }
    }
    return masses;
}

/// The two interpolations between a mesh and its corners, for `transfer` to a network on the corners.
template <std::floating_point Scalar>
struct CornerInterpolations {
    Interpolation<Scalar> at_corners; ///< mesh nodes to `corner_mesh` nodes: each corner is itself
    Interpolation<Scalar> at_nodes;   ///< `corner_mesh` nodes to mesh nodes: an edge's node is the mean of its ends
};

/// Interpolations between the nodes of a mesh and those of `corner_mesh(mesh)`; identities for a linear mesh. O(cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] CornerInterpolations<Scalar> corner_interpolations(const Mesh<Dim, Scalar, Cell>& mesh) {
    const std::vector<int> corners = corner_nodes(mesh);
    const auto n_corners = static_cast<Index>(corners.size());
    CornerInterpolations<Scalar> result;
    std::vector<int> number(static_cast<std::size_t>(mesh.n_nodes()), -1);
    result.at_corners.weights.resize(mesh.n_nodes(), n_corners);
    for (int c = 0; c < n_corners; ++c) {
        number[static_cast<std::size_t>(corners[static_cast<std::size_t>(c)])] = c;
        result.at_corners.weights.insert(corners[static_cast<std::size_t>(c)], c) = 1;
    }
    result.at_corners.weights.makeCompressed();

    std::vector<Eigen::Triplet<Scalar>> entries;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        entries.emplace_back(static_cast<int>(c), corners[c], Scalar(1));
    }
    std::vector<bool> done(static_cast<std::size_t>(mesh.n_nodes()), false);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        for (int e = 0; e < Cell::n_nodes - Cell::n_corners; ++e) {
            const int middle = mesh.cells(Cell::n_corners + e, c);
            if (!done[static_cast<std::size_t>(middle)]) {
                done[static_cast<std::size_t>(middle)] = true;
                for (int end : Cell::edges[static_cast<std::size_t>(e)]) {
                    entries.emplace_back(number[static_cast<std::size_t>(mesh.cells(end, c))], middle, Scalar(0.5));
                }
            }
        }
    }
    result.at_nodes.weights.resize(n_corners, mesh.n_nodes());
    result.at_nodes.weights.setFromTriplets(entries.begin(), entries.end());
    return result;
}

/// The targets whose weights are, to `share` of them, those of these sources; ascending, each once. The weights count
/// by their size, and with a share of 1 all of them to rounding.
///
/// Throws InvalidArgument for a source out of range and a share outside of (0, 1]. O(weights).
template <std::floating_point Scalar>
[[nodiscard]] std::vector<int> targets_of(const Interpolation<Scalar>& interpolation, const std::vector<int>& sources,
                                          std::type_identity_t<Scalar> share = 1) {
    require(share > 0 && share <= 1, "share", "a part in (0, 1]", share);
    std::vector<bool> chosen(static_cast<std::size_t>(interpolation.n_sources()), false);
    for (int node : sources) {
        require(node >= 0 && node < interpolation.n_sources(), "sources",
                text("node numbers in [0, ", interpolation.n_sources(), ")"), node);
        chosen[static_cast<std::size_t>(node)] = true;
    }
    const Scalar rounding = std::sqrt(std::numeric_limits<Scalar>::epsilon());
    std::vector<int> targets;
    for (Index c = 0; c < interpolation.n_targets(); ++c) {
        Scalar all = 0;
        Scalar of_chosen = 0;
        for (typename SparseMatrix<Scalar>::InnerIterator weight(interpolation.weights, c); weight; ++weight) {
            const Scalar size = std::abs(weight.value());
            all += size;
            of_chosen += chosen[static_cast<std::size_t>(weight.row())] ? size : Scalar(0);
        }
        if (of_chosen > 0 && of_chosen >= (share - rounding) * all) {
            targets.push_back(static_cast<int>(c));
        }
    }
    return targets;
}

namespace detail {

/// Lets these targets be read from these sources alone.
template <std::floating_point Scalar>
void restrict_columns(SparseMatrix<Scalar>& weights, const std::vector<int>& targets, const std::vector<int>& sources) {
    for (int target : targets) {
        const auto kept = [&](Index row) {
            return std::find(sources.begin(), sources.end(), static_cast<int>(row)) != sources.end();
        };
        Scalar sum = 0;
        for (typename SparseMatrix<Scalar>::InnerIterator weight(weights, target); weight; ++weight) {
            sum += kept(weight.row()) ? weight.value() : Scalar(0);
        }
        for (typename SparseMatrix<Scalar>::InnerIterator weight(weights, target); weight; ++weight) {
            weight.valueRef() = kept(weight.row()) ? weight.value() / sum : Scalar(0);
        }
    }
}

} // namespace detail

/// The motion of a fine mesh carried to the nodes of a coarser network.
///
/// Kinematics are read off at the coarse nodes (`at_coarse`: fine nodes to coarse nodes): a coarse node moves from its
/// rest position by the interpolated displacement, so an affine motion comes out exactly. External forces are handed
/// over by the adjoint of the other interpolation (`at_fine`: coarse nodes to fine nodes): the total force is kept
/// exactly, and the moment as far as `at_fine` reproduces the fine positions. A coarse node is clamped where fine nodes
/// that are make up `clamped_share` of what it is read from (`targets_of`), and then moves as those do: with 1, where
/// all of them are; with 1/2 the clamped region keeps its size, even where it is thinner than the cells.
///
/// Throws InvalidArgument for sizes that do not fit and for weights that do not sum to 1. O(frames * weights).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Motion<Dim, Scalar>
transfer(const Motion<Dim, Scalar>& fine, const Interpolation<Scalar>& at_coarse, const Interpolation<Scalar>& at_fine,
         const Points<Dim, Scalar>& coarse_rest_positions, std::type_identity_t<Scalar> clamped_share = 1) {
    const Index n_fine = fine.n_nodes();
    const Index n_coarse = coarse_rest_positions.cols();
    require(at_coarse.n_sources() == n_fine && at_coarse.n_targets() == n_coarse, "at_coarse",
            text("weights [", n_fine, " x ", n_coarse, "]"),
            text("[", at_coarse.n_sources(), " x ", at_coarse.n_targets(), "]"));
    require(at_fine.n_sources() == n_coarse && at_fine.n_targets() == n_fine, "at_fine",
            text("weights [", n_coarse, " x ", n_fine, "]"),
            text("[", at_fine.n_sources(), " x ", at_fine.n_targets(), "]"));
    validate(at_coarse, "at_coarse");
    validate(at_fine, "at_fine");
    validate(fine);

    Motion<Dim, Scalar> coarse;
    coarse.name = fine.name;
    coarse.rest_positions = coarse_rest_positions;
    coarse.times = fine.times;
    coarse.clamped = targets_of(at_coarse, fine.clamped, clamped_share);
    Interpolation<Scalar> reading = at_coarse;
    detail::restrict_columns(reading.weights, coarse.clamped, fine.clamped);
    for (std::size_t t = 0; t < fine.times.size(); ++t) {
        const Points<Dim, Scalar> displacement = fine.positions[t] - fine.rest_positions;
        coarse.positions.push_back(coarse_rest_positions + interpolate(reading, displacement));
        coarse.velocities.push_back(interpolate(reading, fine.velocities[t]));
        coarse.accelerations.push_back(interpolate(reading, fine.accelerations[t]));
        coarse.external_forces.push_back(restrict_forces(at_fine, fine.external_forces[t]));
    }
    return coarse;
}

} // namespace springfit
