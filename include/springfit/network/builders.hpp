// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/mesh/topology.hpp>
#include <springfit/network/masses.hpp>
#include <springfit/network/volume.hpp>

namespace springfit {

/// The springs of a mesh besides its edges, whether its cells hold their volume, and what its masses are made of.
template <std::floating_point Scalar>
struct SpringOptions {
    bool diagonals = false;   ///< also the diagonals of quadrilaterals and hexahedra (faces and body)
    bool second_ring = false; ///< also the vertices that face each other across a shared facet; simplices only
    bool volume = false;      ///< also cells that hold their volume (`add_volume_cells`); not on membranes
    Scalar density = 1;       ///< rho > 0, kg/m^3
    Scalar thickness = 1;     ///< h > 0, m; in the plane and on membranes alone
};

namespace detail {

template <int Dim, std::floating_point Scalar>
void check_new_springs(const Points<Dim, Scalar>& rest_positions, const NodePairs& pairs) {
    const Index nodes = rest_positions.cols();
    std::vector<std::array<int, 3>> sorted;
    sorted.reserve(static_cast<std::size_t>(pairs.cols()));
    for (Index e = 0; e < pairs.cols(); ++e) {
        const int i = pairs(0, e);
        const int j = pairs(1, e);
        const auto spring = [&] { return text("spring ", e, " from ", i, " to ", j); };
        if (!(i >= 0 && j >= 0 && i < nodes && j < nodes)) {
            throw InvalidArgument("springs", text("node numbers in [0, ", nodes, ")"), spring());
        }
        if (i == j) {
            throw InvalidArgument("springs", "two different ends", spring());
        }
        if (!((rest_positions.col(j) - rest_positions.col(i)).norm() > 0)) {
            throw InvalidArgument("springs", "a positive rest length", text(spring(), " of length 0"));
        }
        sorted.push_back({std::min(i, j), std::max(i, j), static_cast<int>(e)});
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t s = 1; s < sorted.size(); ++s) {
        if (sorted[s][0] == sorted[s - 1][0] && sorted[s][1] == sorted[s - 1][1]) {
            throw InvalidArgument("springs", "each pair of nodes once",
                                  text("springs ", sorted[s - 1][2], " and ", sorted[s][2], " both from ", sorted[s][0],
                                       " to ", sorted[s][1]));
        }
    }
}

} // namespace detail

/// Springs from the user's list of node pairs `[2 x n_springs]`, at rest in `rest_positions` `[Dim x n_nodes]`.
///
/// Stiffness and damping are 0 until a closed form or a fit sets them; `masses` `[n_nodes]`, 1 kg each where left out.
/// Throws InvalidArgument for a node out of range, a pair given twice (in either direction), a spring from a node to
/// itself or of length 0. O(springs log springs).
template <int Dim, std::floating_point Scalar>
[[nodiscard]] SpringNetwork<Dim, Scalar> springs_from_list(const Points<Dim, Scalar>& rest_positions,
                                                           const NodePairs& pairs, const Values<Scalar>& masses = {}) {
    detail::check_new_springs<Dim, Scalar>(rest_positions, pairs);
    SpringNetwork<Dim, Scalar> network;
    network.rest_positions = rest_positions;
    network.springs = pairs;
    network.stiffness = Values<Scalar>::Zero(pairs.cols());
    network.damping = Values<Scalar>::Zero(pairs.cols());
    network.mass = masses.size() > 0 ? masses : Values<Scalar>(Values<Scalar>::Ones(rest_positions.cols()));
    network.rest_length.resize(pairs.cols());
    for (Index e = 0; e < pairs.cols(); ++e) {
        network.rest_length(e) = (rest_positions.col(pairs(1, e)) - rest_positions.col(pairs(0, e))).norm();
    }
    validate(network);
    return network;
}

/// Springs along the edges of a mesh, at rest, in the order edges, diagonals, second ring; masses from the cells.
///
///     auto network = springs_along_edges(mesh, {.diagonals = true, .density = 1000.});
///
/// The nodes are the corners of the mesh: of a quadratic mesh, node n is its node `corner_nodes(mesh)[n]`. Stiffness
/// and damping are 0 until a closed form or a fit sets them. A mesh of quadrilaterals or hexahedra without diagonals
/// does not resist shear. Throws InvalidArgument for a mesh or an option that cannot be used. O(cells log cells).
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] SpringNetwork<Dim, Scalar> springs_along_edges(const Mesh<Dim, Scalar, Cell>& mesh,
                                                             const SpringOptions<Scalar>& options = {}) {
    validate(mesh);
    const auto corners = corner_mesh(mesh);
    NodePairs pairs = edges(corners);
    const auto append = [&pairs](const NodePairs& more) {
        const Index before = pairs.cols();
        pairs.conservativeResize(2, before + more.cols());
        pairs.rightCols(more.cols()) = more;
    };
    if (options.diagonals) {
        append(diagonals(corners));
    }
    if constexpr (SimplexCell<Cell>) {
        if (options.second_ring) {
            append(second_ring(corners));
        }
    } else {
        require(!options.second_ring, "second_ring", "triangles or tetrahedra", Cell::name);
    }
    auto network =
        springs_from_list<Dim, Scalar>(corners.nodes, pairs, node_masses(corners, options.density, options.thickness));
    if (options.volume) {
        add_volume_cells(network, corners);
    }
    return network;
}

/// Finds the spring between two nodes. O(log springs) a look-up.
class SpringLookup {
public:
    explicit SpringLookup(const NodePairs& springs) {
        m_sorted.reserve(static_cast<std::size_t>(springs.cols()));
        for (Index e = 0; e < springs.cols(); ++e) {
            m_sorted.push_back(
                {std::min(springs(0, e), springs(1, e)), std::max(springs(0, e), springs(1, e)), static_cast<int>(e)});
        }
        std::sort(m_sorted.begin(), m_sorted.end());
    }

    /// Number of the spring between nodes i and j in either direction, -1 where there is none.
    [[nodiscard]] int find(int i, int j) const {
        const std::array<int, 3> first{std::min(i, j), std::max(i, j), 0};
        const auto found = std::lower_bound(m_sorted.begin(), m_sorted.end(), first);
        return found != m_sorted.end() && (*found)[0] == first[0] && (*found)[1] == first[1] ? (*found)[2] : -1;
    }

private:
    std::vector<std::array<int, 3>> m_sorted; ///< lower node, higher node, spring
};

} // namespace springfit
