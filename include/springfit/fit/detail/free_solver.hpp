// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <springfit/fit/detail/masked_cholesky.hpp>
#include <springfit/fit/detail/node_product.hpp>

namespace springfit::detail {

/// Moves some unknowns of a quadratic to where their gradient is 0, the others held, for one set of them after another.
///
/// Conjugate gradients preconditioned by the diagonal; once sparse Cholesky is expected to take less work,
/// preconditioned by the factor of this set, or by that of an earlier one while the two differ little. What decides is
/// a count of operations, not of seconds, so that results repeat.
class FreeSolver {
public:
    /// `curvature` is the diagonal of H; `go_on` is asked now and then.
    FreeSolver(const NodeQuadratic& objective, const Values<double>& curvature, const Execution& execution,
               std::function<bool()> go_on)
        : m_objective(objective), m_curvature(curvature), m_execution(execution), m_product(objective, execution),
          m_go_on(std::move(go_on)) {
        double packed = 0;
        for (Index i = 0; i < objective.n_terms(); ++i) {
            const auto n = static_cast<double>(objective.term(i).size());
            packed += n * (n + 1) / 2;
        }
        m_product_cost = product_slowness * (4 * packed + 30 * static_cast<double>(curvature.size()));
    }

    [[nodiscard]] int n_products() const { return m_n_products; }
    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }
    /// True once the factor is in use.
    [[nodiscard]] bool direct() const { return m_direct; }

    /// From now on H + ridge diag(H) in the place of H.
    void set_ridge(double ridge) {
        m_ridge = ridge;
        m_factorised.resize(0);
        m_direct = false;
        m_before = m_n_products;
    }

    /// result = H x; returns x'H x.
    double multiply(const Values<double>& x, Values<double>& result) {
        ++m_n_products;
        double square = m_product(x, result);
        if (m_ridge > 0) {
            m_terms = m_ridge * m_curvature.cwiseProduct(x);
            result += m_terms;
            square += m_terms.dot(x);
        }
        return square;
    }

    /// Largest scaled gradient |g_u| / sqrt(H_uu) of the unknowns to move: `weight` is 1 / H_uu for them, 0 for others.
    double largest(const Values<double>& weight, const Values<double>& gradient) {
        return measure(weight, gradient).largest;
    }

    /// Moves theta, and its whole gradient along, until `largest` is not above `target` or rounding prevents that;
    /// false where `go_on` said stop. `final` is the target of the last set, from which the work to come is estimated.
    bool solve(const Values<double>& weight, double target, double final, Values<double>& theta,
               Values<double>& gradient) {
        m_final = final;
        if (!m_direct) {
            const Outcome outcome = conjugate_gradients<Preconditioner::diagonal>(weight, target, theta, gradient,
                                                                                  std::numeric_limits<int>::max());
            if (outcome != Outcome::slow) {
                return outcome != Outcome::stopped;
            }
            m_direct = true;
        }
        // Each unknown that changed sides since takes up to two iterations.
        const auto worth = static_cast<Index>(factor_cost() / solve_cost());
        const Index changed = m_factorised.size() == 0 ? m_curvature.size()
                                                       : ((m_factorised.array() > 0) != (weight.array() > 0)).count();
        if (2 * changed <= worth) {
            const Outcome outcome = conjugate_gradients<Preconditioner::factor>(weight, target, theta, gradient,
                                                                                static_cast<int>(2 * changed + 3));
            if (outcome != Outcome::slow) {
                return outcome != Outcome::stopped;
            }
        }
        ++m_n_factorisations;
        if (!m_factor->factorise(weight, m_ridge)) {
            m_factorised.resize(0);
            return m_go_on();
        }
        m_factorised = weight;
        return conjugate_gradients<Preconditioner::factor>(weight, target, theta, gradient, 30) != Outcome::stopped;
    }

private:
    enum class Outcome { solved, slow, stopped };
    enum class Preconditioner { diagonal, factor };
    static constexpr Index unknowns_per_chunk = 2048;
    static constexpr Index most_factorised = 250000; ///< unknowns; in solids a factor has 1000 entries for each there
    static constexpr int patience = 1000;   ///< iterations in all before a factorisation is thought of: its analysis
                                            ///< takes about as long
    static constexpr double n_expected = 5; ///< factorisations until the end, once they begin
    static constexpr double product_slowness =
        0.25; ///< time of an operation in a product with H, that in a factorisation being 1
    static constexpr double solve_slowness = 1.5; ///< the same in triangular solves

    [[nodiscard]] double factor_cost() const { return m_factor->flops(); }
    [[nodiscard]] double solve_cost() const { return solve_slowness * 4 * m_factor->n_entries(); }

    /// Whether a factor is expected to be quicker, after `iterations` that made the gradient `reduced` times smaller.
    bool factor_is_quicker(int iterations, double reduced, double largest_now) {
        const int spent = m_n_products - m_before;
        if (spent < patience || iterations % 50 != 0 || m_curvature.size() > most_factorised) {
            return false;
        }
        if (!m_factor) {
            m_factor.emplace(m_objective, m_curvature);
        }
        const double direct = n_expected * (factor_cost() + 10 * solve_cost());
        const double rate = std::log(std::max(reduced, 1.01)) / iterations;
        const double to_come = std::log(std::max(largest_now / m_final, 10.)) / rate;
        return m_product_cost * std::max<double>(to_come, spent) > direct;
    }

    /// Of the gradient where `weight` is not 0.
    struct Size {
        double square = 0;  ///< gradient' diag(weight) gradient
        double largest = 0; ///< root of its largest term
    };

    /// Calls `body(begin, count)` for all chunks of unknowns and measures the gradient of each afterwards, while the
    /// caches still hold it.
    template <class Body>
    Size measure_after(const Values<double>& weight, const Values<double>& gradient, const Body& body) {
        const Index n = gradient.size();
        m_terms.resize(n);
        m_square.resize(Execution::n_chunks(n, unknowns_per_chunk));
        m_largest.resize(m_square.size());
        m_execution.for_chunks(n, unknowns_per_chunk, [&](Index chunk, Index begin, Index end) {
            body(begin, end - begin);
            auto terms = m_terms.segment(begin, end - begin).array();
            terms = weight.segment(begin, end - begin).array() * gradient.segment(begin, end - begin).array().square();
            m_square(chunk) = terms.sum();
            m_largest(chunk) = terms.maxCoeff();
        });
        return n == 0 ? Size{} : Size{m_square.sum(), std::sqrt(m_largest.maxCoeff())};
    }

    Size measure(const Values<double>& weight, const Values<double>& gradient) {
        return measure_after(weight, gradient, [](Index, Index) {});
    }

    /// m_direction = share * m_direction - M gradient, with the diagonal or the factor as M; returns gradient' M
    /// gradient, which `share_of` is given before.
    template <Preconditioner kind, class Share>
    double turn(const Values<double>& weight, const Values<double>& gradient, double square, const Share& share_of) {
        if constexpr (kind == Preconditioner::factor) {
            m_preconditioned = (weight.array() > 0).select(gradient, 0.);
            m_factor->solve(m_preconditioned, m_image);
            m_preconditioned = (weight.array() > 0).select(m_image, 0.);
            square = m_preconditioned.dot(gradient);
        }
        const double share = share_of(square);
        m_execution.for_chunks(gradient.size(), unknowns_per_chunk, [&](Index, Index begin, Index end) {
            auto direction = m_direction.segment(begin, end - begin).array();
            if constexpr (kind == Preconditioner::factor) {
                direction = share * direction - m_preconditioned.segment(begin, end - begin).array();
            } else {
                direction = share * direction -
                            weight.segment(begin, end - begin).array() * gradient.segment(begin, end - begin).array();
            }
        });
        return square;
    }

    template <Preconditioner kind>
    Outcome conjugate_gradients(const Values<double>& weight, double target, Values<double>& theta,
                                Values<double>& gradient, int max_iterations) {
        Size size = measure(weight, gradient);
        if (size.largest <= target) {
            return Outcome::solved;
        }
        m_direction.setZero(theta.size());
        double square = turn<kind>(weight, gradient, size.square, [](double) { return 0.; });
        const double first = size.square;
        double lowest = first;
        for (int i = 0; size.largest > target && square > 0; ++i) {
            if (i == max_iterations ||
                (!m_direct && i > 0 && factor_is_quicker(i, std::sqrt(first / lowest), size.largest))) {
                return Outcome::slow;
            }
            if (i % 64 == 63 && !m_go_on()) {
                return Outcome::stopped;
            }
            const double curvature = multiply(m_direction, m_image);
            if (!(curvature > 0) || size.square <= 1e-30 * first) {
                break; // rounding
            }
            const double step = square / curvature;
            size = measure_after(weight, gradient, [&](Index begin, Index count) {
                theta.segment(begin, count) += step * m_direction.segment(begin, count);
                gradient.segment(begin, count) += step * m_image.segment(begin, count);
            });
            lowest = std::min(lowest, size.square);
            square = turn<kind>(weight, gradient, size.square, [&](double next) { return next / square; });
        }
        return Outcome::solved;
    }

    const NodeQuadratic& m_objective;
    Values<double> m_curvature;
    Execution m_execution;
    NodeProduct m_product;
    std::function<bool()> m_go_on;
    double m_product_cost = 0;
    double m_final = 0;
    double m_ridge = 0;
    int m_n_products = 0;
    int m_before = 0; ///< products when the matrix last changed
    int m_n_factorisations = 0;
    bool m_direct = false;
    std::optional<MaskedCholesky> m_factor;
    Values<double> m_factorised; ///< the weight of the last factorisation
    Values<double> m_direction, m_image, m_preconditioned, m_terms;
    Values<double> m_square, m_largest; ///< by chunks of unknowns
};

} // namespace springfit::detail
