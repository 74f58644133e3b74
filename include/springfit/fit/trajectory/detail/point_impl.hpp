// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <springfit/fit/trajectory/detail/hadamard_form.hpp>
#include <springfit/fit/trajectory/problem.hpp>

namespace springfit {

template <int Dim>
TrajectoryPoint<Dim>::TrajectoryPoint(const TrajectoryProblem<Dim>& problem)
    : m_problem(&problem), m_theta(Values<double>::Zero(problem.n_unknowns())) {
    for (std::size_t g = 0; g < problem.m_groups.size(); ++g) {
        m_factors.push_back(std::make_unique<BlockCholesky>());
    }
}

template <int Dim>
detail::WindowSimulation<Dim> TrajectoryPoint<Dim>::simulation(std::size_t block) const {
    const auto& windows = m_problem->m_blocks[block];
    const auto& options = m_problem->m_options;
    const double alpha = options.rule == PredictionRule::midpoint ? 0.5 : 1.;
    return {windows,
            m_problem->m_groups[windows.group],
            m_problem->m_motions,
            {alpha, options.steps_per_frame},
            m_problem->checkpoint_interval(windows),
            m_network,
            *m_factors[windows.group]};
}

template <int Dim>
bool TrajectoryPoint<Dim>::move_to(const Values<double>& theta, const TrajectoryPoint* near) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    m_theta = theta;
    m_network = m_problem->m_parameters.network(theta);
    m_value = m_misfit = infinity;
    const double alpha = m_problem->m_options.rule == PredictionRule::midpoint ? 0.5 : 1.;
    const auto& execution = m_problem->m_options.execution;
    std::vector<char> good(m_factors.size(), 0);
    execution.for_chunks(static_cast<Index>(m_factors.size()), 1, [&](Index, Index g, Index) {
        const auto& group = m_problem->m_groups[static_cast<std::size_t>(g)];
        const auto at = static_cast<std::size_t>(g);
        // Membranes and the like resist nothing sideways at rest, but do where they are stretched.
        for (const auto* shape :
             std::initializer_list<const Points<Dim, double>*>{&m_network.rest_positions, &group.mean}) {
            auto matrix = group.pattern;
            matrix.set_zero();
            add_stiffness<Dim, double>(m_network, *shape, HessianForm::exact, matrix);
            if (group.step > 0) {
                const double part = alpha * group.step;
                add_damping<Dim, double>(m_network, *shape, 1 / part, matrix);
                for (Index f = 0; f < group.free.n_free(); ++f) {
                    const double mass = m_network.mass(group.free.nodes()[static_cast<std::size_t>(f)]);
                    matrix.add_diagonal(f, mass / (part * part));
                }
            }
            if (m_factors[at]->template factorise<Dim>(matrix.matrix(), group.free)) {
                good[at] = 1;
                break;
            }
        }
    });
    if (std::find(good.begin(), good.end(), 0) != good.end()) {
        return false;
    }
    const std::size_t blocks = m_problem->m_blocks.size();
    m_tapes.resize(blocks);
    std::vector<double> misfits(blocks, infinity);
    execution.for_chunks(static_cast<Index>(blocks), 1, [&](Index, Index b, Index) {
        const auto at = static_cast<std::size_t>(b);
        const detail::WindowTape<Dim>* guess =
            near != nullptr && near->m_tapes.size() == blocks ? &near->m_tapes[at] : nullptr;
        if (!simulation(at).simulate(m_tapes[at], guess, misfits[at])) {
            misfits[at] = infinity;
        }
    });
    double sum = 0;
    for (double misfit : misfits) {
        sum += misfit;
    }
    if (!std::isfinite(sum)) {
        return false;
    }
    m_misfit = std::sqrt(sum / static_cast<double>(m_problem->m_motions.size()));
    m_value = (sum + m_problem->m_options.prior_weight * theta.squaredNorm()) / 2;
    return true;
}

template <int Dim>
template <class Body>
NetworkValues TrajectoryPoint<Dim>::sum_over_blocks(const Body& body) {
    const auto zero = NetworkValues::zero(m_network.n_springs(), m_network.n_cells());
    std::vector<NetworkValues> parts(m_tapes.size(), zero);
    m_problem->m_options.execution.for_chunks(static_cast<Index>(m_tapes.size()), 1, [&](Index, Index b, Index) {
        const auto at = static_cast<std::size_t>(b);
        body(at, simulation(at), m_tapes[at], parts[at]);
    });
    NetworkValues sum = zero;
    for (const auto& part : parts) {
        sum += part;
    }
    return sum;
}

template <int Dim>
bool TrajectoryPoint<Dim>::gradient(Values<double>& gradient) {
    std::vector<char> stable(m_tapes.size(), 0);
    const NetworkValues sum =
        sum_over_blocks([&](std::size_t block, const auto& windows, auto& tape, NetworkValues& derivative) {
            stable[block] = windows.add_gradient(tape, derivative) ? 1 : 0;
        });
    gradient = m_problem->m_parameters.pull_back(m_network, sum) + m_problem->m_options.prior_weight * m_theta;
    return gradient.allFinite() && std::find(stable.begin(), stable.end(), 0) == stable.end();
}

template <int Dim>
Values<double> TrajectoryPoint<Dim>::product(const Values<double>& direction) {
    const NetworkValues change = m_problem->m_parameters.change(m_network, direction);
    const NetworkValues sum = sum_over_blocks([&](std::size_t, const auto& windows, auto& tape, NetworkValues& part) {
        windows.add_product(tape, change, part);
    });
    return m_problem->m_parameters.pull_back(m_network, sum) + m_problem->m_options.prior_weight * direction;
}

template <int Dim>
Values<double> TrajectoryPoint<Dim>::curvature(int probes) {
    Values<double> diagonal = Values<double>::Zero(m_problem->n_unknowns());
    for (int probe = 0; probe < probes; ++probe) {
        const NetworkValues sum =
            sum_over_blocks([&](std::size_t block, const auto& windows, auto& tape, NetworkValues& part) {
                std::mt19937 random(static_cast<unsigned>(1000003 * probe + static_cast<int>(block)));
                windows.add_probe(tape, [&random] { return (random() & 1U) != 0 ? 1. : -1.; }, part);
            });
        diagonal += m_problem->m_parameters.pull_back(m_network, sum).cwiseAbs2();
    }
    return diagonal / probes;
}

template <int Dim>
bool TrajectoryPoint<Dim>::has_dense() const {
    const auto& parameters = m_problem->m_parameters;
    const auto& motions = m_problem->m_motions;
    if (!m_problem->is_static() || m_problem->n_unknowns() > 1000 ||
        std::any_of(motions.begin(), motions.end(), [](const auto& motion) { return !motion.unobserved.empty(); })) {
        return false;
    }
    for (Index e = 0; e < m_network.n_springs(); ++e) {
        if (parameters.unknown(MotionParameter::rest_length, e) >= 0 ||
            parameters.unknown(MotionParameter::damping, e) >= 0) {
            return false;
        }
    }
    constexpr double most = 0.1; // angle by which a spring may have turned
    for (std::size_t b = 0; b < m_tapes.size(); ++b) {
        const ColumnBlock& x = m_tapes[b].positions.front();
        for (Index e = 0; e < m_network.n_springs(); ++e) {
            const int i = m_network.springs(0, e);
            const int j = m_network.springs(1, e);
            const Vector<Dim, double> rest = m_network.rest_positions.col(j) - m_network.rest_positions.col(i);
            for (Index column = 0; column < x.cols(); ++column) {
                const Vector<Dim, double> r =
                    x.col(column).template segment<Dim>(Dim * j) - x.col(column).template segment<Dim>(Dim * i);
                if ((r.normalized() - rest.normalized()).norm() > most) {
                    return false;
                }
            }
        }
    }
    return true;
}

template <int Dim>
DenseMatrix<double> TrajectoryPoint<Dim>::dense() {
    const detail::FittedItems items = detail::fitted_items(m_problem->m_parameters, m_network);
    DenseMatrix<double> h = DenseMatrix<double>::Zero(m_problem->n_unknowns(), m_problem->n_unknowns());
    for (std::size_t g = 0; g < m_factors.size(); ++g) {
        const DenseMatrix<double> product =
            detail::compliance_product(m_network, *m_factors[g], m_problem->m_options.execution);
        DenseMatrix<double> tensions(items.size(), 0);
        for (std::size_t b = 0; b < m_tapes.size(); ++b) {
            const auto& windows = m_problem->m_blocks[b];
            if (windows.group == g) {
                detail::append_tensions(m_network, items, m_tapes[b].positions.front(), windows.weight, tensions);
            }
        }
        DenseMatrix<double> squares = DenseMatrix<double>::Zero(items.size(), items.size());
        squares.template selfadjointView<Eigen::Lower>().rankUpdate(tensions);
        detail::add_hadamard(items, product, squares, h);
    }
    h.diagonal().array() += m_problem->m_options.prior_weight;
    return h;
}

} // namespace springfit
