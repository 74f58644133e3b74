// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fit/acceleration/objective.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void AccelerationObjective<Dim, Scalar>::index_springs(const SpringNetwork<Dim, Scalar>& network) {
    const auto known = [&](ParameterKind kind, const Values<Scalar>& given) {
        const Values<double> values = given.template cast<double>();
        return m_parameters.fits(kind) ? Values<double>(Values<double>::Zero(given.size())) : values;
    };
    m_stiffness = known(ParameterKind::stiffness, network.stiffness);
    m_damping = known(ParameterKind::damping, network.damping);
    m_rest_length = network.rest_length.template cast<double>();
    if (m_parameters.damping_per_stiffness() > 0) {
        m_damping.setZero();
    }
    m_uses_velocity = m_parameters.fits(ParameterKind::damping) || m_parameters.damping_per_stiffness() > 0 ||
                      (m_damping.array() != 0).any();

    std::vector<Index> count(static_cast<std::size_t>(n_nodes()) + 1, 0);
    for (Index e = 0; e < network.n_springs(); ++e) {
        ++count[static_cast<std::size_t>(network.springs(0, e)) + 1];
        ++count[static_cast<std::size_t>(network.springs(1, e)) + 1];
    }
    for (std::size_t i = 1; i < count.size(); ++i) {
        count[i] += count[i - 1];
    }
    m_end_begin = count;
    m_ends.resize(static_cast<std::size_t>(2 * network.n_springs()));
    for (Index e = 0; e < network.n_springs(); ++e) {
        for (int side = 0; side < 2; ++side) {
            Index& slot = count[static_cast<std::size_t>(network.springs(side, e))];
            m_ends[static_cast<std::size_t>(slot++)] = {network.springs(1 - side, e), static_cast<int>(e), {}, {}};
        }
    }

    m_column_begin.assign(1, 0);
    m_gram_begin.assign(1, 0);
    for (std::size_t i = 0; i < m_seen_free.size(); ++i) {
        const auto first = static_cast<std::ptrdiff_t>(m_columns.size());
        const std::span<End> ends(m_ends.data() + m_end_begin[i], m_ends.data() + m_end_begin[i + 1]);
        for (const End& end : ends) {
            for (ParameterKind kind : parameter_kinds) {
                if (const int u = m_parameters.unknown(kind, end.spring); u >= 0) {
                    m_columns.push_back(u);
                }
            }
        }
        std::sort(m_columns.begin() + first, m_columns.end());
        m_columns.erase(std::unique(m_columns.begin() + first, m_columns.end()), m_columns.end());
        std::vector<bool> written(m_columns.size() - static_cast<std::size_t>(first), false);
        for (End& end : ends) {
            for (ParameterKind kind : parameter_kinds) {
                const auto k = static_cast<std::size_t>(kind);
                const int u = m_parameters.unknown(kind, end.spring);
                end.column[k] = -1;
                if (u >= 0) {
                    const auto column =
                        std::lower_bound(m_columns.begin() + first, m_columns.end(), u) - (m_columns.begin() + first);
                    end.column[k] = static_cast<int>(column);
                    end.first[k] = !written[static_cast<std::size_t>(column)];
                    written[static_cast<std::size_t>(column)] = true;
                }
            }
        }
        const auto n = static_cast<Index>(written.size());
        m_column_begin.push_back(static_cast<Index>(m_columns.size()));
        m_gram_begin.push_back(m_gram_begin.back() + (n + 1) * (n + 2) / 2);
    }
    m_gram.assign(static_cast<std::size_t>(m_gram_begin.back()), 0.);
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void AccelerationObjective<Dim, Scalar>::flush() {
    if (m_batch.size() == 0) {
        return;
    }
    m_execution.for_chunks(n_nodes(), nodes_per_chunk,
                           [this](Index, Index begin, Index end) { m_batch.transpose(begin, end, m_mass); });
    m_execution.for_chunks(n_nodes(), nodes_per_chunk, [this](Index, Index begin, Index end) {
        Eigen::Matrix<double, detail::FrameBatch<Dim, Scalar>::rows, Eigen::Dynamic> equations;
        for (Index node = begin; node < end; ++node) {
            if ((m_batch.weight(node) > 0).any()) {
                add_node(node, equations);
            }
        }
    });
    m_batch.clear();
}

/// Adds [A y]'[A y] of one node over the frames of the batch, A theta being the springs' part of its weighted
/// acceleration and y what they have to reach.
template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void AccelerationObjective<Dim, Scalar>::add_node(
    Index node, Eigen::Matrix<double, detail::FrameBatch<Dim, Scalar>::rows, Eigen::Dynamic>& equations) {
    using Lanes = typename detail::FrameBatch<Dim, Scalar>::Lanes;
    constexpr int lanes = detail::FrameBatch<Dim, Scalar>::lanes;
    const auto i = static_cast<std::size_t>(node);
    const Index n = m_column_begin[i + 1] - m_column_begin[i];
    if (equations.cols() < n + 1) {
        equations.resize(Eigen::NoChange, n + 1);
    }
    const auto run = [&](Index column, int d) {
        return Eigen::Map<Lanes, Eigen::AlignedMax>(equations.col(column).data() + d * lanes);
    };
    const Lanes weight = m_batch.weight(node);
    for (int d = 0; d < Dim; ++d) {
        run(n, d) = weight * m_batch.load(node, d);
    }
    for (Index slot = m_end_begin[i]; slot < m_end_begin[i + 1]; ++slot) {
        const End& end = m_ends[static_cast<std::size_t>(slot)];
        std::array<Lanes, Dim> direction;
        Lanes length = Lanes::Zero();
        for (int d = 0; d < Dim; ++d) {
            direction[static_cast<std::size_t>(d)] = m_batch.position(end.other, d) - m_batch.position(node, d);
            length += direction[static_cast<std::size_t>(d)].square();
        }
        length = length.sqrt();
        // Ends that coincide have no direction and pull with no force.
        const Lanes inverse = (length + std::numeric_limits<double>::min()).inverse();
        Lanes rate = Lanes::Zero();
        for (int d = 0; d < Dim; ++d) {
            direction[static_cast<std::size_t>(d)] *= inverse;
            if (m_uses_velocity) {
                rate += direction[static_cast<std::size_t>(d)] *
                        (m_batch.velocity(end.other, d) - m_batch.velocity(node, d));
            }
        }
        const Lanes per_stiffness = length - m_rest_length(end.spring) + m_parameters.damping_per_stiffness() * rate;
        const Lanes known = m_stiffness(end.spring) * per_stiffness + m_damping(end.spring) * rate;
        const auto write = [&](ParameterKind kind, int d, const auto& values) {
            const auto k = static_cast<std::size_t>(kind);
            if (end.column[k] >= 0) {
                auto target = run(end.column[k], d);
                if (end.first[k]) {
                    target = values;
                } else {
                    target += values;
                }
            }
        };
        for (int d = 0; d < Dim; ++d) {
            const Lanes along = weight * direction[static_cast<std::size_t>(d)];
            write(ParameterKind::stiffness, d, per_stiffness * along);
            write(ParameterKind::damping, d, rate * along);
            write(ParameterKind::preload, d, -along);
            run(n, d) -= known * along;
        }
    }
    double* gram = m_gram.data() + m_gram_begin[i];
    for (Index p = 0; p <= n; ++p) {
        Eigen::Map<Values<double>> below(gram, n + 1 - p);
        below.noalias() += equations.middleCols(p, n + 1 - p).transpose() * equations.col(p);
        gram += n + 1 - p;
    }
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
AccelerationProblem AccelerationObjective<Dim, Scalar>::problem() & {
    flush();
    return take_problem(m_gram);
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
AccelerationProblem AccelerationObjective<Dim, Scalar>::problem() && {
    flush();
    m_batch = {};
    return take_problem(std::move(m_gram));
}

/// Turns the triangles of [A y]'[A y] into the node terms, in place: what goes into a term lies behind where it goes.
template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
AccelerationProblem AccelerationObjective<Dim, Scalar>::take_problem(std::vector<double> gram) {
    std::vector<bool> used(static_cast<std::size_t>(m_parameters.n_unknowns()), false);
    for (std::size_t i = 0; i < m_seen_free.size(); ++i) {
        for (Index c = m_column_begin[i]; m_seen_free[i] && c < m_column_begin[i + 1]; ++c) {
            used[static_cast<std::size_t>(m_columns[static_cast<std::size_t>(c)])] = true;
        }
    }
    std::vector<int> renumbered(used.size(), -1);
    int n_used = 0;
    for (std::size_t u = 0; u < used.size(); ++u) {
        renumbered[u] = used[u] ? n_used++ : -1;
    }

    NodeQuadratic::Terms terms;
    std::size_t to = 0;
    for (std::size_t i = 0; i < m_seen_free.size(); ++i) {
        if (!m_seen_free[i]) {
            continue;
        }
        const Index n = m_column_begin[i + 1] - m_column_begin[i];
        for (Index c = m_column_begin[i]; c < m_column_begin[i + 1]; ++c) {
            terms.columns.push_back(renumbered[static_cast<std::size_t>(m_columns[static_cast<std::size_t>(c)])]);
        }
        auto from = static_cast<std::size_t>(m_gram_begin[i]);
        for (Index p = 0; p < n; ++p) {
            for (Index q = p; q < n; ++q) {
                gram[to++] = 2 * gram[from++];
            }
            terms.linear.push_back(2 * gram[from++]);
        }
        terms.node.push_back(static_cast<int>(i));
        terms.size.push_back(static_cast<int>(n));
        terms.constant.push_back(gram[from]);
    }
    gram.resize(to);
    terms.hessian = std::move(gram);

    AccelerationProblem problem;
    problem.parameters = m_parameters.subset(used);
    problem.objective = NodeQuadratic(n_used, std::move(terms));
    identify(problem);
    return problem;
}

/// Sets bounds, prior and ridge, and holds what no motion excites at its prior.
template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void AccelerationObjective<Dim, Scalar>::identify(AccelerationProblem& problem) const {
    problem.lower = problem.parameters.lower();
    problem.upper = problem.parameters.upper();
    problem.prior = problem.parameters.prior();
    const Values<double> curvature = problem.objective.curvature();
    const Index n = curvature.size();
    std::array<double, 3> sum{};
    std::array<double, 3> count{};
    const auto kind = [&](Index u) { return static_cast<std::size_t>(problem.parameters.kind(u)); };
    for (Index u = 0; u < n; ++u) {
        sum[kind(u)] += curvature(u);
        count[kind(u)] += 1;
    }
    Values<double> ridge(n);
    for (Index u = 0; u < n; ++u) {
        const double mean = sum[kind(u)] / count[kind(u)];
        ridge(u) = m_options.parameters.ridge * mean;
        if (!(curvature(u) > m_options.identified * mean)) {
            problem.not_identified.push_back(static_cast<int>(u));
            problem.lower(u) = problem.prior(u);
            problem.upper(u) = problem.prior(u);
        }
    }
    problem.objective.set_ridge(ridge, problem.prior);
}

} // namespace springfit
