// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
            cast(motion.external_forces),
            motion.unobserved,
            static_cast<double>(motion.noise)};
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
        if (m_groups[g].clamped == clamped && std::abs(m_groups[g].step - step) <= 1e-5 * step) {
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
        require(has_even_frames(motion), text("motion '", motion.name, "'"), "evenly spaced frames (resample)",
                "uneven ones");
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
            for_observed(motion, at, m_groups[group].free.nodes(), [&](int i) {
                const Vector<Dim, double> x = motion.positions[at].col(i);
                from_rest += (x - motion.rest_positions.col(i)).squaredNorm();
                from_straight +=
                    (x - motion.positions[start].col(i) - time * motion.velocities[start].col(i)).squaredNorm();
            });
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

} // namespace springfit
