// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/step/implicit_body.hpp>

namespace springfit {

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim> ImplicitBody<Dim, ScalarType, LinearScalar>::ImplicitBody(
    const SpringNetwork<Dim, Scalar>& network, const ImplicitBodyOptions<Scalar>& options, const Execution& execution)
    : Base(network, execution), m_options(options), m_operator(this->m_springs),
      m_is_damped((network.damping.array() > 0).any()) {
    require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    require(options.linear_tolerance > 0 && options.linear_tolerance < 1, "linear_tolerance", "a value in (0, 1)",
            options.linear_tolerance);
    require(options.max_linear_iterations > 0, "max_linear_iterations", "at least one", options.max_linear_iterations);
    require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
    const auto n = static_cast<std::size_t>(network.n_nodes());
    m_start.resize(n);
    m_forces.resize(n);
    m_stiffness.assign(n, 0);
    m_damping.assign(n, 0);
    m_found.resize(this->m_springs.domains().size());
    for (Index e = 0; e < network.n_springs(); ++e) {
        for (int end : {0, 1}) {
            m_stiffness[this->place(network.springs(end, e))] += network.stiffness(e);
            m_damping[this->place(network.springs(end, e))] += network.damping(e);
        }
    }
    m_cells.cells = network.cells;
    for (int& node : m_cells.cells.reshaped()) {
        node = this->m_springs.number(node);
    }
    m_cells.rest_volume = network.rest_volume;
    m_cells.volume_stiffness = network.volume_stiffness;
    for (Index c = 0; c < network.n_cells(); ++c) {
        const detail::VolumeCell<Dim, Scalar> cell(network, c, network.rest_positions);
        const auto slopes = cell.gradient().colwise().norm().eval();
        for (int a = 0; a <= Dim; ++a) {
            m_stiffness[this->place(network.cells(a, c))] +=
                std::abs(network.volume_stiffness(c)) * slopes(a) * slopes.sum() / network.rest_volume(c);
        }
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::start_step(Scalar h) {
    this->for_domains([&](std::size_t, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            m_start[i] = this->m_positions[i];
            this->m_positions[i].lanes += h * this->m_velocities[i].lanes;
            m_operator.inertia()[i] = static_cast<LinearScalar>(this->m_mass[i] / (h * h));
        }
    });
}

/// x += length d at the free nodes, d the last direction.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::move(Scalar length) {
    this->for_domains([&](std::size_t, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            this->m_positions[i].lanes += length * __builtin_convertvector(m_operator.solution()[i].lanes, Lanes);
        }
    });
}

/// v = (x - x_n) / h; false, with the body as it was, where that is not finite.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
bool ImplicitBody<Dim, ScalarType, LinearScalar>::finish_step(Scalar h) {
    this->for_domains([&](std::size_t d, const auto& domain) {
        Lanes zero = {};
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            zero += 0 * this->m_positions[i].lanes;
        }
        m_found[d].finite = zero[0] + zero[1] + zero[2] == 0;
    });
    bool finite = true;
    for (const Found& found : m_found) {
        finite = finite && found.finite;
    }
    this->for_domains([&](std::size_t, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            if (!finite) {
                this->m_positions[i] = m_start[i];
            } else if (this->m_is_free[i]) {
                this->m_velocities[i].lanes = (this->m_positions[i].lanes - m_start[i].lanes) / h;
            }
        }
    });
    return finite;
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim> ImplicitStepReport<ScalarType>
ImplicitBody<Dim, ScalarType, LinearScalar>::step(Scalar h) {
    require(h > 0 && std::isfinite(h), "h", "a positive time step", h);
    ImplicitStepReport<Scalar> report;
    start_step(h);
    iterate(h, report);
    if (!finish_step(h)) {
        report.status = Status::diverged;
    }
    return report;
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::iterate(Scalar h, ImplicitStepReport<Scalar>& report) {
    constexpr Scalar tightest = 16 * static_cast<Scalar>(std::numeric_limits<LinearScalar>::epsilon());
    Scalar stiffest = 0;
    for (std::size_t i = 0; i < m_stiffness.size(); ++i) {
        stiffest = std::max(stiffest, m_stiffness[i] + m_damping[i] / h + this->m_mass[i] / (h * h));
    }
    Found found = linearise(h, false);
    const Scalar first = found.gradient;
    const Scalar force = std::max(found.force, first);
    bool may_be_exact = true;
    for (;; ++report.iterations) {
        const Scalar rounding = std::numeric_limits<Scalar>::epsilon() * stiffest * found.position;
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
        move(m_length);
        if (report.iterations + 1 == m_options.max_iterations) {
            ++report.iterations; // nobody asks how good it is
            return;
        }
        const bool is_exact = may_be_exact && found.gradient <= Scalar(1e-2) * force;
        if (!search(h, is_exact, outcome.decrease, found)) {
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
        move(shorter - m_length);
        m_length = shorter;
    }
    move(-m_length);
    found = before;
    return false;
}

/// Forces, Hessian and balance at the positions.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
auto ImplicitBody<Dim, ScalarType, LinearScalar>::linearise(Scalar h, bool exact) -> Found {
    this->for_domains([&](std::size_t d, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            m_forces[i] = {};
            m_operator.blocks()[i] = {};
        }
        auto& target = m_operator.domain(d);
        if (m_is_damped) {
            add_springs<true, true>(domain.inner, target.inner, h, exact);
            add_springs<true, false>(domain.border, target.border, h, exact);
        } else {
            add_springs<false, true>(domain.inner, target.inner, h, exact);
            add_springs<false, false>(domain.border, target.border, h, exact);
        }
        add_cells(domain, target, exact);
        m_operator.invert(domain.begin, domain.end, this->m_is_free);
        m_found[d] = {};
        balance(domain, h, m_found[d]);
    });
    Found all;
    for (const Found& found : m_found) {
        all.gradient = std::max(all.gradient, found.gradient);
        all.force = std::max(all.force, found.force);
        all.position = std::max(all.position, found.position);
        all.slope += found.slope;
        all.finite = all.finite && found.finite;
    }
    return all;
}

/// Forces of springs, (k (L - l) / L) r and c/h (r_n . (r - r_n)) r_n / |r_n|^2, and their share in the Hessian:
/// c_1 = k (1 - l/L), u = sqrt(k - c_1 + c/h) r/L. The damping's direction is that of r, not of r_n, in the Hessian.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
template <bool Damped, bool OnBothEnds>
void ImplicitBody<Dim, ScalarType, LinearScalar>::add_springs(const std::vector<Block>& blocks,
                                                              typename Operator::Part& part, Scalar h, bool exact) {
    constexpr int lanes = Packed::lanes;
    using Values = Eigen::Array<Scalar, lanes, 1>;
    using Map = Eigen::Map<Values, Eigen::Aligned32>;
    using ConstMap = Eigen::Map<const Values, Eigen::Aligned32>;
    using LinearLanes = detail::Simd<LinearScalar, 4>;
    const Four* const x = this->m_positions.data();
    const Four* const start = m_start.data();
    const Scalar per_step = 1 / h;
    const Scalar lowest = exact ? Scalar(-100) : Scalar(0); // bounded where a spring has nearly no length
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Block& block = blocks[b];
        alignas(64) Four r[lanes];
        alignas(64) Four old[lanes];
        alignas(64) Four rate[lanes]; // r_n . (r - r_n) in its lanes, summed up below
        alignas(64) Scalar squares[lanes], old_squares[lanes], rates[lanes];
        for (int l = 0; l < lanes; ++l) {
            const auto i = static_cast<std::size_t>(block.first[l]);
            const auto j = static_cast<std::size_t>(block.second[l]);
            r[l].lanes = x[j].lanes - x[i].lanes;
            if constexpr (Damped) {
                old[l].lanes = start[j].lanes - start[i].lanes;
                rate[l].lanes = r[l].lanes - old[l].lanes;
            }
        }
        for (int l = 0; l < lanes; l += 4) {
            detail::dot_products(r + l, r + l, squares + l);
            if constexpr (Damped) {
                detail::dot_products(old + l, old + l, old_squares + l);
                detail::dot_products(old + l, rate + l, rates + l);
            }
        }
        constexpr Scalar tiny = std::numeric_limits<Scalar>::min();
        const ConstMap k(block.stiffness);
        const Values inverse = (ConstMap(squares) + tiny).sqrt().inverse();
        const Values geometric = k - ConstMap(block.pull) * inverse;
        const Values c1 = geometric.max(lowest * k);
        Values axial = k - c1;
        alignas(64) Scalar tension[lanes], drag[lanes], factors[lanes], transverse[lanes];
        if constexpr (Damped) {
            axial += per_step * ConstMap(block.damping);
            Map{drag} = per_step * ConstMap(block.damping) * ConstMap(rates) / (ConstMap(old_squares) + tiny);
        }
        Map{tension} = geometric;
        Map{factors} = axial.sqrt() * inverse;
        Map{transverse} = c1;
        for (int l = 0; l < lanes; ++l) {
            const auto i = static_cast<std::size_t>(block.first[l]);
            const auto j = static_cast<std::size_t>(block.second[l]);
            Lanes force = tension[l] * r[l].lanes;
            if constexpr (Damped) {
                force += drag[l] * old[l].lanes;
            }
            const Lanes vector = factors[l] * r[l].lanes;
            LinearLanes u = __builtin_convertvector(vector, LinearLanes);
            const auto c = static_cast<LinearScalar>(transverse[l]);
            const LinearScalar held = std::max(c, LinearScalar(0));
            m_forces[i].lanes += force;
            if constexpr (OnBothEnds) {
                m_forces[j].lanes -= force;
            }
            for (int d = 0; d < Dim; ++d) {
                LinearLanes column = u[d] * u;
                column[d] += held;
                m_operator.blocks()[i].columns[d].lanes += column;
                if constexpr (OnBothEnds) {
                    m_operator.blocks()[j].columns[d].lanes += column;
                }
            }
            u[3] = c;
            part.terms[b * lanes + static_cast<std::size_t>(l)].lanes = u;
        }
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::add_cells(const typename Packed::Domain& domain,
                                                            typename Operator::Domain& target, bool exact) {
    for (std::size_t at = 0; at < domain.cells.size(); ++at) {
        const Index c = domain.cells[at];
        auto& term = target.cells[at];
        SimplexCorners<Dim, Scalar> corners;
        for (int a = 0; a <= Dim; ++a) {
            term.nodes[a] = m_cells.cells(a, c);
            corners.col(a) = this->vector(this->m_positions[static_cast<std::size_t>(term.nodes[a])]);
        }
        const Scalar kappa = m_cells.volume_stiffness(c);
        const Scalar pressure = kappa * (signed_volume<Dim, Scalar>(corners) / m_cells.rest_volume(c) - 1);
        const SimplexCorners<Dim, Scalar> gradient = volume_gradient<Dim, Scalar>(corners);
        term.gradient = (std::sqrt(std::abs(kappa) / m_cells.rest_volume(c)) * gradient).template cast<LinearScalar>();
        term.corners = (corners.colwise() - corners.col(0).eval()).template cast<LinearScalar>();
        term.sign = kappa > 0 ? LinearScalar(1) : kappa < 0 && exact ? LinearScalar(-1) : LinearScalar(0);
        term.pressure = exact ? static_cast<LinearScalar>(pressure) : LinearScalar(0);
        for (int a = 0; a <= Dim; ++a) {
            const int node = term.nodes[a];
            if (node < domain.begin || node >= domain.end) {
                continue;
            }
            auto& block = m_operator.blocks()[static_cast<std::size_t>(node)];
            for (int d = 0; d < Dim; ++d) {
                m_forces[static_cast<std::size_t>(node)].lanes[d] -= pressure * gradient(d, a);
                for (int e = 0; kappa > 0 && e < Dim; ++e) {
                    block.columns[d].lanes[e] += term.gradient(d, a) * term.gradient(e, a);
                }
            }
        }
    }
}

/// The right-hand side of the linear system: minus the gradient m/h^2 (x - x_n - h v_n) - f.
template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim>
void ImplicitBody<Dim, ScalarType, LinearScalar>::balance(const typename Packed::Domain& domain, Scalar h,
                                                          Found& found) {
    using LinearLanes = detail::Simd<LinearScalar, 4>;
    Lanes gradients = {}, forces = {}, positions = {}, zero = {};
    const auto raise = [](Lanes& largest, const Lanes& values) {
        const Lanes size = values < 0 ? -values : values;
        largest = size > largest ? size : largest;
    };
    for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
        if (!this->m_is_free[i]) {
            m_operator.residual()[i] = {};
            continue;
        }
        const Lanes moved = this->m_positions[i].lanes - m_start[i].lanes - h * this->m_velocities[i].lanes;
        const Lanes external = this->m_external[i].lanes;
        const Lanes elastic = m_forces[i].lanes;
        const Lanes right = external + elastic - this->m_mass[i] / (h * h) * moved;
        raise(gradients, right);
        raise(forces, external);
        raise(forces, elastic);
        raise(positions, this->m_positions[i].lanes);
        zero += 0 * right;
        const LinearLanes linear = __builtin_convertvector(right, LinearLanes);
        const LinearLanes work = linear * m_operator.solution()[i].lanes;
        found.slope -= static_cast<double>(work[0]) + static_cast<double>(work[1]) + static_cast<double>(work[2]);
        m_operator.residual()[i].lanes = linear;
    }
    found.finite = zero[0] + zero[1] + zero[2] == 0;
    for (int d = 0; d < Dim; ++d) {
        found.gradient = std::max(found.gradient, gradients[d]);
        found.force = std::max(found.force, forces[d]);
        found.position = std::max(found.position, positions[d]);
    }
}

template <int Dim, std::floating_point ScalarType, std::floating_point LinearScalar>
requires SpatialDimension<Dim> Points<Dim, ScalarType>
ImplicitBody<Dim, ScalarType, LinearScalar>::apply_hessian(const Points<Dim, Scalar>& displacements, Scalar h,
                                                           bool exact) {
    require(displacements.cols() == this->n_nodes(), "displacements", text(this->n_nodes(), " nodes"),
            displacements.cols());
    start_step(h);
    this->m_positions = m_start;
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
