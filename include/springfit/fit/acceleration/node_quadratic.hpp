// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <springfit/fit/acceleration/detail/packed_product.hpp>

namespace springfit {

/// A convex quadratic that is a sum of node terms, each over the few unknowns of the springs at its node:
///
///     Phi(theta) = sum_i Phi_i(theta_i) + 1/2 sum_u ridge_u (theta_u - centre_u)^2
///     Phi_i      = 1/2 theta_i' H_i theta_i - g_i' theta_i + c_i
///
/// H_i is kept as its packed lower triangle, column by column: about valence^2 / 2 numbers per node.
class NodeQuadratic {
public:
    using Unknowns = Values<double>; ///< one value per unknown

    /// One node term, seen in place.
    struct Term {
        int node;                     ///< number of the node in the network
        std::span<const int> columns; ///< its unknowns, ascending [n]
        const double* hessian;        ///< packed lower triangle [n (n + 1) / 2]
        const double* linear;         ///< g_i [n]
        double constant;              ///< c_i

        [[nodiscard]] Index size() const { return static_cast<Index>(columns.size()); }
        /// Where column p of the packed triangle begins, at row p.
        [[nodiscard]] Index column_begin(Index p) const { return p * size() - p * (p - 1) / 2; }
        /// H_i(p, q), in any order.
        [[nodiscard]] double entry(Index p, Index q) const {
            return p < q ? hessian[column_begin(p) + q - p] : hessian[column_begin(q) + p - q];
        }
    };

    /// One occurrence of an unknown: the term, and the column of that term.
    struct Occurrence {
        int term;
        int position;
    };

    NodeQuadratic() = default;
    explicit NodeQuadratic(Index n_unknowns)
        : m_ridge(Values<double>::Zero(n_unknowns)), m_centre(Values<double>::Zero(n_unknowns)) {}

    /// Many terms, one after another.
    struct Terms {
        std::vector<int> node, size;  ///< per term: number of its node, and of its unknowns
        std::vector<double> constant; ///< per term
        std::vector<int> columns;     ///< unknowns of all terms, ascending in each
        std::vector<double> hessian;  ///< their packed lower triangles
        std::vector<double> linear;   ///< g_i, beside `columns`
    };

    /// Takes over terms without a copy.
    NodeQuadratic(Index n_unknowns, Terms terms) : NodeQuadratic(n_unknowns) {
        for (const int n : terms.size) {
            m_column_begin.push_back(m_column_begin.back() + n);
            m_hessian_begin.push_back(m_hessian_begin.back() + Index(n) * (n + 1) / 2);
        }
        m_node = std::move(terms.node);
        m_constant = std::move(terms.constant);
        m_columns = std::move(terms.columns);
        m_hessian = std::move(terms.hessian);
        m_linear = std::move(terms.linear);
    }

    /// Appends a term; `hessian` is the packed lower triangle in the order of `columns`, which ascend.
    void add_term(int node, std::span<const int> columns, std::span<const double> hessian,
                  std::span<const double> linear, double constant) {
        m_node.push_back(node);
        m_constant.push_back(constant);
        m_columns.insert(m_columns.end(), columns.begin(), columns.end());
        m_hessian.insert(m_hessian.end(), hessian.begin(), hessian.end());
        m_linear.insert(m_linear.end(), linear.begin(), linear.end());
        m_column_begin.push_back(static_cast<Index>(m_columns.size()));
        m_hessian_begin.push_back(static_cast<Index>(m_hessian.size()));
    }

    /// Sets the quadratic penalty that is not part of any node `[n_unknowns]` each.
    void set_ridge(const Values<double>& ridge, const Values<double>& centre) {
        m_ridge = ridge;
        m_centre = centre;
    }

    [[nodiscard]] Index n_unknowns() const { return m_ridge.size(); }
    [[nodiscard]] Index n_terms() const { return static_cast<Index>(m_node.size()); }
    [[nodiscard]] const Values<double>& ridge() const { return m_ridge; }
    [[nodiscard]] const Values<double>& centre() const { return m_centre; }

    [[nodiscard]] Term term(Index i) const {
        const auto t = static_cast<std::size_t>(i);
        const Index begin = m_column_begin[t];
        return {m_node[t],
                {m_columns.data() + begin, static_cast<std::size_t>(m_column_begin[t + 1] - begin)},
                m_hessian.data() + m_hessian_begin[t],
                m_linear.data() + begin,
                m_constant[t]};
    }

    /// Position of the first column of term i among the columns of all terms, for arrays that run beside them.
    [[nodiscard]] Index first_column(Index i) const { return m_column_begin[static_cast<std::size_t>(i)]; }
    [[nodiscard]] Index n_columns() const { return static_cast<Index>(m_columns.size()); }

    /// H_i theta_i - g_i, the gradient of one term, into `gradient` `[term(i).size()]`; returns Phi_i.
    double term_gradient(Index i, const Values<double>& theta, double* gradient) const {
        Scratch scratch;
        const double value = term_gradient(i, theta, scratch);
        std::copy_n(scratch.image.data(), term(i).size(), gradient);
        return value;
    }

    /// Phi(theta); never below 0 by rounding. O(terms * valence^2), as all that follow.
    [[nodiscard]] double value(const Values<double>& theta) const {
        Scratch scratch;
        double sum = ridge_value(theta);
        for (Index i = 0; i < n_terms(); ++i) {
            sum += term_gradient(i, theta, scratch);
        }
        return std::max(sum, 0.);
    }

    /// Gradient of Phi `[n_unknowns]`.
    [[nodiscard]] Values<double> gradient(const Values<double>& theta) const {
        Values<double> result;
        (void)evaluate(theta, result);
        return result;
    }

    /// Phi(theta), and its gradient into `gradient` `[n_unknowns]`, in one pass over the blocks.
    double evaluate(const Values<double>& theta, Values<double>& gradient) const {
        Scratch scratch;
        double sum = ridge_value(theta);
        gradient = m_ridge.cwiseProduct(theta - m_centre);
        for (Index i = 0; i < n_terms(); ++i) {
            sum += term_gradient(i, theta, scratch);
            add(term(i), scratch, gradient);
        }
        return std::max(sum, 0.);
    }

    /// H x `[n_unknowns]`, from the node blocks.
    [[nodiscard]] Values<double> product(const Values<double>& x) const {
        Values<double> result = m_ridge.cwiseProduct(x);
        Scratch scratch;
        for (Index i = 0; i < n_terms(); ++i) {
            const Term t = term(i);
            scratch.multiply(t, x);
            add(t, scratch, result);
        }
        return result;
    }

    /// The linear part g, so that the gradient is H theta - g `[n_unknowns]`.
    [[nodiscard]] Values<double> linear() const {
        Values<double> result = m_ridge.cwiseProduct(m_centre);
        for (std::size_t c = 0; c < m_columns.size(); ++c) {
            result(m_columns[c]) += m_linear[c];
        }
        return result;
    }

    /// Diagonal of H: the curvature of each unknown `[n_unknowns]`.
    [[nodiscard]] Values<double> curvature() const {
        Values<double> result = m_ridge;
        for (Index i = 0; i < n_terms(); ++i) {
            const Term t = term(i);
            for (Index p = 0; p < t.size(); ++p) {
                result(t.columns[static_cast<std::size_t>(p)]) += t.hessian[t.column_begin(p)];
            }
        }
        return result;
    }

    /// Lower triangle of H `[n_unknowns x n_unknowns]`; an entry for each two unknowns that share a node.
    template <std::same_as<double> Real = double>
    [[nodiscard]] SparseMatrix<Real> hessian() const {
        std::vector<Eigen::Triplet<Real>> entries;
        entries.reserve(m_hessian.size() + static_cast<std::size_t>(n_unknowns()));
        for (Index u = 0; u < n_unknowns(); ++u) {
            entries.emplace_back(static_cast<int>(u), static_cast<int>(u), m_ridge(u));
        }
        for (Index i = 0; i < n_terms(); ++i) {
            const Term t = term(i);
            const Real* value = t.hessian;
            for (std::size_t q = 0; q < t.columns.size(); ++q) {
                for (std::size_t p = q; p < t.columns.size(); ++p) {
                    entries.emplace_back(t.columns[p], t.columns[q], *value++);
                }
            }
        }
        SparseMatrix<Real> matrix(n_unknowns(), n_unknowns());
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    }

    /// For each unknown, where it occurs: entries `first[u]` to `first[u + 1]` of `list`.
    struct Occurrences {
        std::vector<Index> first;
        std::vector<Occurrence> list;
        [[nodiscard]] std::span<const Occurrence> of(Index u) const {
            const auto begin = static_cast<std::size_t>(first[static_cast<std::size_t>(u)]);
            const auto end = static_cast<std::size_t>(first[static_cast<std::size_t>(u) + 1]);
            return {list.data() + begin, end - begin};
        }
    };

    [[nodiscard]] Occurrences occurrences() const {
        Occurrences result;
        result.first.assign(static_cast<std::size_t>(n_unknowns()) + 1, 0);
        for (int c : m_columns) {
            ++result.first[static_cast<std::size_t>(c) + 1];
        }
        for (std::size_t u = 1; u < result.first.size(); ++u) {
            result.first[u] += result.first[u - 1];
        }
        result.list.resize(m_columns.size());
        std::vector<Index> next(result.first.begin(), result.first.end() - 1);
        for (Index i = 0; i < n_terms(); ++i) {
            const Term t = term(i);
            for (Index p = 0; p < t.size(); ++p) {
                Index& slot = next[static_cast<std::size_t>(t.columns[static_cast<std::size_t>(p)])];
                result.list[static_cast<std::size_t>(slot++)] = {static_cast<int>(i), static_cast<int>(p)};
            }
        }
        return result;
    }

private:
    /// x and H x of one term.
    struct Scratch {
        std::vector<double> x, image;

        /// x = values at the unknowns of the term, image = H_i x.
        void multiply(const Term& t, const Values<double>& values) {
            const auto room = static_cast<std::size_t>(detail::packed_room(t.size()));
            if (x.size() < room) {
                x.resize(room);
                image.resize(room);
            }
            for (std::size_t p = 0; p < room; ++p) {
                x[p] = p < t.columns.size() ? values(t.columns[p]) : 0.;
            }
            detail::packed_product(t.hessian, t.size(), x.data(), image.data());
        }
    };

    /// The gradient of one term into `scratch.image`; returns Phi_i.
    double term_gradient(Index i, const Values<double>& theta, Scratch& scratch) const {
        const Term t = term(i);
        scratch.multiply(t, theta);
        double value = t.constant;
        for (std::size_t p = 0; p < t.columns.size(); ++p) {
            value += scratch.x[p] * (0.5 * scratch.image[p] - t.linear[p]);
            scratch.image[p] -= t.linear[p];
        }
        return value;
    }

    static void add(const Term& t, const Scratch& scratch, Values<double>& result) {
        for (std::size_t p = 0; p < t.columns.size(); ++p) {
            result(t.columns[p]) += scratch.image[p];
        }
    }

    [[nodiscard]] double ridge_value(const Values<double>& theta) const {
        return 0.5 * (m_ridge.array() * (theta - m_centre).array().square()).sum();
    }

    std::vector<int> m_node;
    std::vector<double> m_constant;
    std::vector<int> m_columns;
    std::vector<double> m_hessian;
    std::vector<double> m_linear;
    std::vector<Index> m_column_begin{0};
    std::vector<Index> m_hessian_begin{0};
    Values<double> m_ridge, m_centre;
};

} // namespace springfit
