// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

/// Numbers the nodes that may move; the unknowns of a solve are their coordinates, node by node.
class FreeNodes {
public:
    FreeNodes() = default;

    /// All of `n_nodes` nodes but the `fixed` ones.
    FreeNodes(Index n_nodes, const std::vector<int>& fixed) : m_number(static_cast<std::size_t>(n_nodes), 0) {
        for (int node : fixed) {
            require(node >= 0 && node < n_nodes, "fixed", text("node numbers in [0, ", n_nodes, ")"), node);
            m_number[static_cast<std::size_t>(node)] = -1;
        }
        for (Index i = 0; i < n_nodes; ++i) {
            auto& number = m_number[static_cast<std::size_t>(i)];
            if (number == 0) {
                number = static_cast<int>(m_nodes.size());
                m_nodes.push_back(static_cast<int>(i));
            }
        }
    }

    [[nodiscard]] Index n_nodes() const { return static_cast<Index>(m_number.size()); }
    [[nodiscard]] Index n_free() const { return static_cast<Index>(m_nodes.size()); }

    /// Number of a node among the free ones, -1 for a fixed node.
    [[nodiscard]] int number(Index node) const { return m_number[static_cast<std::size_t>(node)]; }

    /// The free nodes, ascending.
    [[nodiscard]] const std::vector<int>& nodes() const { return m_nodes; }

    /// The columns of the free nodes as one vector `[Dim * n_free]`.
    template <int Dim, std::floating_point Scalar>
    [[nodiscard]] Values<Scalar> gather(const Points<Dim, Scalar>& points) const {
        Values<Scalar> values(Dim * n_free());
        for (Index f = 0; f < n_free(); ++f) {
            values.template segment<Dim>(Dim * f) = points.col(m_nodes[static_cast<std::size_t>(f)]);
        }
        return values;
    }

    /// Writes a vector of the free coordinates into the columns of the free nodes; the others stay.
    template <int Dim, std::floating_point Scalar>
    void scatter(const Values<Scalar>& values, Points<Dim, Scalar>& points) const {
        for (Index f = 0; f < n_free(); ++f) {
            points.col(m_nodes[static_cast<std::size_t>(f)]) = values.template segment<Dim>(Dim * f);
        }
    }

private:
    std::vector<int> m_number;
    std::vector<int> m_nodes;
};

} // namespace springfit
