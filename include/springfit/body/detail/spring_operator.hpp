// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/detail/moving_nodes.hpp>
#include <springfit/solve/conjugate_gradients.hpp>

namespace springfit::detail {

/// A cell's part of the Hessian at given positions, +-g g' and a pressure times the second derivative of V.
template <int Dim, std::floating_point Real>
struct CellTerm {
    SimplexCorners<Dim, Real> gradient; ///< sqrt(|kappa| / V_c) dV/dx
    std::array<Vector<Dim, Real>, Dim> sides;
    int nodes[Dim + 1]; ///< by their numbers inside
    Real sign = 0;      ///< of g g'; 0 leaves it out
    Real pressure = 0;  ///< kappa (V - V_c) / V_c; 0 leaves its part out

    /// The product with displacements of the corners.
    [[nodiscard]] SimplexCorners<Dim, Real> product(const SimplexCorners<Dim, Real>& d) const {
        SimplexCorners<Dim, Real> result = (sign * gradient.cwiseProduct(d).sum()) * gradient;
        if (pressure == 0) {
            return result;
        }
        const Real factor = pressure * simplex_share<Dim, Real>;
        const auto change = spanned_gradient_along<Dim>(sides, sides_of<Dim, Real>(d));
        for (int a = 0; a < Dim; ++a) {
            const Vector<Dim, Real> force = factor * change[a];
            result.col(a + 1) += force;
            result.col(0) -= force;
        }
        return result;
    }
};

/// The matrix of an implicit step, never assembled, and conjugate gradients with it:
///
///     A = M / h^2 + sum over springs of (c_1 I + u u') in its own place + the cells,
///
/// so that the product of a spring takes d = p_j - p_i to c_1 d + (u . d) u: 4 numbers and two ints per spring. Its
/// preconditioner is the inverse of the blocks on the diagonal; clamped nodes have a zero there and never move. The
/// numbers are of the precision `Real`, sums over all nodes of double precision.
template <int Dim, std::floating_point Real>
class SpringOperator {
public:
    struct Block {
        Four<Real> columns[Dim];
    };

    /// Springs that lie one after another: two ends and (u, c_1) each, an even number of them.
    struct Part {
        std::vector<int> ends;
        std::vector<Four<Real>> terms;
    };
    struct Domain {
        int begin = 0, end = 0;
        Part inner, border;
        std::vector<CellTerm<Dim, Real>> cells;
        double sums[2] = {};
    };

    template <class Packed>
    explicit SpringOperator(const Packed& springs) : m_domains(springs.domains().size()) {
        for (std::size_t d = 0; d < m_domains.size(); ++d) {
            const auto& source = springs.domains()[d];
            m_domains[d].begin = source.begin;
            m_domains[d].end = source.end;
            m_domains[d].inner = part(source.inner);
            m_domains[d].border = part(source.border);
            m_domains[d].cells.resize(source.cells.size());
        }
        const auto n = static_cast<std::size_t>(springs.n_nodes());
        m_x.resize(n);
        m_r.resize(n);
        m_p.resize(n);
        m_q.resize(n);
        m_z.resize(n);
        m_inverse.resize(n);
        m_inertia.resize(n);
    }

    [[nodiscard]] Domain& domain(std::size_t d) { return m_domains[d]; }
    [[nodiscard]] std::vector<Block>& blocks() { return m_inverse; }   ///< blocks of the diagonal, then their inverse
    [[nodiscard]] std::vector<Real>& inertia() { return m_inertia; }   ///< m / h^2
    [[nodiscard]] std::vector<Four<Real>>& residual() { return m_r; }  ///< the right-hand side on entry
    [[nodiscard]] std::vector<Four<Real>>& direction() { return m_p; } ///< what `multiply` takes
    [[nodiscard]] const std::vector<Four<Real>>& product() const { return m_q; }
    [[nodiscard]] const std::vector<Four<Real>>& solution() const { return m_x; }

    /// Inverts the blocks of the nodes from `begin` to `end`, inertia added; 0 where `is_free` is 0.
    void invert(int begin, int end, const std::vector<char>& is_free);

    /// q = A p for the nodes of a domain; returns its share of p . q.
    double multiply(Domain& domain);

    struct Outcome {
        int iterations = 0;
        double decrease = 0;     ///< b . x, b the scaled right-hand side: how steeply the energy falls along x
        bool indefinite = false; ///< stopped at a direction of negative curvature
    };

    /// Solves A x = scale r by conjugate gradients from 0, to a residual of `tolerance` in the norm of the
    /// preconditioner; `scale` keeps squares within range.
    Outcome solve(const Execution& execution, Real scale, Real tolerance, int max_iterations);

private:
    struct Cg;

    template <class Blocks>
    static Part part(const Blocks& blocks) {
        using Source = typename Blocks::value_type;
        constexpr std::size_t lanes = sizeof(Source::first) / sizeof(int);
        static_assert(lanes % 2 == 0);
        Part result;
        result.terms.resize(lanes * blocks.size());
        for (const auto& block : blocks) {
            for (std::size_t lane = 0; lane < lanes; ++lane) {
                result.ends.push_back(block.first[lane]);
                result.ends.push_back(block.second[lane]);
            }
        }
        return result;
    }

    template <bool OnBothEnds>
    double multiply_springs(const Part& part);
    double multiply_cells(const Domain& domain);

    template <class Body>
    std::array<double, 2> sum(const Execution& execution, const Body& body);

    std::vector<Domain> m_domains;
    std::vector<Block> m_inverse;
    std::vector<Real> m_inertia;
    std::vector<Four<Real>> m_x, m_r, m_p, m_q, m_z; ///< the lanes of p and z beyond Dim are 0
};

template <int Dim, std::floating_point Real>
void SpringOperator<Dim, Real>::invert(int begin, int end, const std::vector<char>& is_free) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
        Eigen::Matrix<Real, Dim, Dim> matrix;
        for (int c = 0; c < Dim; ++c) {
            for (int r = 0; r < Dim; ++r) {
                matrix(r, c) = m_inverse[i].columns[c].lanes[r];
            }
            matrix(c, c) += m_inertia[i];
        }
        const Real size = is_free[i] ? 1 / matrix.trace() : Real(0); // keeps the determinant within range
        const Eigen::Matrix<Real, Dim, Dim> inverse =
            is_free[i] ? Eigen::Matrix<Real, Dim, Dim>((size * matrix).inverse()) : matrix;
        for (int c = 0; c < Dim; ++c) {
            m_inverse[i].columns[c] = {};
            for (int r = 0; r < Dim; ++r) {
                m_inverse[i].columns[c].lanes[r] = size * inverse(r, c);
            }
        }
    }
}

template <int Dim, std::floating_point Real>
template <bool OnBothEnds>
double SpringOperator<Dim, Real>::multiply_springs(const Part& part) {
    using Pair = Simd<Real, 8>;
    constexpr std::size_t per_chunk = 64;
    const std::size_t n = part.terms.size();
    const int* const ends = part.ends.data();
    const Four<Real>* const terms = part.terms.data();
    const Four<Real>* const p = m_p.data();
    Four<Real>* __restrict const q = m_q.data();
    double curvature = 0;
    for (std::size_t first = 0; first < n; first += per_chunk) {
        const std::size_t last = std::min(n, first + per_chunk);
        Pair sum = {};
        for (std::size_t s = first; s < last; s += 2) {
            const int i = ends[2 * s], j = ends[2 * s + 1], k = ends[2 * s + 2], l = ends[2 * s + 3];
            const Pair d = __builtin_shufflevector(p[j].lanes, p[l].lanes, 0, 1, 2, 3, 4, 5, 6, 7) -
                           __builtin_shufflevector(p[i].lanes, p[k].lanes, 0, 1, 2, 3, 4, 5, 6, 7);
            const Pair u = __builtin_shufflevector(terms[s].lanes, terms[s + 1].lanes, 0, 1, 2, 3, 4, 5, 6, 7);
            Pair t = u * d; // its last lane is 0, as that of d
            t += __builtin_shufflevector(t, t, 2, 3, 0, 1, 6, 7, 4, 5);
            t += __builtin_shufflevector(t, t, 1, 0, 3, 2, 5, 4, 7, 6);
            const Pair force = __builtin_shufflevector(u, u, 3, 3, 3, 3, 7, 7, 7, 7) * d + t * u;
            sum += d * force;
            const auto low = __builtin_shufflevector(force, force, 0, 1, 2, 3);
            const auto high = __builtin_shufflevector(force, force, 4, 5, 6, 7);
            q[i].lanes -= low;
            if constexpr (OnBothEnds) {
                q[j].lanes += low;
            }
            q[k].lanes -= high;
            if constexpr (OnBothEnds) {
                q[l].lanes += high;
            }
        }
        Real total = 0;
        for (int lane = 0; lane < 8; ++lane) {
            total += sum[lane];
        }
        curvature += static_cast<double>(total);
    }
    return OnBothEnds ? curvature : curvature / 2; // a spring between domains counts in both
}

template <int Dim, std::floating_point Real>
double SpringOperator<Dim, Real>::multiply_cells(const Domain& domain) {
    double curvature = 0;
    for (const auto& cell : domain.cells) {
        if (cell.sign == 0 && cell.pressure == 0) {
            continue;
        }
        SimplexCorners<Dim, Real> d;
        for (int a = 0; a <= Dim; ++a) {
            for (int c = 0; c < Dim; ++c) {
                d(c, a) = m_p[static_cast<std::size_t>(cell.nodes[a])].lanes[c];
            }
        }
        const SimplexCorners<Dim, Real> product = cell.product(d);
        for (int a = 0; a <= Dim; ++a) {
            const int node = cell.nodes[a];
            if (node >= domain.begin && node < domain.end) {
                for (int c = 0; c < Dim; ++c) {
                    m_q[static_cast<std::size_t>(node)].lanes[c] += product(c, a);
                }
                curvature += static_cast<double>(product.col(a).dot(d.col(a)));
            }
        }
    }
    return curvature;
}

template <int Dim, std::floating_point Real>
double SpringOperator<Dim, Real>::multiply(Domain& domain) {
    double curvature = 0;
    for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end);) {
        const std::size_t last = std::min(static_cast<std::size_t>(domain.end), i + 64);
        Simd<Real, 4> sum = {};
        for (; i < last; ++i) {
            m_q[i].lanes = m_inertia[i] * m_p[i].lanes;
            sum += m_q[i].lanes * m_p[i].lanes;
        }
        curvature += static_cast<double>(sum[0] + sum[1] + sum[2]);
    }
    curvature += multiply_springs<true>(domain.inner);
    curvature += multiply_springs<false>(domain.border);
    return curvature + multiply_cells(domain);
}

/// The sums over all domains of the two numbers that `body(domain, sums)` adds to, in the order of domains.
template <int Dim, std::floating_point Real>
template <class Body>
std::array<double, 2> SpringOperator<Dim, Real>::sum(const Execution& execution, const Body& body) {
    execution.for_chunks(static_cast<Index>(m_domains.size()), 1, [&](Index d, Index, Index) {
        Domain& domain = m_domains[static_cast<std::size_t>(d)];
        domain.sums[0] = domain.sums[1] = 0;
        body(domain);
    });
    std::array<double, 2> total = {};
    for (const Domain& domain : m_domains) {
        total[0] += domain.sums[0];
        total[1] += domain.sums[1];
    }
    return total;
}

/// The passes of an iteration: x is moved and the next p made in one, r and z in another.
template <int Dim, std::floating_point Real>
struct SpringOperator<Dim, Real>::Cg {
    using Lanes = Simd<Real, 4>;
    SpringOperator& a;
    const Execution& execution;
    Real alpha = 0;
    double curvature = 0; ///< p . A p

    double multiply() {
        curvature = a.sum(execution, [&](Domain& domain) { domain.sums[0] = a.multiply(domain); })[0];
        return curvature;
    }
    void move(double length) { alpha = static_cast<Real>(length); }
    [[nodiscard]] static bool is_solved() { return false; } // up to the caller
    double precondition() {
        return a.sum(execution, [&](Domain& domain) { precondition(domain); })[0];
    }
    void turn(double beta) {
        const auto share = static_cast<Real>(beta);
        a.sum(execution, [&](Domain& domain) { turn(domain, share); });
    }

    /// r -= alpha q, z = D^-1 r; adds up r . z.
    void precondition(Domain& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end);) {
            const std::size_t last = std::min(static_cast<std::size_t>(domain.end), i + 64);
            Lanes total = {};
            for (; i < last; ++i) {
                const auto& inverse = a.m_inverse[i].columns;
                const Lanes r = a.m_r[i].lanes - alpha * a.m_q[i].lanes;
                Lanes z = __builtin_shufflevector(r, r, 0, 0, 0, 0) * inverse[0].lanes +
                          __builtin_shufflevector(r, r, 1, 1, 1, 1) * inverse[1].lanes;
                if constexpr (Dim == 3) {
                    z += __builtin_shufflevector(r, r, 2, 2, 2, 2) * inverse[2].lanes;
                }
                a.m_r[i].lanes = r;
                a.m_z[i].lanes = z;
                total += r * z;
            }
            domain.sums[0] += static_cast<double>(total[0] + total[1] + (Dim == 3 ? total[2] : Real(0)));
        }
    }

    /// x += alpha p, p = z + share p.
    void turn(const Domain& domain, Real share) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            const Lanes p = a.m_p[i].lanes;
            a.m_x[i].lanes += alpha * p;
            a.m_p[i].lanes = a.m_z[i].lanes + share * p;
        }
    }
};

template <int Dim, std::floating_point Real>
auto SpringOperator<Dim, Real>::solve(const Execution& execution, Real scale, Real tolerance, int max_iterations)
    -> Outcome {
    Outcome outcome;
    Cg system{*this, execution};
    double rz = sum(execution, [&](Domain& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            m_r[i].lanes *= scale;
            m_x[i] = m_p[i] = m_q[i] = {};
        }
        system.precondition(domain);
        system.turn(domain, 0);
    })[0];
    const double goal = static_cast<double>(tolerance) * static_cast<double>(tolerance) * rz;
    while (outcome.iterations < max_iterations && rz > goal) {
        const double before = rz;
        if (!cg_iteration(system, rz)) {
            outcome.indefinite = true;
            if (outcome.iterations == 0) { // downhill at least
                system.alpha = static_cast<Real>(system.curvature < 0 ? rz / -system.curvature : 1);
                outcome.decrease = rz * static_cast<double>(system.alpha);
                system.turn(0);
            }
            break;
        }
        ++outcome.iterations;
        outcome.decrease += before * before / system.curvature;
    }
    return outcome;
}

} // namespace springfit::detail
