// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include <Eigen/Cholesky>

#include <springfit/core/maximum.hpp>
#include <springfit/core/progress.hpp>
#include <springfit/core/stopwatch.hpp>
#include <springfit/fit/trajectory/problem.hpp>
#include <springfit/solve/conjugate_gradients.hpp>

namespace springfit {

/// What an engine of trajectory matching found.
struct TrajectoryReport {
    Status status = Status::failed; ///< `failed`: neither the prior nor a stiffer one could be simulated
    Values<double> theta;           ///< [n_unknowns], within the bounds; the best point that was simulated and stable
    double objective_start = 0;     ///< J at the prior; infinite where the prior could not be simulated
    double objective = 0;           ///< J at theta
    double misfit_start = 0;        ///< relative error of the training motions at the prior, likewise
    double misfit = 0;              ///< at theta
    std::vector<double> history;    ///< J after each iteration
    int iterations = 0;
    int evaluations = 0; ///< simulations of all cases
    int rejected = 0;    ///< trial points that were stepped back from: worse, singular, unstable
    double seconds = 0;
    double gradient_max = 0; ///< largest entry of the projected gradient at theta
    /// Gauss-Newton curvature of the data along each unknown, diag(J' W J) [n_unknowns].
    Values<double> curvature;
    /// curvature / (curvature + lambda), in [0, 1]: above 1/2 the data sets the value, below the prior.
    Values<double> data_share;

    /// Unknowns whose value the data sets.
    [[nodiscard]] Index n_set_by_data() const { return (data_share.array() > 0.5).count(); }
};

/// Which form of the Gauss-Newton matrix to use.
enum class GaussNewtonForm {
    automatic,  ///< dense where `TrajectoryPoint::has_dense`, else matrix-free
    dense,      ///< the Hadamard form and a Cholesky factor
    matrix_free ///< conjugate gradients on products
};

struct GaussNewtonOptions {
    int max_iterations = 40;
    /// Stop when an iteration lowers J by less than this part, twice running, and gains do not grow; > 0.
    double tolerance = 1e-3;
    GaussNewtonForm form = GaussNewtonForm::automatic;
    int max_cg_iterations = 40;  ///< of each matrix-free step
    double cg_tolerance = 0.05;  ///< relative residual of each matrix-free step, in (0, 1)
    double max_step = 1.5;       ///< largest change of an entry of theta in one iteration, > 0
    int probes = 16;             ///< random vectors for the diagonal in matrix-free form, >= 1
    ProgressCallback progress{}; ///< may end the search with the best so far
};

namespace detail {

/// Marks unknowns that sit at a bound and would leave it along minus the gradient.
inline std::vector<bool> at_active_bound(const Values<double>& theta, const Values<double>& gradient,
                                         const Values<double>& lower, const Values<double>& upper) {
    std::vector<bool> active(static_cast<std::size_t>(theta.size()));
    for (Index u = 0; u < theta.size(); ++u) {
        active[static_cast<std::size_t>(u)] =
            (theta(u) <= lower(u) && gradient(u) > 0) || (theta(u) >= upper(u) && gradient(u) < 0);
    }
    return active;
}

/// Minimises 1/2 s'(H + mu I)s + gradient's over the unknowns that are not active, by conjugate gradients with the
/// diagonal.
template <class Product>
Values<double> reduced_newton_step(const Product& product, const Values<double>& diagonal, double mu,
                                   const Values<double>& gradient, const std::vector<bool>& active, double tolerance,
                                   int max_iterations) {
    const auto reduce = [&](Values<double>& v) {
        for (Index u = 0; u < v.size(); ++u) {
            if (active[static_cast<std::size_t>(u)]) {
                v(u) = 0;
            }
        }
    };
    Values<double> right = -gradient;
    reduce(right);
    Values<double> inverse = (diagonal.array() + mu).inverse();
    reduce(inverse);
    Values<double> step;
    (void)conjugate_gradients(
        [&](const Values<double>& p, Values<double>& q) {
            q = product(p) + mu * p;
            reduce(q);
        },
        [&](const Values<double>& r, Values<double>& z) { z = inverse.cwiseProduct(r); }, right, step, tolerance,
        max_iterations);
    return step;
}

/// Shortens a step to a root mean square of a third of `most`, then each entry to `most`: a few entries of which little
/// is known do not hold up the others.
inline void limit(Values<double>& step, double most) {
    const double mean = std::sqrt(step.squaredNorm() / static_cast<double>(step.size()));
    if (3 * mean > most) {
        step *= most / (3 * mean);
    }
    step = step.cwiseMax(-most).cwiseMin(most);
}

/// NaN where an entry is.
inline double largest_projected(const Values<double>& gradient, const std::vector<bool>& active) {
    double largest = 0;
    for (Index u = 0; u < gradient.size(); ++u) {
        largest = maximum(largest, active[static_cast<std::size_t>(u)] ? 0. : std::abs(gradient(u)));
    }
    return largest;
}

/// Whether iterations have gained too little for a search to go on: less than a part of what is left twice running, the
/// second no more than the first. Gains that grow are those of steps that damping still shortens.
class SmallGains {
public:
    explicit SmallGains(double part) : m_part(part) {}

    /// An iteration lowered the objective by `gain` from `value`.
    void add(double gain, double value) {
        const bool is_small = gain < m_part * value;
        m_enough = is_small && m_was_small && gain <= m_last;
        m_was_small = is_small;
        m_last = gain;
    }
    [[nodiscard]] bool enough() const { return m_enough; }

private:
    double m_part;
    double m_last = 0;
    bool m_was_small = false;
    bool m_enough = false;
};

/// The curvature of the data along each unknown, and what part the data has in it beside the prior.
inline void set_curvature(Values<double> curvature, double lambda, TrajectoryReport& report) {
    report.data_share = curvature.array() / (curvature.array() + std::max(lambda, 1e-300));
    report.curvature = std::move(curvature);
}

/// Moves `point` to the prior, or to 2, 4 or 8 times its stiffness where the prior fails or that halves J, within the
/// bounds, and fills the start of a report. False where none of them can be simulated. `trial` is working memory.
template <int Dim>
[[nodiscard]] bool move_to_start(const TrajectoryProblem<Dim>& problem, const Values<double>& lower,
                                 const Values<double>& upper, std::unique_ptr<TrajectoryPoint<Dim>>& point,
                                 std::unique_ptr<TrajectoryPoint<Dim>>& trial, Values<double>& gradient,
                                 TrajectoryReport& report) {
    const Index n = problem.n_unknowns();
    report.theta = Values<double>::Zero(n).cwiseMax(lower).cwiseMin(upper);
    report.objective_start = report.misfit_start = std::numeric_limits<double>::infinity();
    report.curvature = report.data_share = Values<double>::Zero(n);
    bool started = false;
    for (double factor : {1., 2., 4., 8.}) { // a prior that is too soft folds under its loads, or cannot hold them
        const Values<double> theta = problem.parameters().uniform_stiffness(factor).cwiseMax(lower).cwiseMin(upper);
        Values<double> own_gradient;
        ++report.evaluations;
        const bool is_stable = trial->move_to(theta) && trial->gradient(own_gradient);
        if (is_stable && factor == 1.) {
            report.objective_start = trial->value();
            report.misfit_start = trial->misfit();
        }
        if (is_stable && (!started || trial->value() < point->value() / 2)) {
            point.swap(trial);
            gradient.swap(own_gradient);
            started = true;
        } else if (started) {
            break;
        }
    }
    return started;
}

} // namespace detail

/// Trajectory matching by a damped Gauss-Newton method (Levenberg and Marquardt) with exact gradients, projected onto
/// the bounds.
///
/// Each iteration: one simulation of all cases, one adjoint, one factorisation per set of clamps; a dense Hadamard
/// matrix for small static problems (n_unknowns^2 memory), else at most `max_cg_iterations` products of two solves per
/// case. A trial point that is worse, singular, unstable or diverging is stepped back from by raising the damping, and
/// is never returned. Starts from the prior, or from 2, 4 or 8 times its stiffness where the prior fails or that halves
/// J. Deterministic.
template <int Dim>
[[nodiscard]] TrajectoryReport gauss_newton(const TrajectoryProblem<Dim>& problem,
                                            const GaussNewtonOptions& options = {}) {
    require(options.max_iterations >= 0, "max_iterations", "a number not below 0", options.max_iterations);
    require(options.tolerance > 0, "tolerance", "a positive value", options.tolerance);
    require(options.max_cg_iterations >= 1, "max_cg_iterations", "at least one", options.max_cg_iterations);
    require(options.cg_tolerance > 0 && options.cg_tolerance < 1, "cg_tolerance", "a value in (0, 1)",
            options.cg_tolerance);
    require(options.max_step > 0, "max_step", "a positive value", options.max_step);
    require(options.probes >= 1, "probes", "at least one", options.probes);

    const Stopwatch watch;
    const auto& lower = problem.parameters().lower();
    const auto& upper = problem.parameters().upper();
    const double lambda = problem.options().prior_weight;
    const Index n = problem.n_unknowns();

    TrajectoryReport report;
    auto point = std::make_unique<TrajectoryPoint<Dim>>(problem);
    auto trial = std::make_unique<TrajectoryPoint<Dim>>(problem);
    Values<double> gradient = Values<double>::Zero(n);
    if (!detail::move_to_start(problem, lower, upper, point, trial, gradient, report)) {
        return report;
    }
    report.status = Status::iteration_limit;

    double mu = 0;
    detail::SmallGains small_gains(options.tolerance);
    bool fresh = true; // the matrix at `point` is still to be made
    DenseMatrix<double> dense;
    Values<double> diagonal;
    std::vector<bool> active;
    while (true) {
        if (fresh) {
            active = detail::at_active_bound(point->theta(), gradient, lower, upper);
            report.gradient_max = detail::largest_projected(gradient, active);
            const bool use_dense = options.form == GaussNewtonForm::dense ||
                                   (options.form == GaussNewtonForm::automatic && point->has_dense());
            if (use_dense) {
                dense = point->dense();
                diagonal = dense.diagonal();
            } else {
                dense.resize(0, 0);
                diagonal = point->curvature(options.probes).array() + lambda;
            }
            const double least = 1e-14 * diagonal.maxCoeff(); // nothing says anything of what is below
            for (Index u = 0; u < n; ++u) {
                active[static_cast<std::size_t>(u)] = active[static_cast<std::size_t>(u)] || !(diagonal(u) > least);
            }
            fresh = false;
        }
        if (report.gradient_max <= 1e-14 || small_gains.enough()) {
            report.status = Status::converged;
            break;
        }
        if (report.iterations >= options.max_iterations) {
            break;
        }
        if (!go_on(options.progress, "trajectory",
                   static_cast<double>(report.iterations) / std::max(1, options.max_iterations))) {
            report.status = Status::interrupted;
            break;
        }

        Values<double> step;
        if (dense.size() > 0) {
            DenseMatrix<double> matrix = dense;
            Values<double> right = -gradient;
            matrix.diagonal().array() += mu;
            for (Index u = 0; u < n; ++u) {
                if (active[static_cast<std::size_t>(u)]) {
                    matrix.row(u).setZero();
                    matrix.col(u).setZero();
                    matrix(u, u) = 1;
                    right(u) = 0;
                }
            }
            step = std::move(right);
            Eigen::LDLT<Eigen::Ref<DenseMatrix<double>>>(matrix).solveInPlace(step); // of the type in other solvers
        } else {
            step = detail::reduced_newton_step([&](const Values<double>& v) { return point->product(v); }, diagonal, mu,
                                               gradient, active, options.cg_tolerance, options.max_cg_iterations);
        }
        detail::limit(step, options.max_step);
        const Values<double> theta = (point->theta() + step).cwiseMax(lower).cwiseMin(upper);
        Values<double> trial_gradient;
        ++report.evaluations;
        const bool accepted = step.allFinite() && trial->move_to(theta, point.get()) &&
                              trial->value() < point->value() && trial->gradient(trial_gradient);
        if (!accepted) {
            ++report.rejected;
            if (std::abs(gradient.dot(step)) < 1e-12 * point->value()) { // no more to gain than rounding
                report.status = Status::converged;
                break;
            }
            mu = std::max(8 * mu, 0.05 * diagonal.maxCoeff() / 8);
            if (!(mu <= 1e8 * diagonal.maxCoeff()) || step.cwiseAbs().maxCoeff() < 1e-10) {
                report.status = Status::stalled;
                break;
            }
            continue;
        }
        ++report.iterations;
        const double gain = point->value() - trial->value();
        small_gains.add(gain, point->value());
        mu = mu < 1e-6 * diagonal.maxCoeff() ? 0. : mu / 5;
        point.swap(trial);
        gradient.swap(trial_gradient);
        report.history.push_back(point->value());
        fresh = true;
    }
    report.theta = point->theta();
    report.objective = point->value();
    report.misfit = point->misfit();
    detail::set_curvature((diagonal.array() - lambda).cwiseMax(0.), lambda, report);
    report.seconds = watch.seconds();
    return report;
}

/// Gives a network the values that a trajectory fit found; in its own scalar. Throws InvalidArgument unless the network
/// has as many nodes, springs and cells as the one that the problem was made from.
template <int Dim, std::floating_point Scalar>
void apply(const TrajectoryProblem<Dim>& problem, const TrajectoryReport& report, SpringNetwork<Dim, Scalar>& network) {
    const SpringNetwork<Dim, double> fitted = problem.parameters().network(report.theta);
    const auto size = [](const auto& any) {
        return text(any.n_nodes(), " nodes, ", any.n_springs(), " springs and ", any.n_cells(), " cells");
    };
    require(size(network) == size(fitted), "network", size(fitted), size(network));
    network.stiffness = fitted.stiffness.template cast<Scalar>();
    network.damping = fitted.damping.template cast<Scalar>();
    network.rest_length = fitted.rest_length.template cast<Scalar>();
    network.volume_stiffness = fitted.volume_stiffness.template cast<Scalar>();
}

} // namespace springfit
