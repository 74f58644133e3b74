// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/step/detail/incremental_potential.hpp>
#include <springfit/step/detail/triangular_factor.hpp>

namespace springfit {

template <std::floating_point Scalar>
struct ProjectiveBodyOptions {
    int max_iterations = 10;         ///< most iterations of a step, >= 1
    Scalar tolerance = Scalar(1e-4); ///< ends the iterations: largest unbalanced force relative to the largest force
                                     ///< that moves a node, > 0
};

/// A network in motion under implicit Euler, by the local-global scheme for mass-spring systems: the incremental
/// potential of `ImplicitBody` is minimised by turns over the directions d_e = l_e n_e of the springs (local) and over
/// the positions with the d_e held (global),
///
///     (M/h^2 + L) x = M/h^2 (x_n + h v_n) + J d + f_ext ,
///
/// L the graph Laplacian with the weights k_e + c_e/h, one matrix for all coordinates. It depends on h and on the
/// clamps alone: it is factorised when they change, and steps share the factor. It is above the Hessian at any
/// positions, so every iteration falls, without a line search, and the limit is the implicit step; but slowly where
/// the body turns or bends much in a step. Damping is that of `ImplicitBody`, its share in the matrix an upper bound.
///
/// An iteration is one pass over springs and two triangular solves. Their cost grows with the fill of the factor: in
/// the plane and for membranes O(n log n), in solids O(n^(4/3)) numbers; docs/springs.md says where it pays.
/// The global solve is done for the change of the positions, in single precision, which limits no result.
///
/// Nodes are numbered as in the network outside. The same bits on any number of threads; the triangular solves use
/// one. A step allocates nothing unless it factorises.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class ProjectiveBody : public detail::IncrementalPotential<Dim, ScalarType> {
public:
    using Scalar = ScalarType;

    /// At rest, free, without external forces. Throws InvalidArgument for a network or an option that cannot be used;
    /// cells with volume stiffness are none of its: their energy is not a distance to a projection on one matrix.
    explicit ProjectiveBody(const SpringNetwork<Dim, Scalar>& network,
                            const ProjectiveBodyOptions<Scalar>& options = {}, const Execution& execution = {})
        : Base(network, execution), m_options(options), m_residual(static_cast<std::size_t>(network.n_nodes())),
          m_direction(m_residual.size()) {
        require(options.max_iterations > 0, "max_iterations", "at least one", options.max_iterations);
        require(options.tolerance > 0, "tolerance", "a positive tolerance", options.tolerance);
        require(!(network.volume_stiffness.array() != 0).any(), "network", "springs alone, for the projective step",
                "cells with volume stiffness");
    }

    /// The nodes that no force moves: they go on with the velocity they have. All others are free.
    void set_clamped(const std::vector<int>& nodes) {
        m_free_before = this->m_is_free;
        this->clamp(nodes);
        if (m_free_before != this->m_is_free) {
            m_factorised_for = 0;
        }
    }

    [[nodiscard]] int n_factorisations() const { return m_n_factorisations; }
    [[nodiscard]] Index n_factor_entries() const { return m_factor.n_entries(); }

    /// One step of h, s. `diverged`, and the body as it was, where a number is not finite; `failed` where the matrix
    /// cannot be factorised.
    ImplicitStepReport<Scalar> step(Scalar h) {
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

private:
    using Base = detail::IncrementalPotential<Dim, ScalarType>;
    using Four = detail::Four<Scalar>;
    using Found = typename Base::Found;

    void iterate(Scalar h, ImplicitStepReport<Scalar>& report) {
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

    /// The local step: minus the gradient at the positions, J d and all.
    [[nodiscard]] Found evaluate(Scalar h) {
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
            this->balance(domain, h, m_residual, m_direction, this->m_found[d]);
        });
        return this->found();
    }

    [[nodiscard]] bool factorise(Scalar h) {
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

    ProjectiveBodyOptions<Scalar> m_options;
    detail::TriangularFactor m_factor;
    std::vector<detail::Four<float>> m_residual, m_direction;
    std::vector<char> m_free_before;
    Scalar m_factorised_for = 0;
    int m_n_factorisations = 0;
};

} // namespace springfit
