// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/implicit_body.hpp>

namespace springfit {

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
ImplicitBody<Dim, ScalarType, LinearScalar>::ImplicitBody(const SpringNetwork<Dim, Scalar>& network,
                                                          const ImplicitBodyOptions<Scalar>& options,
                                                          const Execution& execution)
    : Base(network, execution), m_options(options), m_operator(this->m_springs) {
    require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    require(options.linear_tolerance > 0 && options.linear_tolerance < 1, "linear_tolerance", "a value in (0, 1)",
            options.linear_tolerance);
    require(options.max_linear_iterations > 0, "max_linear_iterations", "at least one", options.max_linear_iterations);
    require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
    for (Index c = 0; c < network.n_cells(); ++c) {
        const detail::VolumeCell<Dim, Scalar> cell(network, c, network.rest_positions);
        const auto slopes = cell.gradient().colwise().norm().eval();
        for (int a = 0; a <= Dim; ++a) {
            this->m_stiffness[this->place(network.cells(a, c))] +=
                std::abs(network.volume_stiffness(c)) * slopes(a) * slopes.sum() / network.rest_volume(c);
        }
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::set_inertia(Scalar h) {
    for (std::size_t i = 0; i < this->m_mass.size(); ++i) {
        m_operator.inertia()[i] = static_cast<LinearScalar>(this->m_mass[i] / (h * h));
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
ImplicitStepReport<ScalarType> ImplicitBody<Dim, ScalarType, LinearScalar>::step(Scalar h) {
    require(h > 0 && std::isfinite(h), "h", "a positive time step", h);
    ImplicitStepReport<Scalar> report;
    this->start_step(h);
    set_inertia(h);
    iterate(h, report);
    this->finish_step(h, report.status);
    return report;
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::iterate(Scalar h, ImplicitStepReport<Scalar>& report) {
    constexpr Scalar tightest = 16 * static_cast<Scalar>(std::numeric_limits<LinearScalar>::epsilon());
    const Scalar per_position = this->rounding(h);
    Found found = linearise(h, false);
    const Scalar first = found.gradient;
    const Scalar force = std::max(found.force, first);
    bool may_be_exact = true;
    for (;; ++report.iterations) {
        const Scalar rounding = per_position * found.position;
        report.unbalanced = found.gradient;
        report.status = !found.finite ? Status::diverged
                        : found.gradient <= std::max(m_options.tolerance * force, 4 * rounding)
                            ? Status::converged
                            : Status::iteration_limit;
        if (report.status != Status::iteration_limit || report.iterations == m_options.max_iterations) {
            return;
        }
        const Scalar tolerance = m_options.linear_tolerance * std::min(Scalar(1), found.gradient / first);
        const auto outcome =
            m_operator.solve(this->m_execution, static_cast<LinearScalar>(1 / found.gradient),
                             static_cast<LinearScalar>(std::max(tightest, tolerance)), m_options.max_linear_iterations);
        report.linear_iterations += outcome.iterations;
        may_be_exact = may_be_exact && !outcome.indefinite;
        m_length = found.gradient;
        this->move(m_length, m_operator.solution());
        if (report.iterations + 1 == m_options.max_iterations) {
            ++report.iterations; // nobody asks how good it is
            return;
        }
        const bool is_exact = may_be_exact && found.gradient <= Scalar(1e-2) * force;
        if (!search(h, is_exact, outcome.decrease * static_cast<double>(found.gradient), found)) {
            report.status = found.gradient <= 64 * rounding ? Status::converged : Status::stalled;
            return;
        }
    }
}

/// Linearises where the last direction leads, shortened until it no longer leads uphill about as steeply as it began
/// downhill, or until the gradient has fallen; false, with the positions where it began, where it never does.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
bool ImplicitBody<Dim, ScalarType, LinearScalar>::search(Scalar h, bool exact, double decrease, Found& found) {
    const Found before = found;
    for (int attempt = 0; attempt < 16; ++attempt) {
        found = linearise(h, exact);
        if (found.finite && (found.slope <= 0.8 * decrease || found.gradient < before.gradient)) {
            return true;
        }
        const double secant = found.finite ? decrease / (decrease + found.slope) : 0;
        const Scalar shorter = m_length * static_cast<Scalar>(std::clamp(secant, 0.1, 0.5));
        this->move(shorter - m_length, m_operator.solution());
        m_length = shorter;
    }
    this->move(-m_length, m_operator.solution());
    found = before;
    return false;
}

/// Forces, Hessian and balance at the positions.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
auto ImplicitBody<Dim, ScalarType, LinearScalar>::linearise(Scalar h, bool exact) -> Found {
    this->for_domains([&](std::size_t d, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            this->m_forces[i] = {};
            m_operator.blocks()[i] = {};
        }
        auto& target = m_operator.domain(d);
        if (this->m_is_damped) {
            add_springs<true, true>(domain.inner, target.inner, h, exact);
            add_springs<true, false>(domain.border, target.border, h, exact);
        } else {
            add_springs<false, true>(domain.inner, target.inner, h, exact);
            add_springs<false, false>(domain.border, target.border, h, exact);
        }
        add_cells(domain, target, exact);
        m_operator.invert(domain.begin, domain.end, this->m_is_free);
        this->m_found[d] = {};
        this->set_residual(domain, h, m_operator.residual(), m_operator.solution(), this->m_found[d]);
    });
    return this->found();
}

/// The share of springs in forces and Hessian: c_1 = k (1 - l/L), u = sqrt(k - c_1 + c/h) r/L. The damping's direction
/// is that of r, not of r_n, in the Hessian.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
template <bool Damped, bool OnBothEnds>
void ImplicitBody<Dim, ScalarType, LinearScalar>::add_springs(const std::vector<Block>& blocks,
                                                              typename Operator::Part& part, Scalar h, bool exact) {
    using LinearLanes = detail::Simd<LinearScalar, 4>;
    auto* const matrix = m_operator.blocks().data();
    const Scalar lowest = exact ? Scalar(-100) : Scalar(0); // bounded where a spring has nearly no length
    const auto add = [&](std::size_t at, std::size_t i, std::size_t j, const Four& force, const Four& axial,
                         Scalar c1) {
        this->m_forces[i].lanes += force.lanes;
        if constexpr (OnBothEnds) {
            this->m_forces[j].lanes -= force.lanes;
        }
        LinearLanes u = __builtin_convertvector(axial.lanes, LinearLanes);
        const auto transverse = static_cast<LinearScalar>(c1);
        const LinearScalar held = std::max(transverse, LinearScalar(0));
        for (int d = 0; d < Dim; ++d) {
            LinearLanes column = u[d] * u;
            column[d] += held;
            matrix[i].columns[d].lanes += column;
            if constexpr (OnBothEnds) {
                matrix[j].columns[d].lanes += column;
            }
        }
        u[3] = transverse;
        part.terms[at].lanes = u;
    };
    this->template for_springs<Damped>(blocks, h, lowest, add);
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::add_cells(const typename Packed::Domain& domain,
                                                            typename Operator::Domain& target, bool exact) {
    for (std::size_t at = 0; at < domain.cells.size(); ++at) {
        const auto& cell = domain.cells[at];
        auto& term = target.cells[at];
        SimplexCorners<Dim, Scalar> corners;
        for (int a = 0; a <= Dim; ++a) {
            term.nodes[a] = cell.corners[a];
            corners.col(a) = this->vector(this->m_positions[static_cast<std::size_t>(term.nodes[a])]);
        }
        const Scalar kappa = cell.stiffness;
        const Scalar pressure = kappa * (signed_volume<Dim, Scalar>(corners) * cell.inverse_volume - 1);
        const SimplexCorners<Dim, Scalar> gradient = volume_gradient<Dim, Scalar>(corners);
        term.gradient = (std::sqrt(std::abs(kappa) * cell.inverse_volume) * gradient).template cast<LinearScalar>();
        term.sides = detail::sides_of<Dim, LinearScalar>(corners.template cast<LinearScalar>());
        term.sign = kappa > 0 ? LinearScalar(1) : kappa < 0 && exact ? LinearScalar(-1) : LinearScalar(0);
        term.pressure = exact ? static_cast<LinearScalar>(pressure) : LinearScalar(0);
        for (int a = 0; a <= Dim; ++a) {
            const int node = term.nodes[a];
            if (node < domain.begin || node >= domain.end) {
                continue;
            }
            auto& block = m_operator.blocks()[static_cast<std::size_t>(node)];
            for (int d = 0; d < Dim; ++d) {
                this->m_forces[static_cast<std::size_t>(node)].lanes[d] -= pressure * gradient(d, a);
                for (int e = 0; kappa > 0 && e < Dim; ++e) {
                    block.columns[d].lanes[e] += term.gradient(d, a) * term.gradient(e, a);
                }
            }
        }
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
    requires SpatialDimension<Dim>
Points<Dim, ScalarType>
ImplicitBody<Dim, ScalarType, LinearScalar>::apply_hessian(const Points<Dim, Scalar>& displacements, Scalar h,
                                                           bool exact) {
    require(displacements.cols() == this->n_nodes(), "displacements", text(this->n_nodes(), " nodes"),
            displacements.cols());
    this->start_step(h);
    set_inertia(h);
    this->m_positions = this->m_start;
    (void)linearise(h, exact);
    Points<Dim, Scalar> result(Dim, this->n_nodes());
    for (int node = 0; node < this->n_nodes(); ++node) {
        m_operator.direction()[this->place(node)] = {};
        for (int d = 0; d < Dim; ++d) {
            m_operator.direction()[this->place(node)].lanes[d] = static_cast<LinearScalar>(displacements(d, node));
        }
    }
    this->for_domains([&](std::size_t d, const auto&) { m_operator.multiply(m_operator.domain(d)); });
    for (int node = 0; node < this->n_nodes(); ++node) {
        result.col(node) = this->vector(m_operator.product()[this->place(node)]);
    }
    return result;
}

} // namespace springfit
