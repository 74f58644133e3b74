// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <springfit/mesh/polar_decomposition.hpp>

namespace springfit::detail {

/// How far the surroundings of each node have turned since rest: the rotation of A = sum r r0' / |r0|^2 over the pairs
/// of neighbours at the node, none where A is no deformation of positive volume.
///
/// `Real` is a number, or lanes of as many states of the body.
template <int Dim, class Real>
class NodeRotations {
public:
    using Vec = std::array<Real, Dim>;

    /// `weighted` `[Dim x n_pairs]` has the r0 / |r0|^2 of each pair, `vector(pair)` returns its r now. O(pairs).
    template <class Weighted, class VectorOf>
    NodeRotations(Index n_nodes, const NodePairs& pairs, const Weighted& weighted, const VectorOf& vector)
        : m_rotations(static_cast<std::size_t>(n_nodes)) {
        for (auto& matrix : m_rotations) {
            matrix.fill(zero());
        }
        for (Index e = 0; e < pairs.cols(); ++e) {
            const Vec r = vector(e);
            auto& first = m_rotations[static_cast<std::size_t>(pairs(0, e))];
            auto& second = m_rotations[static_cast<std::size_t>(pairs(1, e))];
            for (int column = 0; column < Dim; ++column) {
                for (int row = 0; row < Dim; ++row) {
                    const Real product = weighted(column, e) * r[row];
                    first[column][row] += product;
                    second[column][row] += product;
                }
            }
        }
        for (auto& matrix : m_rotations) {
            make_rotation<Dim, Real>(matrix);
        }
    }

    /// R v of a node.
    [[nodiscard]] Vec turned(Index node, const Vec& v) const {
        const auto& r = m_rotations[static_cast<std::size_t>(node)];
        Vec result = scaled<Dim>(v[0], r[0]);
        for (int column = 1; column < Dim; ++column) {
            for (int row = 0; row < Dim; ++row) {
                result[row] += v[column] * r[column][row];
            }
        }
        return result;
    }

    /// R' v of a node.
    [[nodiscard]] Vec turned_back(Index node, const Vec& v) const {
        const auto& r = m_rotations[static_cast<std::size_t>(node)];
        Vec result;
        for (int column = 0; column < Dim; ++column) {
            result[column] = dot<Dim>(r[column], v);
        }
        return result;
    }

private:
    static Vec zero() {
        Vec result;
        result.fill(Real(0));
        return result;
    }

    std::vector<SquareColumns<Dim, Real>> m_rotations; ///< by columns
};

/// r0 / |r0|^2 of each pair at rest `[Dim x n_pairs]`, 0 where its nodes lie in one point.
template <int Dim, std::floating_point Scalar>
Points<Dim, Scalar> weighted_vectors(const NodePairs& pairs, const Points<Dim, Scalar>& rest) {
    Points<Dim, Scalar> vectors(Dim, pairs.cols());
    for (Index e = 0; e < pairs.cols(); ++e) {
        const Vector<Dim, Scalar> r = rest.col(pairs(1, e)) - rest.col(pairs(0, e));
        const Scalar square = r.squaredNorm();
        vectors.col(e) = square > 0 ? Vector<Dim, Scalar>(r / square) : r;
    }
    return vectors;
}

} // namespace springfit::detail
