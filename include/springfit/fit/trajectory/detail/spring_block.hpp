// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <springfit/fit/trajectory/parameters.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/solve/column_lanes.hpp>

/// The forces of a network and their derivatives for several motions of it at once: all blocks are over all nodes
/// `[Dim * n_nodes x n_columns]`, one column per motion.
namespace springfit::detail {

/// Adds `force` to node i and takes it from node j.
template <int Dim>
void add_pair(ColumnBlock& forces, int i, int j, Index column, const LaneVector<Dim>& force) {
    for (int d = 0; d < Dim; ++d) {
        lanes(forces, Dim * i + d, column) += force[d];
        lanes(forces, Dim * j + d, column) -= force[d];
    }
}

/// Length and direction of a spring in each lane.
template <int Dim>
struct SpringLanes {
    LaneVector<Dim> n;
    ColumnLanes length;
    ColumnLanes inverse_length;

    SpringLanes(const ColumnBlock& positions, int i, int j, Index column)
        : n(difference<Dim>(positions, j, i, column)) {
        length = sqrt(dot<Dim>(n, n));
        inverse_length = where_less(0, length, 1 / length, 0);
        n = scaled<Dim>(inverse_length, n);
    }
};

/// Signed volume of a cell and its gradient at the corners 1 to Dim (that at corner 0 is minus their sum), or both
/// along a displacement of the corners.
template <int Dim>
struct CellLanes {
    std::array<LaneVector<Dim>, Dim> sides;
    std::array<LaneVector<Dim>, Dim> gradient;
    ColumnLanes volume;

    template <class Corners>
    CellLanes(const ColumnBlock& positions, const Corners& corners, Index column) {
        for (int a = 0; a < Dim; ++a) {
            sides[a] = difference<Dim>(positions, corners(a + 1), corners(0), column);
        }
        volume = share * spanned_volume<Dim>(sides, gradient);
        for (auto& by_side : gradient) {
            by_side = scaled<Dim>(share, by_side);
        }
    }

    /// How the gradient changes when the sides change by `moved`.
    [[nodiscard]] std::array<LaneVector<Dim>, Dim> gradient_along(const std::array<LaneVector<Dim>, Dim>& moved) const {
        auto change = spanned_gradient_along<Dim>(sides, moved);
        for (auto& by_side : change) {
            by_side = scaled<Dim>(share, by_side);
        }
        return change;
    }

    /// The change of the volume when the sides change by `moved`.
    [[nodiscard]] ColumnLanes volume_along(const std::array<LaneVector<Dim>, Dim>& moved) const {
        ColumnLanes sum = dot<Dim>(gradient[0], moved[0]);
        for (int a = 1; a < Dim; ++a) {
            sum += dot<Dim>(gradient[a], moved[a]);
        }
        return sum;
    }

private:
    static constexpr double share = simplex_share<Dim, double>;
};

/// The sides of a cell in a block of displacements.
template <int Dim, class Corners>
std::array<LaneVector<Dim>, Dim> sides_of(const ColumnBlock& block, const Corners& corners, Index column) {
    std::array<LaneVector<Dim>, Dim> sides;
    for (int a = 0; a < Dim; ++a) {
        sides[a] = difference<Dim>(block, corners(a + 1), corners(0), column);
    }
    return sides;
}

/// Adds `factor * v_a` at corner a of a cell, and minus the sum of them at corner 0.
template <int Dim, class Corners>
void add_cell(ColumnBlock& forces, const Corners& corners, Index column, const ColumnLanes& factor,
              const std::array<LaneVector<Dim>, Dim>& v) {
    for (int a = 0; a < Dim; ++a) {
        add_pair<Dim>(forces, corners(a + 1), corners(0), column, scaled<Dim>(factor, v[a]));
    }
}

/// Calls `body(e, i, j, column, spring)` for the lanes of all columns and for all springs e from node i to node j.
template <int Dim, class Body>
void for_springs(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions, const Body& body) {
    for (Index column = 0; column < positions.cols(); column += block_lanes) {
        for (Index e = 0; e < network.n_springs(); ++e) {
            const int i = network.springs(0, e);
            const int j = network.springs(1, e);
            body(e, i, j, column, SpringLanes<Dim>(positions, i, j, column));
        }
    }
}

/// Calls `body(c, corners, column, cell)` for the lanes of all columns and for all volume cells.
template <int Dim, class Body>
void for_cells(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions, const Body& body) {
    for (Index column = 0; column < positions.cols(); column += block_lanes) {
        for (Index c = 0; c < network.n_cells(); ++c) {
            const auto corners = network.cells.col(c);
            body(c, corners, column, CellLanes<Dim>(positions, corners, column));
        }
    }
}

/// Elastic energy of each column [n_columns], J.
template <int Dim>
Eigen::ArrayXd elastic_energy(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions) {
    Eigen::ArrayXd energy = Eigen::ArrayXd::Zero(positions.cols()); // twice
    for_springs<Dim>(network, positions, [&](Index e, int, int, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes strain = spring.length - network.rest_length(e);
        lanes(energy, column) += network.stiffness(e) * (strain * strain);
    });
    for_cells<Dim>(network, positions, [&](Index c, const auto&, Index column, const CellLanes<Dim>& cell) {
        const ColumnLanes strain = cell.volume - network.rest_volume(c);
        lanes(energy, column) += network.volume_stiffness(c) / network.rest_volume(c) * (strain * strain);
    });
    for (Index column = 0; column < energy.size(); column += block_lanes) {
        lanes(energy, column) = lanes(energy, column) / 2;
    }
    return energy;
}

/// forces += minus the gradient of the elastic energy, N.
template <int Dim>
void add_elastic_forces(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions, ColumnBlock& forces) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes tension = network.stiffness(e) * (spring.length - network.rest_length(e));
        add_pair<Dim>(forces, i, j, column, scaled<Dim>(tension, spring.n));
    });
    for_cells<Dim>(network, positions, [&](Index c, const auto& corners, Index column, const CellLanes<Dim>& cell) {
        const ColumnLanes pressure = network.volume_stiffness(c) * (1 - cell.volume / network.rest_volume(c));
        add_cell<Dim>(forces, corners, column, pressure, cell.gradient);
    });
}

/// product += K(positions) direction, K the Hessian of the elastic energy, exact or made positive semidefinite as
/// `add_stiffness` does.
template <int Dim>
void add_stiffness_product(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions,
                           HessianForm curvature, const ColumnBlock& direction, ColumnBlock& product) {
    const bool exact = curvature == HessianForm::exact;
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const auto moved = difference<Dim>(direction, j, i, column);
        ColumnLanes across = network.stiffness(e) * (1 - network.rest_length(e) * spring.inverse_length);
        if (!exact) {
            across = where_less(across, 0, 0, across);
        }
        const ColumnLanes along = (network.stiffness(e) - across) * dot<Dim>(spring.n, moved);
        LaneVector<Dim> force;
        for (int d = 0; d < Dim; ++d) {
            force[d] = along * spring.n[d] + across * moved[d];
        }
        add_pair<Dim>(product, j, i, column, force);
    });
    for_cells<Dim>(network, positions, [&](Index c, const auto& corners, Index column, const CellLanes<Dim>& cell) {
        if (!exact && !(network.volume_stiffness(c) > 0)) {
            return;
        }
        const auto moved = sides_of<Dim>(direction, corners, column);
        const double modulus = network.volume_stiffness(c) / network.rest_volume(c);
        add_cell<Dim>(product, corners, column, modulus * cell.volume_along(moved), cell.gradient);
        if (exact) {
            add_cell<Dim>(product, corners, column, modulus * (cell.volume - network.rest_volume(c)),
                          cell.gradient_along(moved));
        }
    });
}

/// product += factor * D direction, D = sum c_e n_e n_e' with n_e at `positions`.
template <int Dim>
void add_damping_product(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions, double factor,
                         const ColumnBlock& direction, ColumnBlock& product) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes rate = dot<Dim>(spring.n, difference<Dim>(direction, j, i, column));
        add_pair<Dim>(product, j, i, column, scaled<Dim>(factor * network.damping(e) * rate, spring.n));
    });
}

/// derivative += d(test . D(positions) rates) / d(positions), by the directions of the springs.
template <int Dim>
void add_damping_derivative(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions,
                            const ColumnBlock& rates, const ColumnBlock& test, double factor, ColumnBlock& derivative) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const auto rate = difference<Dim>(rates, j, i, column);
        const auto tested = difference<Dim>(test, j, i, column);
        const ColumnLanes rate_along = dot<Dim>(spring.n, rate);
        const ColumnLanes test_along = dot<Dim>(spring.n, tested);
        const ColumnLanes scale = factor * network.damping(e) * spring.inverse_length;
        LaneVector<Dim> change; // of the spring's vector r
        for (int d = 0; d < Dim; ++d) {
            change[d] =
                scale * (tested[d] * rate_along + rate[d] * test_along - 2 * rate_along * test_along * spring.n[d]);
        }
        add_pair<Dim>(derivative, j, i, column, change);
    });
}

/// forces += the change of the elastic forces with the network's stiffness, rest length and volume stiffness.
template <int Dim>
void add_parameter_forces(const SpringNetwork<Dim, double>& network, const NetworkValues& change,
                          const ColumnBlock& positions, ColumnBlock& forces) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes tension = change.stiffness(e) * (spring.length - network.rest_length(e)) -
                                    network.stiffness(e) * change.rest_length(e);
        add_pair<Dim>(forces, i, j, column, scaled<Dim>(tension, spring.n));
    });
    for_cells<Dim>(network, positions, [&](Index c, const auto& corners, Index column, const CellLanes<Dim>& cell) {
        const ColumnLanes pressure = change.volume_stiffness(c) * (1 - cell.volume / network.rest_volume(c));
        add_cell<Dim>(forces, corners, column, pressure, cell.gradient);
    });
}

/// derivative += d(test . elastic forces) / d(stiffness, rest length, volume stiffness), summed over the columns: the
/// transpose of `add_parameter_forces`.
template <int Dim>
void add_parameter_derivative(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions,
                              const ColumnBlock& test, NetworkValues& derivative) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes along = dot<Dim>(spring.n, difference<Dim>(test, i, j, column));
        derivative.stiffness(e) += (along * (spring.length - network.rest_length(e))).sum();
        derivative.rest_length(e) -= network.stiffness(e) * along.sum();
    });
    for_cells<Dim>(network, positions, [&](Index c, const auto& corners, Index column, const CellLanes<Dim>& cell) {
        const ColumnLanes along = cell.volume_along(sides_of<Dim>(test, corners, column));
        derivative.volume_stiffness(c) += (along * (1 - cell.volume / network.rest_volume(c))).sum();
    });
}

/// forces += the change of the damping forces -D rates with c; n_e at `positions`.
template <int Dim>
void add_damping_parameter_forces(const SpringNetwork<Dim, double>& network, const NetworkValues& change,
                                  const ColumnBlock& positions, const ColumnBlock& rates, ColumnBlock& forces) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes rate = dot<Dim>(spring.n, difference<Dim>(rates, j, i, column));
        add_pair<Dim>(forces, i, j, column, scaled<Dim>(change.damping(e) * rate, spring.n));
    });
}

/// derivative += d(test . -D rates) / dc, summed over the columns.
template <int Dim>
void add_damping_parameter_derivative(const SpringNetwork<Dim, double>& network, const ColumnBlock& positions,
                                      const ColumnBlock& rates, const ColumnBlock& test, NetworkValues& derivative) {
    for_springs<Dim>(network, positions, [&](Index e, int i, int j, Index column, const SpringLanes<Dim>& spring) {
        const ColumnLanes rate = dot<Dim>(spring.n, difference<Dim>(rates, j, i, column));
        const ColumnLanes along = dot<Dim>(spring.n, difference<Dim>(test, i, j, column));
        derivative.damping(e) += (rate * along).sum();
    });
}

} // namespace springfit::detail
