// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/execution.hpp>
#include <springfit/core/status.hpp>
#include <springfit/fit/trajectory/detail/window_simulation.hpp>
#include <springfit/fit/trajectory/parameters.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/motion/resample.hpp>

namespace springfit {

/// The implicit integrator that predicts dynamic windows.
enum class PredictionRule {
    midpoint,      ///< implicit midpoint: second order, keeps energy but for the springs' damping
    implicit_euler ///< first order; damps what the step does not resolve
};

/// Options of trajectory matching, whatever the engine.
struct TrajectoryOptions {
    TrajectoryParameterOptions parameters{};
    double prior_weight = 1e-4; ///< lambda >= 0: weight of |theta|^2 beside cases of unit size
    /// Frames that a window predicts, from the recorded state of its first frame; 0: each motion to its end.
    int horizon = 0;
    int window_stride = 0;   ///< frames from one window's start to the next's; 0: the horizon
    int steps_per_frame = 1; ///< steps of the integrator between two frames, >= 1
    PredictionRule rule = PredictionRule::midpoint;
    /// Steps between kept states; those between are simulated again when they are needed. 0: all are kept where they
    /// take less than 512 MiB, else about the root of their number.
    int checkpoint_interval = 0;
    Execution execution{}; ///< blocks of windows are independent of each other
};

template <int Dim>
class TrajectoryPoint;

/// Match the model's own motion [our definition]: minimise over theta, theta = 0 the prior,
///
///     J = 1/2 sum_cases 1/s sum_frames |x(t; theta) - x_ref(t)|^2  +  lambda/2 |theta|^2 ,   lower <= theta <= upper,
///
/// sums over the nodes that are not clamped and were seen. A motion of one frame is a static case: x is the network's
/// equilibrium. Any other is cut into windows: from the recorded positions and velocities of its first frame the
/// network is stepped on its own, under the recorded forces and clamps, over the horizon. s makes cases of one size:
/// for a static case sum |x_ref - x_rest|^2, for the windows of a motion the lesser of that and of the distance from
/// the straight motion x_0
/// + t v_0 that no force would give. With a horizon of one short step J is therefore the acceleration objective, to the
/// first order of the step.
///
/// Large strains are treated as they are. Memory: linear in springs + windows x nodes, besides one sparse factor per
/// set of clamps.
template <int Dim>
class TrajectoryProblem {
public:
    static constexpr int dimension = Dim;

    /// The network's own values are the prior: give it the stiffness of a closed form. Throws InvalidArgument for a
    /// motion that does not fit the network, frames that are not evenly spaced, a case without any free node that
    /// moves, or an option out of range.
    template <std::floating_point Scalar>
    TrajectoryProblem(const SpringNetwork<Dim, Scalar>& network, const std::vector<Motion<Dim, Scalar>>& motions,
                      const TrajectoryOptions& options = {});

    [[nodiscard]] Index n_unknowns() const { return m_parameters.n_unknowns(); }
    [[nodiscard]] const TrajectoryParameters<Dim>& parameters() const { return m_parameters; }
    [[nodiscard]] const TrajectoryOptions& options() const { return m_options; }
    [[nodiscard]] Index n_windows() const;
    /// True where every case is static.
    [[nodiscard]] bool is_static() const;

private:
    friend class TrajectoryPoint<Dim>;

    void add_windows(std::size_t motion, std::vector<detail::WindowBlock>& single);
    [[nodiscard]] std::size_t group_of(const std::vector<int>& clamped, double step);
    [[nodiscard]] Index checkpoint_interval(const detail::WindowBlock& block) const;

    TrajectoryOptions m_options;
    TrajectoryParameters<Dim> m_parameters;
    std::vector<Motion<Dim, double>> m_motions;
    std::vector<detail::WindowGroup<Dim>> m_groups;
    std::vector<detail::WindowBlock> m_blocks;
};

/// The objective of a problem at one theta, with what its derivatives need.
///
///     TrajectoryPoint point(problem);
///     if (point.move_to(theta)) { ... point.value(), point.gradient() ... }
template <int Dim>
class TrajectoryPoint {
public:
    explicit TrajectoryPoint(const TrajectoryProblem<Dim>& problem);

    /// Simulates all cases; static equilibria are looked for next to those of `near`. False, and a value of infinity,
    /// where the network at theta is singular, unstable or does not come to balance: such a point must be stepped back
    /// from. O(windows x steps x (springs + entries of the factor)) and one factorisation per set of clamps.
    [[nodiscard]] bool move_to(const Values<double>& theta, const TrajectoryPoint* near = nullptr);

    [[nodiscard]] const Values<double>& theta() const { return m_theta; }
    [[nodiscard]] const SpringNetwork<Dim, double>& network() const { return m_network; }
    /// J, with the prior's part.
    [[nodiscard]] double value() const { return m_value; }
    /// Root of the mean over the cases of sum |x - x_ref|^2 / s: the relative error of the training motions.
    [[nodiscard]] double misfit() const { return m_misfit; }

    /// dJ/dtheta [n_unknowns], by the discrete adjoint of statics and steps, exact but for the tolerance of its linear
    /// solves. False where an equilibrium or a step turns out to be unstable. Costs about as much as `move_to`.
    [[nodiscard]] bool gradient(Values<double>& gradient);

    /// H direction, H = J' W J + lambda I the Gauss-Newton matrix. Two solves per case and step, each by conjugate
    /// gradients with the one factorisation: one iteration at small strain, a few at large.
    [[nodiscard]] Values<double> product(const Values<double>& direction);

    /// True where `dense` may be used: static cases seen in full, stiffness and volume alone fitted, springs turned
    /// little.
    [[nodiscard]] bool has_dense() const;

    /// H in full [n_unknowns x n_unknowns], of small problems: for each set of clamps (B' K^-2 B) o (S W S'), B the
    /// springs' directions and S their tensions. Also takes the springs' directions at the rest shape.
    [[nodiscard]] DenseMatrix<double> dense();

    /// Estimate of the diagonal of J' W J from `probes` random vectors: the mean of (J' W^(1/2) z)^2.
    [[nodiscard]] Values<double> curvature(int probes);

private:
    template <class Body>
    NetworkValues sum_over_blocks(const Body& body);
    [[nodiscard]] detail::WindowSimulation<Dim> simulation(std::size_t block) const;

    const TrajectoryProblem<Dim>* m_problem;
    Values<double> m_theta;
    SpringNetwork<Dim, double> m_network;
    std::vector<std::unique_ptr<BlockCholesky>> m_factors;
    std::vector<detail::WindowTape<Dim>> m_tapes;
    double m_value = std::numeric_limits<double>::infinity();
    double m_misfit = std::numeric_limits<double>::infinity();
};

} // namespace springfit

#include <springfit/fit/trajectory/detail/point_impl.hpp>
#include <springfit/fit/trajectory/detail/problem_impl.hpp>
