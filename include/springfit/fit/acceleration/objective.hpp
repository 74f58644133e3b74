// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>

#include <springfit/core/execution.hpp>
#include <springfit/fit/acceleration/detail/frame_batch.hpp>
#include <springfit/fit/acceleration/problem.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/network/volume.hpp>

namespace springfit {

/// The weight of a node's acceleration mismatch, besides the caller's own `node_weights`.
enum class NodeWeighting {
    acceleration, ///< w_i = 1: every acceleration alike
    mass,         ///< w_i = m_i
    force         ///< w_i = m_i^2: every force alike
};

template <std::floating_point Scalar>
struct AccelerationOptions {
    ParameterOptions parameters{};                         ///< the unknowns
    NodeWeighting weighting = NodeWeighting::acceleration; ///< w_i
    Values<double> node_weights{};                         ///< factors of w_i, >= 0 [n_nodes]; empty: 1
    /// An unknown is not identified where its curvature is below this part of the mean of its kind, in (0, 1).
    double identified = std::same_as<Scalar, float> ? 1e-8 : 1e-12;
};

/// The mismatch of accelerations as a quadratic in the springs' unknowns, summed up frame by frame:
///
///     Phi(theta) = sum_motions W sum_t sum_{i free} w_i | a_i(t) - a_i^MSM(x(t), v(t); theta) |^2
///     m_i a_i^MSM = f_i + sum_e [ k_e (L - l_e) n + c_e ((v_j - v_i) . n) n - q_e n ]
///
/// f_i are the external forces and those of the network's cells, whose volume stiffness is taken as given. Nodes
/// clamped in a motion do not count in it, nor do those that were not seen. Frames are read once and not kept: memory
/// is about 4 (unknowns at a node)^2 bytes per node and 32 frames of the motion. Cost per frame: sum over nodes of
/// unknowns^2. Sums are in double whatever the Scalar of the data, and do not depend on the number of threads.
template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
class AccelerationObjective {
public:
    /// Throws InvalidArgument where the network or an option is not valid.
    explicit AccelerationObjective(const SpringNetwork<Dim, Scalar>& network,
                                   const AccelerationOptions<Scalar>& options = {}, const Execution& execution = {})
        : m_options(options), m_execution(execution) {
        validate(network);
        require(options.identified > 0 && options.identified < 1, "identified", "a value in (0, 1)",
                options.identified);
        require(options.node_weights.size() == 0 || options.node_weights.size() == network.n_nodes(), "node_weights",
                text(network.n_nodes(), " values, one per node"), options.node_weights.size());
        require(options.node_weights.size() == 0 ||
                    (options.node_weights.allFinite() && options.node_weights.minCoeff() >= 0),
                "node_weights", "finite values not below 0", "another value");
        m_parameters = Parameters(network, options.parameters);
        m_mass = network.mass.template cast<double>();
        m_cells.cells = network.cells;
        m_cells.rest_volume = network.rest_volume.template cast<double>();
        m_cells.volume_stiffness = network.volume_stiffness.template cast<double>();
        m_root_weight.resize(network.n_nodes());
        for (Index i = 0; i < network.n_nodes(); ++i) {
            const double own = options.node_weights.size() > 0 ? options.node_weights(i) : 1.;
            const double power = options.weighting == NodeWeighting::force  ? m_mass(i) * m_mass(i)
                                 : options.weighting == NodeWeighting::mass ? m_mass(i)
                                                                            : 1.;
            m_root_weight(i) = std::sqrt(own * power) / m_mass(i);
        }
        m_seen_free.assign(static_cast<std::size_t>(network.n_nodes()), false);
        index_springs(network);
        m_batch = detail::FrameBatch<Dim, Scalar>(network.n_nodes(), m_uses_velocity);
    }

    /// Adds all frames of a motion, times `weight`. Throws InvalidArgument unless it is valid and of as many nodes.
    void add(const Motion<Dim, Scalar>& motion, double weight = 1) {
        require(motion.n_nodes() == n_nodes(), text("motion ", motion.name), text(n_nodes(), " nodes"),
                motion.n_nodes());
        validate(motion);
        const Values<double> root_weights = weights(motion.clamped, weight);
        for (std::size_t t = 0; t < motion.times.size(); ++t) {
            push(motion.positions[t], motion.velocities[t], motion.accelerations[t], motion.external_forces[t],
                 motion.unobserved.empty() ? root_weights : observed_weights(motion, t, root_weights));
        }
    }

    /// Adds one frame, `[Dim x n_nodes]` each; `clamped` lists the nodes that do not count.
    void add_frame(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities,
                   const Points<Dim, Scalar>& accelerations, const Points<Dim, Scalar>& external_forces,
                   const std::vector<int>& clamped, double weight = 1) {
        const Points<Dim, Scalar>* const arrays[] = {&positions, &velocities, &accelerations, &external_forces};
        for (const auto* array : arrays) {
            require(array->cols() == n_nodes(), "frame", text(n_nodes(), " nodes"), array->cols());
            require(array->allFinite(), "frame", "finite values", "a value that is not finite");
        }
        push(positions, velocities, accelerations, external_forces, weights(clamped, weight));
    }

    /// The quadratic of all frames so far, with bounds; more frames may follow.
    [[nodiscard]] AccelerationProblem problem() &;

    /// The same from an objective that is not needed any more, whose memory the problem takes over.
    [[nodiscard]] AccelerationProblem problem() &&;

private:
    static constexpr Index nodes_per_chunk = 64;

    /// A spring at one of its ends: the other end, and where its columns lie in the node's block (-1: none).
    struct End {
        int other;
        int spring;
        std::array<int, 3> column; ///< by ParameterKind
        std::array<bool, 3> first; ///< the first spring to write that column; the others of its group add to it
    };

    [[nodiscard]] Index n_nodes() const { return m_mass.size(); }

    [[nodiscard]] Values<double> weights(const std::vector<int>& clamped, double weight) {
        require(weight >= 0 && std::isfinite(weight), "weight", "a finite value not below 0", weight);
        Values<double> root_weights = std::sqrt(weight) * m_root_weight;
        for (int node : clamped) {
            require(node >= 0 && node < n_nodes(), "clamped", text("node numbers in [0, ", n_nodes(), ")"), node);
            root_weights(node) = 0;
        }
        std::vector<bool> is_clamped(m_seen_free.size(), false);
        for (int node : clamped) {
            is_clamped[static_cast<std::size_t>(node)] = true;
        }
        for (std::size_t i = 0; i < is_clamped.size(); ++i) {
            m_seen_free[i] = m_seen_free[i] || !is_clamped[i];
        }
        return root_weights;
    }

    /// No weight for a node that is not seen in a frame or in the two on either side, of which its acceleration is
    /// differenced, or whose springs lead to one that is not seen.
    [[nodiscard]] Values<double> observed_weights(const Motion<Dim, Scalar>& motion, std::size_t frame,
                                                  Values<double> root_weights) const {
        const std::size_t last = std::min(frame + 2, motion.times.size() - 1);
        for (std::size_t t = frame - std::min<std::size_t>(frame, 2); t <= last; ++t) {
            for (int node : motion.unobserved[t]) {
                root_weights(node) = 0;
            }
        }
        for (int node : motion.unobserved[frame]) {
            for (Index end = m_end_begin[static_cast<std::size_t>(node)];
                 end < m_end_begin[static_cast<std::size_t>(node) + 1]; ++end) {
                root_weights(m_ends[static_cast<std::size_t>(end)].other) = 0;
            }
        }
        return root_weights;
    }

    void push(const Points<Dim, Scalar>& positions, const Points<Dim, Scalar>& velocities,
              const Points<Dim, Scalar>& accelerations, const Points<Dim, Scalar>& forces,
              const Values<double>& root_weights) {
        m_forces = forces.template cast<double>();
        if (m_cells.n_cells() > 0) {
            add_volume_forces<Dim, double>(m_cells, positions.template cast<double>(), m_forces);
        }
        m_batch.push(positions, velocities, accelerations, m_forces, root_weights);
        if (m_batch.full()) {
            flush();
        }
    }

    void index_springs(const SpringNetwork<Dim, Scalar>& network);
    void flush();
    void add_node(Index node, Eigen::Matrix<double, detail::FrameBatch<Dim, Scalar>::rows, Eigen::Dynamic>& equations);
    [[nodiscard]] AccelerationProblem take_problem(std::vector<double> gram);
    void identify(AccelerationProblem& problem) const;

    AccelerationOptions<Scalar> m_options;
    Execution m_execution;
    Parameters m_parameters;
    Values<double> m_mass;
    Values<double> m_root_weight;                         ///< sqrt(w_i) / m_i
    Values<double> m_stiffness, m_rest_length, m_damping; ///< per spring; known values, 0 where fitted
    SpringNetwork<Dim, double> m_cells;                   ///< the cells alone
    Points<Dim, double> m_forces;                         ///< of the frame added last, external and of the cells
    bool m_uses_velocity = false;
    std::vector<bool> m_seen_free; ///< nodes that some motion leaves free

    std::vector<Index> m_end_begin; ///< per node, its entries of m_ends
    std::vector<End> m_ends;
    std::vector<Index> m_column_begin; ///< per node, its entries of m_columns
    std::vector<int> m_columns;        ///< numbers of the unknowns at the node, ascending
    std::vector<Index> m_gram_begin;   ///< per node, its packed lower triangle of [A y]'[A y]
    std::vector<double> m_gram;
    detail::FrameBatch<Dim, Scalar> m_batch;
};

/// The fit of the springs of `network` to `motions`, each with the same weight, ready for any solver.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] AccelerationProblem
acceleration_problem(const SpringNetwork<Dim, Scalar>& network, const std::vector<Motion<Dim, Scalar>>& motions,
                     const AccelerationOptions<Scalar>& options = {}, const Execution& execution = {}) {
    AccelerationObjective<Dim, Scalar> objective(network, options, execution);
    for (const auto& motion : motions) {
        objective.add(motion);
    }
    return std::move(objective).problem();
}

} // namespace springfit

#include <springfit/fit/acceleration/detail/objective_impl.hpp>
