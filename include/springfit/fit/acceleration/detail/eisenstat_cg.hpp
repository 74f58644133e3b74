// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/detail/symmetric_gauss_seidel.hpp>
#include <springfit/solve/conjugate_gradients.hpp>

namespace springfit::detail {

/// Conjugate gradients for the free part of H step = -gradient, preconditioned by symmetric Gauss-Seidel.
///
/// In the scaled matrix A = W + W' - d I they are conjugate gradients for W^-1 A W'^-1. With q = W' p beside the
/// direction p,
///
///     W^-1 A p = p + W^-1 (q - d p)   and   p' A p = 2 p' q - d p' p ,
///
/// so that an iteration takes the two sweeps that the preconditioner alone would take, and no product with A
/// [Eisenstat1981]. What is iterated is r = W^-1 times the residual.
template <std::floating_point Scalar>
class EisenstatCg {
public:
    using Sweeps = SymmetricGaussSeidel<Scalar>;

    EisenstatCg(const NodeQuadratic& objective, const Values<double>& curvature, const Execution& execution)
        : m_execution(execution), m_sweeps(objective, curvature, execution) {}

    [[nodiscard]] Index n_entries() const { return m_sweeps.n_entries(); }
    /// |r|^2 and the largest entry of r, relative to those at the start.
    [[nodiscard]] double square() const { return m_now.square / m_first.square; }
    [[nodiscard]] double largest() const { return m_now.largest / m_first.largest; }

    /// Anew from a step of 0, for the unknowns with a weight, and with H + ridge diag(H) in the place of H. `unit` is
    /// about the size of the scaled gradient; vectors hold multiples of it.
    void start(const Values<double>& weight, const Values<double>& gradient, double ridge, double unit) {
        m_unit = unit;
        m_diagonal = static_cast<Scalar>(1 + ridge);
        m_sweeps.gather(weight, gradient, unit, m_image);
        for (Values<Scalar>* vector : {&m_residual, &m_conjugate, &m_direction, &m_step}) {
            vector->setZero(m_sweeps.size());
        }
        m_sweeps.solve_lower(m_diagonal, [&](Index u) -> Lanes { return -lanes(m_image, u); }, m_residual);
        m_first = m_now = measured_after([](Index, Index) {});
        m_share = 0;
    }

    /// False, with the step as it was, where rounding shows A not to be positive definite.
    bool iterate() {
        double square = static_cast<double>(m_diagonal) * m_now.square;
        return cg_iteration(*this, square);
    }

    /// Writes the step so far `[n_unknowns]`, and goes on from there with a step of 0.
    void take_step(Values<double>& step) {
        m_sweeps.scatter(m_step, m_unit, step);
        m_step.setZero();
    }

    // The passes of an iteration. What preconditions is in the sweeps; the next direction is made in the first of them.

    double multiply() {
        const auto d = m_diagonal;
        const auto sums = m_sweeps.solve_upper(
            d,
            [&](Index u) -> Lanes {
                return lanes(m_conjugate, u) = d * lanes(m_residual, u) + m_share * lanes(m_conjugate, u);
            },
            m_direction);
        const double curvature = 2 * sums.xb - d * sums.xx;
        if (curvature > 0) {
            m_sweeps.solve_lower(
                d, [&](Index u) -> Lanes { return lanes(m_conjugate, u) - d * lanes(m_direction, u); }, m_image);
        }
        return curvature;
    }
    void move(double alpha) {
        const auto length = static_cast<Scalar>(alpha);
        m_now = measured_after([&](Index begin, Index count) {
            const auto direction = m_direction.segment(begin, count);
            m_step.segment(begin, count) += length * direction;
            m_residual.segment(begin, count) -= length * (direction + m_image.segment(begin, count));
        });
    }
    [[nodiscard]] static bool is_solved() { return false; } // up to the caller
    double precondition() { return static_cast<double>(m_diagonal) * m_now.square; }
    void turn(double beta) { m_share = static_cast<Scalar>(beta); }

private:
    using Lanes = typename Sweeps::Lanes;
    static constexpr Index places_per_chunk = 2048;

    struct Size {
        double square = 0;
        double largest = 0;
    };

    static Lanes& lanes(Values<Scalar>& values, Index begin) { return Lanes::at(values.data() + begin); }

    /// Calls `body(begin, count)` for all chunks of places and measures r of each afterwards, while the caches still
    /// hold it.
    template <class Body>
    Size measured_after(const Body& body) {
        const Index n = m_residual.size();
        m_sizes.resize(static_cast<std::size_t>(Execution::n_chunks(n, places_per_chunk)));
        m_execution.for_chunks(n, places_per_chunk, [&](Index chunk, Index begin, Index end) {
            body(begin, end - begin);
            const auto residual = m_residual.segment(begin, end - begin);
            m_sizes[static_cast<std::size_t>(chunk)] = {static_cast<double>(residual.squaredNorm()),
                                                        static_cast<double>(residual.cwiseAbs().maxCoeff())};
        });
        Size total;
        for (const Size& size : m_sizes) {
            total.square += size.square;
            total.largest = std::max(total.largest, size.largest);
        }
        return total;
    }

    Execution m_execution;
    Sweeps m_sweeps;
    Scalar m_diagonal = 1;
    Scalar m_share = 0; ///< of the last direction in the next
    double m_unit = 1;  ///< what 1 stands for in the vectors
    Size m_first, m_now;
    Values<Scalar> m_residual, m_conjugate, m_direction, m_image, m_step; ///< r, q, p, W^-1 (q - d p)
    std::vector<Size> m_sizes;                                            ///< by chunk
};

} // namespace springfit::detail
