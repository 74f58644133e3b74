// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <pagmo/threading.hpp>
#include <pagmo/types.hpp>

#include <springfit/fit/trajectory/problem.hpp>

/// Searches that only look at values, through pagmo2: what was done before gradients of motion were at hand, kept as
/// baselines for `gauss_newton` and `ipopt::trajectory`, which need tens to hundreds of times fewer simulations.
namespace springfit::search {

/// The box that a search looks in: lower <= theta <= upper, besides the bounds of the problem itself.
struct SearchBox {
    double lower = -3; ///< of every theta, finite; of stiffness a factor exp(-3) = 1/20
    double upper = 3;  ///< finite, >= lower
};

/// A trajectory problem as pagmo's user-defined problem: `pagmo::problem(TrajectoryMatch<Dim>(problem))`.
///
/// Decision vector: theta `[n_unknowns]` in the box. Fitness: J, and `penalty` where the network cannot be simulated or
/// is unstable. Fitness depends on theta alone: static equilibria are looked for next to those recorded. Copies
/// share the problem, read only, and have their own working memory, so that different copies may be used by different
/// threads at once (pagmo's `thread_safety::basic`); the problem's own `execution` is used within each.
template <int Dim>
class TrajectoryMatch {
public:
    static constexpr double penalty = 1e30; ///< fitness of what cannot be simulated

    /// As pagmo demands it: one without a problem, of no use but to be assigned to.
    TrajectoryMatch() = default;

    /// Throws InvalidArgument for no problem, a box out of range or one that misses the problem's bounds.
    explicit TrajectoryMatch(std::shared_ptr<const TrajectoryProblem<Dim>> problem, const SearchBox& box = {})
        : m_problem(std::move(problem)) {
        require(m_problem != nullptr, "problem", "a problem", "none");
        require(std::isfinite(box.lower) && std::isfinite(box.upper) && box.lower <= box.upper, "box",
                "finite lower <= upper", text("[", box.lower, ", ", box.upper, "]"));
        m_lower = m_problem->parameters().lower().cwiseMax(box.lower);
        m_upper = m_problem->parameters().upper().cwiseMin(box.upper);
        for (Index u = 0; u < m_lower.size(); ++u) {
            require(m_lower(u) <= m_upper(u), "box", "a range that the bounds of every unknown share",
                    text("none for unknown ", u));
        }
    }

    TrajectoryMatch(const TrajectoryMatch& other)
        : m_problem(other.m_problem), m_lower(other.m_lower), m_upper(other.m_upper) {}
    TrajectoryMatch(TrajectoryMatch&&) = default;
    TrajectoryMatch& operator=(const TrajectoryMatch& other) { return *this = TrajectoryMatch(other); }
    TrajectoryMatch& operator=(TrajectoryMatch&&) = default;
    ~TrajectoryMatch() = default;

    [[nodiscard]] const TrajectoryProblem<Dim>& problem() const { return *m_problem; }
    [[nodiscard]] const Values<double>& lower() const { return m_lower; }
    [[nodiscard]] const Values<double>& upper() const { return m_upper; }
    /// The point of the box that is next to theta = 0.
    [[nodiscard]] Values<double> prior() const {
        return Values<double>::Zero(m_lower.size()).cwiseMax(m_lower).cwiseMin(m_upper);
    }

    /// Moves a point of the problem to theta as `fitness` does; false where that fails.
    [[nodiscard]] bool move(TrajectoryPoint<Dim>& point, const Values<double>& theta) const {
        return point.move_to(theta) && point.value() < penalty;
    }

    [[nodiscard]] pagmo::vector_double fitness(const pagmo::vector_double& x) const {
        if (!m_point) {
            m_point = std::make_unique<TrajectoryPoint<Dim>>(*m_problem);
        }
        const Values<double> theta = Eigen::Map<const Values<double>>(x.data(), static_cast<Index>(x.size()));
        return {move(*m_point, theta) ? m_point->value() : penalty};
    }

    [[nodiscard]] std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
        return {{m_lower.begin(), m_lower.end()}, {m_upper.begin(), m_upper.end()}};
    }

    [[nodiscard]] std::string get_name() const { return "springfit trajectory matching"; }
    [[nodiscard]] pagmo::thread_safety get_thread_safety() const { return pagmo::thread_safety::basic; }

private:
    std::shared_ptr<const TrajectoryProblem<Dim>> m_problem;
    Values<double> m_lower, m_upper;
    mutable std::unique_ptr<TrajectoryPoint<Dim>> m_point; ///< working memory of this copy
};

} // namespace springfit::search
