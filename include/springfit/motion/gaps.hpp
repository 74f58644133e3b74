// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <springfit/core/error.hpp>
#include <springfit/core/types.hpp>

namespace springfit {

namespace detail {

/// Fills in the displacements of recorded nodes where they are not finite.
template <int Dim, std::floating_point Scalar>
class GapFiller {
public:
    using Frames = std::vector<Points<Dim, Scalar>>;

    GapFiller(const Points<Dim, Scalar>& rest, const std::vector<Scalar>& times, Frames& displacements)
        : m_rest(rest), m_times(times), m_displacements(displacements) {}

    [[nodiscard]] std::vector<std::vector<int>> fill() {
        find_gaps();
        if (m_n_gaps == 0) {
            return {};
        }
        std::vector<int> seen;
        std::vector<int> never_seen;
        for (Index i = 0; i < m_rest.cols(); ++i) {
            (follow_in_time(i) ? seen : never_seen).push_back(static_cast<int>(i));
        }
        require(!seen.empty(), "displacements", "a node that was seen", "none in any frame");
        for (int node : never_seen) {
            follow_neighbours(node, seen);
        }
        project();
        return std::move(m_unobserved);
    }

private:
    void find_gaps() {
        m_unobserved.resize(m_displacements.size());
        for (std::size_t t = 0; t < m_displacements.size(); ++t) {
            for (Index i = 0; i < m_rest.cols(); ++i) {
                if (!m_displacements[t].col(i).allFinite()) {
                    m_unobserved[t].push_back(static_cast<int>(i));
                    ++m_n_gaps;
                }
            }
        }
    }

    [[nodiscard]] bool is_seen(std::size_t frame, Index node) const {
        return !std::binary_search(m_unobserved[frame].begin(), m_unobserved[frame].end(), static_cast<int>(node));
    }

    /// A line in time from the frame before a gap to the one after it; at the ends the nearest frame. False for a node
    /// that is in no frame.
    bool follow_in_time(Index node) {
        std::vector<std::size_t> seen;
        for (std::size_t t = 0; t < m_displacements.size(); ++t) {
            if (is_seen(t, node)) {
                seen.push_back(t);
            }
        }
        for (std::size_t t = 0; t < m_displacements.size() && !seen.empty(); ++t) {
            if (is_seen(t, node)) {
                continue;
            }
            const auto after = std::lower_bound(seen.begin(), seen.end(), t);
            const std::size_t b = after == seen.end() ? seen.back() : *after;
            const std::size_t a = after == seen.begin() ? b : *(after - 1);
            const Scalar s = a == b ? Scalar(0) : (m_times[t] - m_times[a]) / (m_times[b] - m_times[a]);
            m_displacements[t].col(node) = (1 - s) * m_displacements[a].col(node) + s * m_displacements[b].col(node);
        }
        return !seen.empty();
    }

    /// A node that is in no frame moves as those around it do in the mean, by their distances' inverse squares.
    void follow_neighbours(int node, const std::vector<int>& seen) {
        std::vector<std::pair<Scalar, int>> near;
        for (int other : seen) {
            near.emplace_back((m_rest.col(other) - m_rest.col(node)).squaredNorm(), other);
        }
        const auto count = std::min<std::size_t>(near.size(), 4 * Dim);
        std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
        near.resize(count);
        const Scalar least = near.front().first; // 0 for a point that is there twice
        for (std::size_t t = 0; t < m_displacements.size(); ++t) {
            Vector<Dim, Scalar> moved = Vector<Dim, Scalar>::Zero();
            Scalar sum = 0;
            for (const auto& [distance, other] : near) {
                const Scalar weight = distance > 0 ? least / distance : Scalar(1);
                moved += weight * m_displacements[t].col(other);
                sum += weight;
            }
            m_displacements[t].col(node) = moved / sum;
        }
    }

    /// Gaps follow the principal motions of all nodes: first the largest alone, again and again until they rest, then
    /// one more each time. All at once would take the lines that gaps begin as for motions.
    void project() {
        const auto n_frames = static_cast<Index>(m_displacements.size());
        if (n_frames < 4) {
            return;
        }
        constexpr double least = 1e-3; // part of the largest that a principal motion must have
        constexpr Index most = 12;     // principal motions
        DenseMatrix<double> u(m_rest.size(), n_frames);
        for (Index t = 0; t < n_frames; ++t) {
            u.col(t) = m_displacements[static_cast<std::size_t>(t)].reshaped().template cast<double>();
        }
        for (Index rank = 1; rank <= std::min(most, n_frames / 2); ++rank) {
            double size = 0;
            for (int iteration = 0; iteration < 50; ++iteration) {
                const DenseMatrix<double> gram = u.transpose() * u;
                const Eigen::SelfAdjointEigenSolver<DenseMatrix<double>> principal(gram);
                size = principal.eigenvalues()(n_frames - rank) / principal.eigenvalues()(n_frames - 1);
                if (!(size > least * least)) {
                    break;
                }
                const DenseMatrix<double> v = principal.eigenvectors().rightCols(rank);
                if (move_gaps(u, u * v, v) <= 1e-10) {
                    break;
                }
            }
            if (!(size > least * least)) {
                break;
            }
        }
        for (Index t = 0; t < n_frames; ++t) {
            auto& frame = m_displacements[static_cast<std::size_t>(t)];
            for (int node : m_unobserved[static_cast<std::size_t>(t)]) {
                frame.col(node) = u.col(t).segment<Dim>(Dim * node).template cast<Scalar>();
            }
        }
    }

    /// Sets the gaps of u to amplitudes v', returns the square of the change beside that of their size.
    double move_gaps(DenseMatrix<double>& u, const DenseMatrix<double>& amplitudes,
                     const DenseMatrix<double>& v) const {
        double change = 0;
        double size = 0;
        for (Index t = 0; t < u.cols(); ++t) {
            for (int node : m_unobserved[static_cast<std::size_t>(t)]) {
                const Vector<Dim, double> filled = amplitudes.middleRows<Dim>(Dim * node) * v.row(t).transpose();
                change += (filled - u.col(t).segment<Dim>(Dim * node)).squaredNorm();
                size += filled.squaredNorm();
                u.col(t).segment<Dim>(Dim * node) = filled;
            }
        }
        return size > 0 ? change / size : 0.;
    }

    const Points<Dim, Scalar>& m_rest;
    const std::vector<Scalar>& m_times;
    Frames& m_displacements;
    std::vector<std::vector<int>> m_unobserved;
    std::size_t m_n_gaps = 0;
};

} // namespace detail

/// Fills in displacements that are not finite, as of markers that were lost; returns the nodes that lack in each frame,
/// ascending, or nothing where none does.
///
/// A gap starts as a line in time, or for a node that is in no frame as the motion of the nodes around it; then all
/// gaps are projected on the principal motions of the recording, one more after another, up to twelve and those above a
/// thousandth of the largest, each time until that changes them no more [our definition]. Throws InvalidArgument where
/// no node is seen. O(nodes x frames^2) for each of up to 600 projections.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<std::vector<int>> fill_gaps(const Points<Dim, Scalar>& rest_positions,
                                                      const std::vector<Scalar>& times,
                                                      std::vector<Points<Dim, Scalar>>& displacements) {
    require(times.size() == displacements.size(), "times", text(displacements.size(), " values, one per frame"),
            times.size());
    return detail::GapFiller<Dim, Scalar>(rest_positions, times, displacements).fill();
}

} // namespace springfit
