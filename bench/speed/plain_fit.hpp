// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/SparseCore>

#include <springfit/motion/motion.hpp>
#include <springfit/network/spring_network.hpp>

/// The fit as a straightforward program has it; the baselines of bench_fit.
namespace plain {

/// Normal equations H = 2 A'A, g = 2 A'y of the acceleration mismatch, spring pair by spring pair: one dense matrix per
/// node, filled frame by frame.
template <int Dim, class Scalar>
struct NormalEquations {
    std::vector<std::vector<int>> springs_at; // per node
    std::vector<std::vector<double>> block;   // per node, dense
    std::vector<double> gradient;             // per spring

    NormalEquations(const springfit::SpringNetwork<Dim, Scalar>& network,
                    const springfit::Motion<Dim, Scalar>& motion) {
        const auto n_nodes = static_cast<std::size_t>(network.n_nodes());
        springs_at.resize(n_nodes);
        block.resize(n_nodes);
        gradient.assign(static_cast<std::size_t>(network.n_springs()), 0);
        for (springfit::Index e = 0; e < network.n_springs(); ++e) {
            springs_at[static_cast<std::size_t>(network.springs(0, e))].push_back(static_cast<int>(e));
            springs_at[static_cast<std::size_t>(network.springs(1, e))].push_back(static_cast<int>(e));
        }
        for (std::size_t i = 0; i < n_nodes; ++i) {
            block[i].assign(springs_at[i].size() * springs_at[i].size(), 0);
        }
        std::vector<double> row;
        for (std::size_t t = 0; t < motion.times.size(); ++t) {
            const auto& x = motion.positions[t];
            for (std::size_t i = 0; i < n_nodes; ++i) {
                const auto node = static_cast<springfit::Index>(i);
                const auto& springs = springs_at[i];
                const std::size_t n = springs.size();
                const double mass = network.mass(node);
                row.assign(n * Dim, 0);
                for (std::size_t s = 0; s < n; ++s) {
                    const int e = springs[s];
                    const int other = network.springs(0, e) == node ? network.springs(1, e) : network.springs(0, e);
                    double r[Dim];
                    double length2 = 0;
                    for (int d = 0; d < Dim; ++d) {
                        r[d] = double(x(d, other)) - double(x(d, node));
                        length2 += r[d] * r[d];
                    }
                    const double length = std::sqrt(length2);
                    for (int d = 0; d < Dim; ++d) {
                        row[s * Dim + static_cast<std::size_t>(d)] =
                            (length - double(network.rest_length(e))) * r[d] / (length * mass);
                    }
                }
                for (std::size_t a = 0; a < n; ++a) {
                    for (std::size_t b = 0; b < n; ++b) {
                        for (std::size_t d = 0; d < Dim; ++d) {
                            block[i][a * n + b] += 2 * row[a * Dim + d] * row[b * Dim + d];
                        }
                    }
                    for (int d = 0; d < Dim; ++d) {
                        const double wanted = double(motion.accelerations[t](d, node)) -
                                              double(motion.external_forces[t](d, node)) / mass;
                        gradient[static_cast<std::size_t>(springs[a])] +=
                            2 * row[a * Dim + static_cast<std::size_t>(d)] * wanted;
                    }
                }
            }
        }
    }
};

/// Each node's block solved on its own without bounds by a dense factorisation; the two estimates of a spring averaged.
template <class Problem>
Eigen::VectorXd one_pass(const Problem& problem) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem.n_unknowns());
    Eigen::VectorXd count = sum;
    for (springfit::Index t = 0; t < problem.objective.n_terms(); ++t) {
        const auto term = problem.objective.term(t);
        const auto n = static_cast<Eigen::Index>(term.columns.size());
        Eigen::MatrixXd h(n, n);
        Eigen::VectorXd g(n);
        for (Eigen::Index a = 0; a < n; ++a) {
            for (Eigen::Index b = 0; b < n; ++b) {
                h(a, b) = term.entry(a, b);
            }
            g(a) = term.linear[a];
        }
        const Eigen::VectorXd x = h.ldlt().solve(g);
        for (Eigen::Index a = 0; a < n; ++a) {
            if (std::isfinite(x(a))) {
                sum(term.columns[static_cast<std::size_t>(a)]) += std::max(0., x(a));
                count(term.columns[static_cast<std::size_t>(a)]) += 1;
            }
        }
    }
    return sum.cwiseQuotient(count.cwiseMax(1));
}

/// Sweeps of projected Gauss-Seidel on the assembled matrix, k >= 0.
inline void gauss_seidel(const Eigen::SparseMatrix<double>& full, const Eigen::VectorXd& g, Eigen::VectorXd& theta,
                         int sweeps) {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (Eigen::Index u = 0; u < full.cols(); ++u) {
            double residual = g(u);
            double diagonal = 0;
            for (Eigen::SparseMatrix<double>::InnerIterator it(full, u); it; ++it) {
                residual -= it.value() * theta(it.row());
                diagonal = it.row() == u ? it.value() : diagonal;
            }
            if (diagonal > 0) {
                theta(u) = std::max(0., theta(u) + residual / diagonal);
            }
        }
    }
}

} // namespace plain
