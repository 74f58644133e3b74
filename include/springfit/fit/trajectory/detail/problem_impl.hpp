// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <springfit/fit/trajectory/problem.hpp>

namespace springfit {

namespace detail {

template <int Dim, std::floating_point Scalar>
SpringNetwork<Dim, double> in_double(const SpringNetwork<Dim, Scalar>& network) {
    return {network.rest_positions.template cast<double>(),
            network.springs,
            network.stiffness.template cast<double>(),
            network.rest_length.template cast<double>(),
            network.damping.template cast<double>(),
            network.mass.template cast<double>(),
            network.cells,
            network.rest_volume.template cast<double>(),
            network.volume_stiffness.template cast<double>()};
}

template <int Dim, std::floating_point Scalar>
Motion<Dim, double> in_double(const Motion<Dim, Scalar>& motion) {
    const auto cast = [](const std::vector<Points<Dim, Scalar>>& frames) {
        std::vector<Points<Dim, double>> result;
        for (const auto& frame : frames) {
            result.push_back(frame.template cast<double>());
        }
        return result;
    };
    return {motion.name,
            motion.rest_positions.template cast<double>(),
            motion.clamped,
            std::vector<double>(motion.times.begin(), motion.times.end()),
            cast(motion.positions),
            cast(motion.velocities),
            {},
            cast(motion.external_forces)};
}

} // namespace detail

template <int Dim>
template <std::floating_point Scalar>
TrajectoryProblem<Dim>::TrajectoryProblem(const SpringNetwork<Dim, Scalar>& network,
                                          const std::vector<Motion<Dim, Scalar>>& motions,
                                          const TrajectoryOptions& options)
    : m_options(options), m_parameters(detail::in_double(network), options.parameters) {
    require(options.prior_weight >= 0 && std::isfinite(options.prior_weight), "prior_weight", "a weight not below 0",
            options.prior_weight);
    require(options.horizon >= 0, "horizon", "0 or a number of frames", options.horizon);
    require(options.window_stride >= 0, "window_stride", "0 or a number of frames", options.window_stride);
    require(options.steps_per_frame >= 1, "steps_per_frame", "at least one", options.steps_per_frame);
    require(options.checkpoint_interval >= 0, "checkpoint_interval", "0 or a number of steps",
            options.checkpoint_interval);
    require(!motions.empty(), "motions", "at least one", "none");
    std::vector<detail::WindowBlock> single; // one window each
    for (const auto& motion : motions) {
        require(motion.n_nodes() == network.n_nodes(), text("motion '", motion.name, "'"),
                text(network.n_nodes(), " nodes, as the network"), motion.n_nodes());
        validate(motion);
        require(motion.n_frames() > 0, text("motion '", motion.name, "'"), "at least one frame", "none");
        m_motions.push_back(detail::in_double(motion));
        add_windows(m_motions.size() - 1, single);
    }
    // Windows of one kind go into blocks side by side.
    std::vector<bool> taken(single.size(), false);
    for (std::size_t w = 0; w < single.size(); ++w) {
        for (std::size_t other = w; other < single.size(); ++other) {
            if (taken[other] || single[other].group != single[w].group || single[other].frames != single[w].frames) {
                continue;
            }
            if (other == w || m_blocks.back().motions.size() == block_columns) {
                m_blocks.push_back({single[w].group, {}, {}, {}, single[w].frames});
            }
            auto& block = m_blocks.back();
            block.motions.push_back(single[other].motions.front());
            block.first.push_back(single[other].first.front());
            block.weight.conservativeResize(block.weight.size() + 1);
            block.weight(block.weight.size() - 1) = single[other].weight(0);
            taken[other] = true;
        }
    }
    for (auto& block : m_blocks) {
        const Index used = block.weight.size();
        const Index columns = (used + block_lanes - 1) / block_lanes * block_lanes;
        block.motions.resize(static_cast<std::size_t>(columns), block.motions.back());
        block.first.resize(static_cast<std::size_t>(columns), block.first.back());
        block.weight.conservativeResize(columns);
        block.weight.tail(columns - used).setZero();
    }
}

template <int Dim>
std::size_t TrajectoryProblem<Dim>::group_of(const std::vector<int>& clamped, double step) {
    for (std::size_t g = 0; g < m_groups.size(); ++g) {
        if (m_groups[g].clamped == clamped && std::abs(m_groups[g].step - step) <= 1e-9 * step) {
            return g;
        }
    }
    FreeNodes free(m_parameters.prior().n_nodes(), clamped);
    require(free.n_free() > 0, "motions", "nodes that are free to move", "none");
    auto pattern = network_matrix(m_parameters.prior(), free);
    const Points<Dim, double> none = Points<Dim, double>::Zero(Dim, free.n_nodes());
    m_groups.push_back({clamped, std::move(free), step, std::move(pattern), none});
    return m_groups.size() - 1;
}

template <int Dim>
void TrajectoryProblem<Dim>::add_windows(std::size_t number, std::vector<detail::WindowBlock>& single) {
    const auto& motion = m_motions[number];
    const Index last = motion.n_frames() - 1;
    const Index horizon = m_options.horizon > 0 ? std::min<Index>(m_options.horizon, last) : last;
    const Index stride = m_options.window_stride > 0 ? m_options.window_stride : std::max<Index>(horizon, 1);
    double step = 0;
    if (last > 0) {
        step = (motion.times.back() - motion.times.front()) / static_cast<double>(last * m_options.steps_per_frame);
        for (std::size_t t = 1; t < motion.times.size(); ++t) {
            const double frame = motion.times[t] - motion.times[t - 1];
            require(std::abs(frame - step * m_options.steps_per_frame) < 1e-6 * frame,
                    text("motion '", motion.name, "'"), "evenly spaced frames",
                    text("a gap of ", frame, " s before frame ", t));
        }
    }
    const std::size_t group = group_of(motion.clamped, step);
    m_groups[group].mean += (motion.positions.front() - m_groups[group].mean) / ++m_groups[group].n_motions;
    double from_rest = 0;
    double from_straight = 0;
    const std::size_t before = single.size();
    for (Index first = 0; first == 0 || first + horizon <= last; first += stride) {
        const auto start = static_cast<std::size_t>(first);
        for (Index frame = last > 0 ? first + 1 : 0; frame <= first + horizon; ++frame) {
            const auto at = static_cast<std::size_t>(frame);
            const double time = motion.times[at] - motion.times[start];
            for (int i : m_groups[group].free.nodes()) {
                const Vector<Dim, double> x = motion.positions[at].col(i);
                from_rest += (x - motion.rest_positions.col(i)).squaredNorm();
                from_straight +=
                    (x - motion.positions[start].col(i) - time * motion.velocities[start].col(i)).squaredNorm();
            }
        }
        single.push_back({group, {number}, {first}, Values<double>::Ones(1), horizon});
    }
    const double scale = last > 0 ? std::min(from_rest, from_straight) : from_rest;
    require(scale > 0, text("motion '", motion.name, "'"), "a motion that leaves the rest shape", "none");
    for (std::size_t w = before; w < single.size(); ++w) {
        single[w].weight(0) = 1 / scale;
    }
}

template <int Dim>
Index TrajectoryProblem<Dim>::checkpoint_interval(const detail::WindowBlock& block) const {
    const Index steps = std::max<Index>(1, block.frames * m_options.steps_per_frame);
    if (m_options.checkpoint_interval > 0) {
        return m_options.checkpoint_interval;
    }
    double bytes = 0;
    for (const auto& each : m_blocks) {
        bytes += 3. * 8. * Dim *
                 static_cast<double>(m_parameters.prior().n_nodes() * each.weight.size() * each.frames *
                                     m_options.steps_per_frame);
    }
    return bytes < 512. * 1024 * 1024 ? steps
                                      : std::max<Index>(8, static_cast<Index>(std::sqrt(static_cast<double>(steps))));
}

template <int Dim>
Index TrajectoryProblem<Dim>::n_windows() const {
    Index count = 0;
    for (const auto& block : m_blocks) {
        count += (block.weight.array() > 0).count();
    }
    return count;
}

template <int Dim>
bool TrajectoryProblem<Dim>::is_static() const {
    return std::all_of(m_blocks.begin(), m_blocks.end(), [](const auto& block) { return block.frames == 0; });
}

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
    if (!m_problem->is_static() || m_problem->n_unknowns() > 1000) {
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
    const auto& parameters = m_problem->m_parameters;
    const Index springs = m_network.n_springs();
    const Index items = springs + m_network.n_cells();
    // Per item: its unknown and what theta does to its tension or pressure.
    std::vector<int> unknown(static_cast<std::size_t>(items));
    Values<double> slope = Values<double>::Zero(items);
    for (Index item = 0; item < items; ++item) {
        const auto kind = item < springs ? MotionParameter::stiffness : MotionParameter::volume;
        const Index own = item < springs ? item : item - springs;
        unknown[static_cast<std::size_t>(item)] = parameters.unknown(kind, own);
        if (unknown[static_cast<std::size_t>(item)] >= 0) {
            slope(item) = parameters.slope(kind, m_network, own);
        }
    }
    DenseMatrix<double> h = DenseMatrix<double>::Zero(m_problem->n_unknowns(), m_problem->n_unknowns());
    for (std::size_t g = 0; g < m_factors.size(); ++g) {
        // K^-1 B, item by item, at the rest shape.
        const Index rows = Dim * m_network.n_nodes();
        DenseMatrix<double> columns(rows, items);
        const Index chunks = (items + block_columns - 1) / block_columns;
        m_problem->m_options.execution.for_chunks(chunks, 1, [&](Index, Index chunk, Index) {
            const Index first = chunk * block_columns;
            const Index count = std::min<Index>(block_columns, items - first);
            ColumnBlock right = ColumnBlock::Zero(rows, block_columns);
            for (Index c = 0; c < count; ++c) {
                const Index item = first + c;
                if (item < springs) {
                    const int i = m_network.springs(0, item);
                    const int j = m_network.springs(1, item);
                    const Vector<Dim, double> n =
                        (m_network.rest_positions.col(j) - m_network.rest_positions.col(i)).normalized();
                    right.col(c).template segment<Dim>(Dim * i) = n;
                    right.col(c).template segment<Dim>(Dim * j) = -n;
                } else {
                    const auto corners = m_network.cells.col(item - springs);
                    ColumnBlock x(rows, block_lanes);
                    for (int a = 0; a <= Dim; ++a) {
                        for (int d = 0; d < Dim; ++d) {
                            x.row(Dim * corners(a) + d).setConstant(m_network.rest_positions(d, corners(a)));
                        }
                    }
                    const detail::CellLanes<Dim> cell(x, corners, 0);
                    for (int a = 0; a < Dim; ++a) {
                        for (int d = 0; d < Dim; ++d) {
                            right(Dim * corners(a + 1) + d, c) += cell.gradient[a][d](0);
                            right(Dim * corners(0) + d, c) -= cell.gradient[a][d](0);
                        }
                    }
                }
            }
            ColumnBlock solution;
            m_factors[g]->solve(right, solution);
            columns.middleCols(first, count) = solution.leftCols(count);
        });
        DenseMatrix<double> product = DenseMatrix<double>::Zero(items, items);
        product.template selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
        // S W^(1/2): tension or pressure by theta, one column per case.
        DenseMatrix<double> tensions(items, 0);
        for (std::size_t b = 0; b < m_tapes.size(); ++b) {
            const auto& windows = m_problem->m_blocks[b];
            if (windows.group != g) {
                continue;
            }
            const ColumnBlock& x = m_tapes[b].positions.front();
            const Index before = tensions.cols();
            tensions.conservativeResize(items, before + x.cols());
            for (Index column = 0; column < x.cols(); column += block_lanes) {
                const auto set_row = [&](Index item, const detail::ColumnLanes& tension) {
                    for (int c = 0; c < block_lanes; ++c) {
                        tensions(item, before + column + c) = tension(c);
                    }
                };
                for (Index e = 0; e < springs; ++e) {
                    const detail::SpringLanes<Dim> spring(x, m_network.springs(0, e), m_network.springs(1, e), column);
                    set_row(e, slope(e) * (spring.length - m_network.rest_length(e)));
                }
                for (Index c = 0; c < m_network.n_cells(); ++c) {
                    const detail::CellLanes<Dim> cell(x, m_network.cells.col(c), column);
                    set_row(springs + c, slope(springs + c) * (1 - cell.volume / m_network.rest_volume(c)));
                }
            }
            tensions.rightCols(x.cols()) *= windows.weight.cwiseSqrt().asDiagonal();
        }
        DenseMatrix<double> squares = DenseMatrix<double>::Zero(items, items);
        squares.template selfadjointView<Eigen::Lower>().rankUpdate(tensions);
        for (Index column = 0; column < items; ++column) {
            for (Index row = column; row < items; ++row) {
                const int u = unknown[static_cast<std::size_t>(row)];
                const int v = unknown[static_cast<std::size_t>(column)];
                if (u >= 0 && v >= 0) {
                    const double entry = product(row, column) * squares(row, column);
                    h(u, v) += entry;
                    if (row != column) {
                        h(v, u) += entry;
                    }
                }
            }
        }
    }
    h.diagonal().array() += m_problem->m_options.prior_weight;
    return h;
}

} // namespace springfit
