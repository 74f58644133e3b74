// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/body/projective_body.hpp>

namespace springfit {

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
ProjectiveBody<Dim, Scalar>::ProjectiveBody(const SpringNetwork<Dim, Scalar>& network,
                                            const ProjectiveBodyOptions<Scalar>& options, const Execution& execution)
    : Base(network, execution), m_options(options), m_residual(static_cast<std::size_t>(network.n_nodes())),
      m_direction(m_residual.size()) {
    require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
    require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
    require(!(network.volume_stiffness.array() != 0).any(), "network", "springs alone, for the projective step",
            "cells with volume stiffness");
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void ProjectiveBody<Dim, Scalar>::set_clamped(const std::vector<int>& nodes) {
    m_free_before = this->m_is_free;
    this->clamp(nodes);
    if (m_free_before != this->m_is_free) {
        m_factorised_for = 0;
    }
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
auto ProjectiveBody<Dim, Scalar>::step(Scalar h) -> ImplicitStepReport<Scalar> {
    require(h > 0 && std::isfinite(h), "h", "a positive time step", h);
    ImplicitStepReport<Scalar> report;
    if (m_factorised_for != h) {
        if (!factorise(h)) {
            return report;
        }
        m_factorised_for = h;
    }
    this->start_step(h);
    iterate(h, report);
    this->finish_step(h, report.status);
    return report;
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
void ProjectiveBody<Dim, Scalar>::iterate(Scalar h, ImplicitStepReport<Scalar>& report) {
    const Scalar rounding = this->rounding(h);
    Scalar force = 0;
    for (;; ++report.iterations) {
        const Found found = evaluate(h);
        if (report.iterations == 0) {
            force = std::max(found.force, found.gradient);
        }
        report.unbalanced = found.gradient;
        report.status = !found.finite ? Status::diverged
                        : found.gradient <= std::max(m_options.tolerance * force, 4 * rounding * found.position)
                            ? Status::converged
                            : Status::iteration_limit;
        if (report.status != Status::iteration_limit) {
            return;
        }
        m_factor.solve(m_residual, m_direction);
        this->move(1, m_direction);
        if (report.iterations + 1 == m_options.max_iterations) {
            ++report.iterations; // nobody asks how good it is
            return;
        }
    }
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
auto ProjectiveBody<Dim, Scalar>::evaluate(Scalar h) -> Found {
    this->for_domains([&](std::size_t d, const auto& domain) {
        for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
            this->m_forces[i] = {};
        }
        const auto both = [&](std::size_t, std::size_t i, std::size_t j, const Four& force, const Four&, Scalar) {
            this->m_forces[i].lanes += force.lanes;
            this->m_forces[j].lanes -= force.lanes;
        };
        const auto own = [&](std::size_t, std::size_t i, std::size_t, const Four& force, const Four&, Scalar) {
            this->m_forces[i].lanes += force.lanes;
        };
        if (this->m_is_damped) {
            this->template for_springs<true>(domain.inner, h, 0, both);
            this->template for_springs<true>(domain.border, h, 0, own);
        } else {
            this->template for_springs<false>(domain.inner, h, 0, both);
            this->template for_springs<false>(domain.border, h, 0, own);
        }
        this->m_found[d] = {};
        this->set_residual(domain, h, m_residual, m_direction, this->m_found[d]);
    });
    return this->found();
}

template <int Dim, std::floating_point Scalar>
    requires SpatialDimension<Dim>
bool ProjectiveBody<Dim, Scalar>::factorise(Scalar h) {
    std::vector<Eigen::Triplet<float>> entries;
    for (std::size_t i = 0; i < this->m_mass.size(); ++i) {
        const Scalar own = this->m_mass[i] / (h * h) + this->m_stiffness[i] + this->m_damping[i] / h;
        entries.emplace_back(static_cast<int>(i), static_cast<int>(i),
                             this->m_is_free[i] ? static_cast<float>(own) : 1.f);
    }
    for (const auto& domain : this->m_springs.domains()) {
        for (const auto* blocks : {&domain.inner, &domain.border}) {
            for (const auto& block : *blocks) {
                for (int l = 0; l < Base::Packed::lanes; ++l) {
                    const int i = block.first[l];
                    const int j = block.second[l];
                    // One between domains is there twice, from each end, and counts where it is below the diagonal.
                    const bool counts = i != j && (blocks == &domain.inner || i > j);
                    if (counts && this->m_is_free[static_cast<std::size_t>(i)] &&
                        this->m_is_free[static_cast<std::size_t>(j)]) {
                        entries.emplace_back(std::max(i, j), std::min(i, j),
                                             -static_cast<float>(block.stiffness[l] + block.damping[l] / h));
                    }
                }
            }
        }
    }
    ++m_n_factorisations;
    return m_factor.factorise(static_cast<int>(this->m_mass.size()), entries);
}

} // namespace springfit
