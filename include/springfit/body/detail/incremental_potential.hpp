// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <springfit/body/detail/moving_nodes.hpp>
#include <springfit/core/status.hpp>

namespace springfit {

/// How an implicit step ended.
template <std::floating_point Scalar>
struct ImplicitStepReport {
    Status status = Status::failed; ///< `iteration_limit` where the tolerance was not reached, or not looked at
    int iterations = 0;             ///< of the step's own method
    int linear_iterations = 0;      ///< conjugate gradients, all together
    Scalar unbalanced = 0;          ///< largest entry of the gradient where it was last taken, N
};

namespace detail {

/// What the steps that minimise the incremental potential share,
///
///     1/(2 h^2) |x - x_n - h v_n|_M^2 + E(x) - f_ext . x + 1/(2h) sum_e c_e (n_e . (r_e - r_e^n))^2 ,
///
/// n_e lagged: the pass over the springs, the gradient, and a step's start and end.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
class IncrementalPotential : public MovingNodes<Dim, ScalarType> {
public:
    using Scalar = ScalarType;

protected:
    using Packed = PackedSprings<Dim, Scalar>;
    using Block = typename Packed::Block;
    using Lanes = Simd<Scalar, 4>;

    /// What a pass over a domain finds out.
    struct Found {
        Scalar gradient = 0; ///< largest entries
        Scalar force = 0;
        Scalar position = 0;
        double slope = 0; ///< gradient . last direction
        bool finite = true;

        void add(const Found& other) {
            gradient = std::max(gradient, other.gradient);
            force = std::max(force, other.force);
            position = std::max(position, other.position);
            slope += other.slope;
            finite = finite && other.finite;
        }
    };

    IncrementalPotential(const SpringNetwork<Dim, Scalar>& network, const Execution& execution)
        : MovingNodes<Dim, Scalar>(network, execution), m_is_damped((network.damping.array() > 0).any()) {
        const auto n = static_cast<std::size_t>(network.n_nodes());
        m_start.resize(n);
        m_forces.resize(n);
        m_found.resize(this->m_springs.domains().size());
        m_stiffness.assign(n, 0);
        m_damping.assign(n, 0);
        for (Index e = 0; e < network.n_springs(); ++e) {
            for (int end : {0, 1}) {
                m_stiffness[this->place(network.springs(end, e))] += network.stiffness(e);
                m_damping[this->place(network.springs(end, e))] += network.damping(e);
            }
        }
    }

    /// Keeps x_n and goes to x_n + h v_n.
    void start_step(Scalar h) {
        this->for_domains([&](std::size_t, const auto& domain) {
            for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
                m_start[i] = this->m_positions[i];
                this->m_positions[i].lanes += h * this->m_velocities[i].lanes;
            }
        });
    }

    /// v = (x - x_n) / h; where that is not finite or the step has failed, `diverged`, with the body as it was.
    void finish_step(Scalar h, Status& status) {
        this->for_domains([&](std::size_t d, const auto& domain) {
            Lanes zero = {};
            for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
                zero += 0 * this->m_positions[i].lanes;
            }
            m_found[d] = {};
            m_found[d].finite = zero[0] + zero[1] + zero[2] == 0;
        });
        const bool finite = usable(status) && found().finite;
        this->for_domains([&](std::size_t, const auto& domain) {
            for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
                if (!finite) {
                    this->m_positions[i] = m_start[i];
                } else if (this->m_is_free[i]) {
                    this->m_velocities[i].lanes = (this->m_positions[i].lanes - m_start[i].lanes) / h;
                }
            }
        });
        status = finite ? status : Status::diverged;
    }

    /// x += length d.
    template <std::floating_point Real>
    void move(Scalar length, const std::vector<Four<Real>>& direction) {
        this->for_domains([&](std::size_t, const auto& domain) {
            for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
                this->m_positions[i].lanes += length * __builtin_convertvector(direction[i].lanes, Lanes);
            }
        });
    }

    /// The gradient that rounding of the positions alone makes is this times the largest of them, N/m.
    [[nodiscard]] Scalar rounding(Scalar h) const {
        Scalar stiffest = 0;
        for (std::size_t i = 0; i < m_stiffness.size(); ++i) {
            stiffest = std::max(stiffest, m_stiffness[i] + m_damping[i] / h + this->m_mass[i] / (h * h));
        }
        return std::numeric_limits<Scalar>::epsilon() * stiffest;
    }

    /// What the passes over the domains found, in their order.
    [[nodiscard]] Found found() const {
        Found all;
        for (const Found& of_domain : m_found) {
            all.add(of_domain);
        }
        return all;
    }

    /// Calls `visit(at, i, j, force, axial, c_1)` for each spring of the blocks, `at` its place in them:
    ///
    ///     force = k (1 - l/L) r + c/h (r_n . (r - r_n)) r_n / |r_n|^2    on i, the opposite on j,
    ///     c_1 = k max(1 - l/L, lowest) ,    axial = sqrt(k - c_1 + c/h) r/L .
    template <bool Damped, class Visit>
    void for_springs(const std::vector<Block>& blocks, Scalar h, Scalar lowest, const Visit& visit) const;

    /// Writes minus the gradient, f - m/h^2 (x - x_n - h v_n), of the nodes of a domain from their forces; 0 where
    /// clamped. `direction` is the last one.
    template <std::floating_point Real>
    void set_residual(const typename Packed::Domain& domain, Scalar h, std::vector<Four<Real>>& target,
                      const std::vector<Four<Real>>& direction, Found& found) const;

    bool m_is_damped;
    std::vector<Four<Scalar>> m_start;          ///< positions at the start of the step
    std::vector<Four<Scalar>> m_forces;         ///< elastic and damping forces at the positions
    std::vector<Scalar> m_stiffness, m_damping; ///< of all springs of a node, N/m and N s/m
    std::vector<Found> m_found;                 ///< by domain
};

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
template <bool Damped, class Visit>
void IncrementalPotential<Dim, ScalarType>::for_springs(const std::vector<Block>& blocks, Scalar h, Scalar lowest,
                                                        const Visit& visit) const {
    constexpr int lanes = Packed::lanes;
    using Values = detail::Lanes<Scalar, lanes>;
    constexpr Scalar tiny = std::numeric_limits<Scalar>::min();
    const Four<Scalar>* const x = this->m_positions.data();
    const Four<Scalar>* const start = m_start.data();
    const Scalar per_step = 1 / h;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const Block& block = blocks[b];
        alignas(64) Four<Scalar> r[lanes];
        alignas(64) Four<Scalar> old[lanes];
        alignas(64) Four<Scalar> change[lanes];
        alignas(64) Scalar squares[lanes], old_squares[lanes], changes[lanes];
        for (int l = 0; l < lanes; ++l) {
            const auto i = static_cast<std::size_t>(block.first[l]);
            const auto j = static_cast<std::size_t>(block.second[l]);
            r[l].lanes = x[j].lanes - x[i].lanes;
            if constexpr (Damped) {
                old[l].lanes = start[j].lanes - start[i].lanes;
                change[l].lanes = r[l].lanes - old[l].lanes;
            }
        }
        for (int l = 0; l < lanes; l += 4) {
            dot_products(r + l, r + l, squares + l);
            if constexpr (Damped) {
                dot_products(old + l, old + l, old_squares + l);
                dot_products(old + l, change + l, changes + l);
            }
        }
        const Values& k = Values::at(block.stiffness);
        const Values inverse = Scalar(1) / sqrt(Values::at(squares) + tiny);
        const Values geometric = k - Values::at(block.pull) * inverse;
        const Values least = lowest * k;
        const Values c1 = where_less(geometric, least, least, geometric);
        Values axial = k - c1;
        alignas(64) Scalar tension[lanes], drag[lanes], factors[lanes], transverse[lanes];
        if constexpr (Damped) {
            const Values damping = per_step * Values::at(block.damping);
            axial += damping;
            Values::at(drag) = damping * Values::at(changes) / (Values::at(old_squares) + tiny);
        }
        Values::at(tension) = geometric;
        Values::at(factors) = sqrt(axial) * inverse;
        Values::at(transverse) = c1;
        for (int l = 0; l < lanes; ++l) {
            Four<Scalar> force, vector;
            force.lanes = tension[l] * r[l].lanes;
            if constexpr (Damped) {
                force.lanes += drag[l] * old[l].lanes;
            }
            vector.lanes = factors[l] * r[l].lanes;
            visit(b * lanes + static_cast<std::size_t>(l), static_cast<std::size_t>(block.first[l]),
                  static_cast<std::size_t>(block.second[l]), force, vector, transverse[l]);
        }
    }
}

template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
template <std::floating_point Real>
void IncrementalPotential<Dim, ScalarType>::set_residual(const typename Packed::Domain& domain, Scalar h,
                                                         std::vector<Four<Real>>& target,
                                                         const std::vector<Four<Real>>& direction, Found& found) const {
    using RealLanes = Simd<Real, 4>;
    Lanes gradients = {}, forces = {}, positions = {}, zero = {};
    const auto raise = [](Lanes& largest, const Lanes& values) {
        const Lanes size = values < 0 ? -values : values;
        largest = size > largest ? size : largest;
    };
    for (auto i = static_cast<std::size_t>(domain.begin); i < static_cast<std::size_t>(domain.end); ++i) {
        if (!this->m_is_free[i]) {
            target[i] = {};
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
        const RealLanes converted = __builtin_convertvector(right, RealLanes);
        const RealLanes work = converted * direction[i].lanes;
        found.slope -= static_cast<double>(work[0]) + static_cast<double>(work[1]) + static_cast<double>(work[2]);
        target[i].lanes = converted;
    }
    found.finite = zero[0] + zero[1] + zero[2] == 0;
    for (int d = 0; d < Dim; ++d) {
        found.gradient = std::max(found.gradient, gradients[d]);
        found.force = std::max(found.force, forces[d]);
        found.position = std::max(found.position, positions[d]);
    }
}

} // namespace detail

} // namespace springfit
