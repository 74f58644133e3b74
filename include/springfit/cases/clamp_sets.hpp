// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <type_traits>

#include <Eigen/Eigenvalues>

#include <springfit/cases/specimen.hpp>
#include <springfit/mesh/pieces.hpp>

namespace springfit {

/// A side of the bounding box of a body: where one coordinate is smallest or largest.
struct Side {
    int axis = 0; ///< 0, 1, 2: x, y, z
    bool at_max = false;
};

/// Depth of a side where none is given, as a part of the extent.
inline constexpr double side_depth = 0.05;

/// The nodes at a side of the bounding box, as deep as `part` of the box's extent along the axis, ascending. `part` in
/// [0, 1); 0 takes the outermost nodes alone. Throws InvalidArgument for an axis that is not there. O(nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<int> side_nodes(const Points<Dim, Scalar>& rest_positions, const Side& side,
                                          std::type_identity_t<Scalar> part = Scalar(side_depth)) {
    require(side.axis >= 0 && side.axis < Dim, "side", text("an axis in [0, ", Dim, ")"), side.axis);
    require(part >= 0 && part < 1, "part", "a part of the extent in [0, 1)", part);
    std::vector<int> nodes;
    if (rest_positions.cols() == 0) {
        return nodes;
    }
    const auto along = rest_positions.row(side.axis);
    const Scalar low = along.minCoeff();
    const Scalar high = along.maxCoeff();
    // Coordinates of one layer may differ in rounding, which grows with their distance from the origin.
    const Scalar rounding = 8 * std::numeric_limits<Scalar>::epsilon() * std::max(std::abs(low), std::abs(high));
    const Scalar limit = part * (high - low) + rounding;
    for (Index i = 0; i < rest_positions.cols(); ++i) {
        if ((side.at_max ? high - along(i) : along(i) - low) <= limit) {
            nodes.push_back(static_cast<int>(i));
        }
    }
    return nodes;
}

/// True where clamping these nodes leaves no rigid motion: they do not all lie close to one point, in space not to one
/// straight line either. "Close" is a root mean square distance of the part `close` of the body's size. O(nodes).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] bool holds_rigidly(const Points<Dim, Scalar>& rest_positions, const std::vector<int>& nodes,
                                 std::type_identity_t<Scalar> close = Scalar(1e-3)) {
    if (nodes.size() < static_cast<std::size_t>(Dim)) {
        return false;
    }
    const Scalar size = (rest_positions.rowwise().maxCoeff() - rest_positions.rowwise().minCoeff()).norm();
    const Points<Dim, Scalar> held = rest_positions(Eigen::all, nodes);
    const Points<Dim, Scalar> arms = held.colwise() - held.rowwise().mean();
    const Eigen::Matrix<Scalar, Dim, Dim> spread = arms * arms.transpose() / static_cast<Scalar>(nodes.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, Dim, Dim>> directions(spread, Eigen::EigenvaluesOnly);
    return directions.eigenvalues()(1) > close * close * size * size; // Dim - 1 directions are spanned
}

struct ClampSetOptions {
    int training = 3;         ///< sets to train under, the body's own first, >= 1
    bool held_out = true;     ///< one more set, that training never sees
    double part = side_depth; ///< depth of a side, part of the extent, in [0, 1)
};

/// Node sets to clamp a body at, each on its own.
struct ClampSets {
    std::vector<std::vector<int>> training;
    std::vector<int> held_out; ///< empty where none was asked for
};

namespace detail {

template <int Dim, std::floating_point Scalar>
Vector<Dim, Scalar> centre_of(const Points<Dim, Scalar>& positions, const std::vector<int>& nodes) {
    return positions(Eigen::all, nodes).rowwise().mean();
}

/// True where two ascending sets share more than half of the nodes that they hold together.
inline bool overlap(const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> both;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return 3 * both.size() > a.size() + b.size();
}

/// Picks clamp sets one after another, each as far from those before as can be.
template <int Dim, std::floating_point Scalar>
class ClampPicker {
public:
    ClampPicker(const Specimen<Dim, Scalar>& body, Scalar part) : m_body(&body) {
        const Vector<Dim, Scalar> low = body.rest_positions.rowwise().minCoeff();
        const Vector<Dim, Scalar> extent = body.rest_positions.rowwise().maxCoeff() - low;
        m_size = extent.norm();
        if (body.edges.cols() > 0) {
            std::map<Index, std::vector<int>> pieces;
            const auto piece = piece_of_nodes(body.n_nodes(), body.edges);
            for (std::size_t i = 0; i < piece.size(); ++i) {
                pieces[piece[i]].push_back(static_cast<int>(i));
            }
            for (auto& [root, nodes] : pieces) {
                m_pieces.push_back(std::move(nodes));
            }
        }
        for (int axis = 0; axis < Dim; ++axis) {
            for (const bool at_max : {false, true}) {
                if (extent(axis) > Scalar(1e-3) * m_size) { // not across a flat sheet
                    m_sides.push_back(side_nodes(body.rest_positions, {axis, at_max}, part));
                }
            }
        }
    }

    /// True where no force passes between parts of the body.
    [[nodiscard]] bool is_in_pieces() const { return m_pieces.size() > 1; }

    void take(std::vector<int> nodes) { m_taken.push_back(std::move(nodes)); }

    /// The side, or where none is left the patch of surface, that is farthest from the sets before; empty: no more.
    std::vector<int> next() {
        const std::vector<std::vector<int>> candidates = usable_sets();
        std::vector<int> best;
        std::vector<long> first; // the farthest; of those equally far but for rounding, the first by position
        for (const auto& nodes : candidates) {
            const Vector<Dim, Scalar> centre = centre_of<Dim, Scalar>(m_body->rest_positions, nodes);
            std::vector<long> order = {-in_steps(distance_from_taken(centre))};
            for (int d = 0; d < Dim; ++d) {
                order.push_back(in_steps(centre(d)));
            }
            if (first.empty() || order < first) {
                first = std::move(order);
                best = nodes;
            }
        }
        return best;
    }

private:
    /// A length in steps of 1/5000 of the body's size, which rounding seldom changes.
    [[nodiscard]] long in_steps(Scalar length) const { return std::lround(5000 * length / m_size); }

    /// Sides, else patches, that hold the body firmly; where there are none, those that just hold it. A body that is
    /// held by its thinnest end swings on it, and the few springs there decide how.
    [[nodiscard]] std::vector<std::vector<int>> usable_sets() const {
        std::vector<std::vector<int>> sets;
        for (const Scalar close : {Scalar(0.04), Scalar(1e-3)}) {
            std::copy_if(m_sides.begin(), m_sides.end(), std::back_inserter(sets),
                         [&](const auto& side) { return is_usable(side, close); });
            const bool no_side = sets.empty();
            for (std::size_t s = 0; no_side && s < m_body->surface.size(); ++s) {
                if (auto patch = patch_around(m_body->surface[s]); is_usable(patch, close)) {
                    sets.push_back(std::move(patch));
                }
            }
            if (!sets.empty()) {
                break;
            }
        }
        return sets;
    }

    [[nodiscard]] bool is_usable(const std::vector<int>& nodes, Scalar close) const {
        return 2 * static_cast<Index>(nodes.size()) <= m_body->n_nodes() && holds_every_piece(nodes, close) &&
               std::none_of(m_taken.begin(), m_taken.end(), [&](const auto& set) { return overlap(set, nodes); });
    }

    [[nodiscard]] bool holds_every_piece(const std::vector<int>& nodes, Scalar close) const {
        if (!is_in_pieces()) {
            return holds_rigidly(m_body->rest_positions, nodes, close);
        }
        return std::all_of(m_pieces.begin(), m_pieces.end(), [&](const auto& piece) {
            std::vector<int> held;
            std::set_intersection(nodes.begin(), nodes.end(), piece.begin(), piece.end(), std::back_inserter(held));
            return holds_rigidly(m_body->rest_positions, held, close);
        });
    }

    [[nodiscard]] Scalar distance_from_taken(const Vector<Dim, Scalar>& centre) const {
        Scalar distance = m_size;
        for (const auto& set : m_taken) {
            distance = std::min(distance, (centre - centre_of<Dim, Scalar>(m_body->rest_positions, set)).norm());
        }
        return distance;
    }

    /// Surface nodes within a tenth of the body's size, or as far as it takes to hold the body.
    [[nodiscard]] std::vector<int> patch_around(int node) const {
        const auto& x = m_body->rest_positions;
        std::vector<int> nodes;
        for (Scalar radius = m_size / 10; radius < m_size / 2; radius *= Scalar(1.25)) {
            nodes.clear();
            for (int other : m_body->surface) {
                if ((x.col(other) - x.col(node)).norm() <= radius) {
                    nodes.push_back(other);
                }
            }
            std::sort(nodes.begin(), nodes.end());
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
            if (holds_rigidly(x, nodes)) {
                break;
            }
        }
        return nodes;
    }

    const Specimen<Dim, Scalar>* m_body;
    Scalar m_size = 0;
    std::vector<std::vector<int>> m_pieces; ///< their nodes, ascending; none where edges are not known
    std::vector<std::vector<int>> m_sides;
    std::vector<std::vector<int>> m_taken;
};

} // namespace detail

/// Different ways to clamp a body: its own clamps (where it has any), then sides of its bounding box, then patches of
/// its surface, each time the one whose centre is farthest from those before; those that hold the body firmly, by more
/// than 4 % of its size in root mean square, come first. The held-out one is the second: the
/// farthest from the body's own, as the other end of a beam.
///
/// Every set but the body's own leaves no rigid motion (`holds_rigidly`), holds at most half of the nodes, and shares
/// with no other more than half of the nodes that both hold together. Of a body in pieces, by its edges, it holds every
/// piece, and there may be fewer sets than asked for. The result goes by positions, not by node numbers. Throws
/// InvalidArgument where another body has not that many. O(nodes) for sides, O(surface^2) for patches.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] ClampSets clamp_sets(const Specimen<Dim, Scalar>& body, const ClampSetOptions& options = {}) {
    validate(body);
    require(options.training >= 1, "training", "at least one clamp set", options.training);
    require(options.part >= 0 && options.part < 1, "part", "a part of the extent in [0, 1)", options.part);
    detail::ClampPicker<Dim, Scalar> picker(body, static_cast<Scalar>(options.part));
    Scenario<Dim, Scalar> own;
    own.clamps = body.clamps;
    std::vector<std::vector<int>> sets;
    const int n_sets = options.training + (options.held_out ? 1 : 0);
    for (int s = 0; s < n_sets; ++s) {
        std::vector<int> nodes = s == 0 ? clamped_nodes(own, body.n_nodes()) : std::vector<int>{};
        if (nodes.empty()) {
            nodes = picker.next();
        }
        if (nodes.empty() && picker.is_in_pieces() && sets.size() > (options.held_out ? 1U : 0U)) {
            break; // few sets hold every piece
        }
        require(!nodes.empty(), "training",
                text("no more than the ", s, " clamp sets of the body, the held-out one included"), options.training);
        picker.take(nodes);
        sets.push_back(std::move(nodes));
    }
    ClampSets result;
    if (options.held_out) {
        const auto farthest = sets.begin() + 1;
        result.held_out = std::move(*farthest);
        sets.erase(farthest);
    }
    result.training = std::move(sets);
    return result;
}

} // namespace springfit
