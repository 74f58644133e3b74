// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/fem/model.hpp>

namespace springfit::fem {

/// Positions relative to the cell's first node: F does not change, its rounding shrinks.
template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
auto Model<Dim, S, Cell, Mat>::cell_points(const Points<Dim, S>& x, Index cell) const -> CellPoints {
    CellPoints points;
    const Vector<Dim, S> origin = x.col(m_mesh.cells(0, cell));
    points.col(0).setZero();
    for (int a = 1; a < n; ++a) {
        points.col(a) = x.col(m_mesh.cells(a, cell)) - origin;
    }
    return points;
}

/// The material at one point. Small strains of a membrane are taken in the rest tangent plane T: F_local = T'F.
template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
template <int Order>
void Model<Dim, S, Cell, Mat>::evaluate(Index point, const Deformation& f, PointResponse& out) const {
    if constexpr (!is_membrane || detail::Law<Mat, S>::frame_indifferent) {
        (void)point;
        m_law.template evaluate<Order>(f, out);
    } else {
        const Eigen::Map<const Deformation> frame(m_frames.col(point).data());
        detail::Response<plane, plane, S> local;
        m_law.template evaluate<Order>(Eigen::Matrix<S, plane, plane>(frame.transpose() * f), local);
        const auto lift = [&](const auto& from, auto& to) {
            to.value = from.value;
            if constexpr (Order >= 1) {
                to.gradient = frame * from.gradient;
            }
            if constexpr (Order >= 2) {
                for (int k = 0; k < plane; ++k) {
                    for (int l = 0; l < plane; ++l) {
                        to.hessian.template block<Dim, Dim>(Dim * k, Dim * l) =
                            frame * from.hessian.template block<plane, plane>(plane * k, plane * l) * frame.transpose();
                    }
                }
            }
        };
        lift(local.shear, out.shear);
        lift(local.theta, out.theta);
    }
}

/// Calls `visit(patch, share)` for the patches that the points of a cell belong to; the shares add up to 1.
template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
template <class Visit>
void Model<Dim, S, Cell, Mat>::for_patches(Index cell, const Visit& visit) const {
    if constexpr (patches_at_nodes) {
        for (int a = 0; a < n; ++a) {
            visit(Index{m_mesh.cells(a, cell)}, S(1) / n);
        }
    } else {
        visit(cell, S(1));
    }
}

/// U and its derivatives at the mean theta of each patch; empty where the dilatation is pointwise.
template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
auto Model<Dim, S, Cell, Mat>::patch_pressures(const Points<Dim, S>& x) const -> Pressures {
    Pressures pressures;
    if (!is_mean()) {
        return pressures;
    }
    Values<S> theta = Values<S>::Zero(m_patch_volumes.size());
    PointResponse response;
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const CellPoints points = cell_points(x, c);
        for (Index q = c * n_points; q < (c + 1) * n_points; ++q) {
            evaluate<0>(q, points * gradients(q), response);
            const S weighted = m_weights(q) * response.theta.value;
            for_patches(c, [&](Index patch, S share) { theta(patch) += share * weighted; });
        }
    }
    pressures.reserve(static_cast<std::size_t>(theta.size()));
    for (Index p = 0; p < theta.size(); ++p) {
        pressures.push_back(m_law.volumetric(theta(p) / m_patch_volumes(p)));
    }
    return pressures;
}

/// U' of the patches of a cell's points.
template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
S Model<Dim, S, Cell, Mat>::pressure_on(Index cell, const Pressures& pressures) const {
    S pressure = 0;
    for_patches(cell, [&](Index patch, S share) { pressure += share * pressures[std::size_t(patch)].first; });
    return pressure;
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
S Model<Dim, S, Cell, Mat>::energy(const Points<Dim, S>& x) const {
    const Pressures pressures = patch_pressures(x);
    double energy = 0;
    for (std::size_t p = 0; p < pressures.size(); ++p) {
        energy += static_cast<double>(m_patch_volumes(static_cast<Index>(p)) * pressures[p].value);
    }
    PointResponse response;
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const CellPoints points = cell_points(x, c);
        for (Index q = c * n_points; q < (c + 1) * n_points; ++q) {
            evaluate<0>(q, points * gradients(q), response);
            S density = response.shear.value;
            if (!is_mean()) {
                density += m_law.volumetric(response.theta.value).value;
            }
            energy += static_cast<double>(m_weights(q) * density);
        }
    }
    return static_cast<S>(energy);
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
Points<Dim, S> Model<Dim, S, Cell, Mat>::internal_forces(const Points<Dim, S>& x) const {
    const Pressures pressures = patch_pressures(x);
    Points<Dim, S> forces = Points<Dim, S>::Zero(Dim, m_mesh.n_nodes());
    PointResponse response;
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const CellPoints points = cell_points(x, c);
        S pressure = is_mean() ? pressure_on(c, pressures) : S(0);
        CellPoints cell_forces = CellPoints::Zero();
        for (Index q = c * n_points; q < (c + 1) * n_points; ++q) {
            const auto slopes = gradients(q);
            evaluate<1>(q, points * slopes, response);
            if (!is_mean()) {
                pressure = m_law.volumetric(response.theta.value).first;
            }
            const Deformation stress = m_weights(q) * (response.shear.gradient + pressure * response.theta.gradient);
            cell_forces.noalias() += stress * slopes.transpose();
        }
        for (int a = 0; a < n; ++a) {
            forces.col(m_mesh.cells(a, c)) += cell_forces.col(a);
        }
    }
    return forces;
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
void Model<Dim, S, Cell, Mat>::assemble(const Points<Dim, S>& x, Stiffness<Dim, S>& stiffness) const {
    using Block = Eigen::Matrix<S, Dim * n, Dim * n>;
    using CellVector = Vector<Dim * n, S>;
    const Pressures pressures = patch_pressures(x);
    stiffness.set_zero();
    PointResponse response;
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const CellPoints points = cell_points(x, c);
        detail::Volumetric<S> at_point;
        if (is_mean()) {
            at_point.first = pressure_on(c, pressures);
        }
        Block block = Block::Zero();
        CellPoints theta_slope = CellPoints::Zero();
        for (Index q = c * n_points; q < (c + 1) * n_points; ++q) {
            const auto slopes = gradients(q);
            const S weight = m_weights(q);
            evaluate<2>(q, points * slopes, response);
            auto& hessian = response.shear.hessian;
            if (is_mean()) {
                theta_slope.noalias() += weight * response.theta.gradient * slopes.transpose();
            } else {
                at_point = m_law.volumetric(response.theta.value);
                const Eigen::Map<const Vector<Dim * plane, S>> slope(response.theta.gradient.data());
                hessian.noalias() += (at_point.second * slope) * slope.transpose();
            }
            hessian += at_point.first * response.theta.hessian;
            // block += w (G x I) hessian (G x I)'
            Eigen::Matrix<S, Dim * plane, Dim * n> half;
            for (int b = 0; b < n; ++b) {
                auto columns = half.template middleCols<Dim>(Dim * b);
                columns.noalias() = (weight * slopes(b, 0)) * hessian.template leftCols<Dim>();
                for (int l = 1; l < plane; ++l) {
                    columns += (weight * slopes(b, l)) * hessian.template middleCols<Dim>(Dim * l);
                }
            }
            for (int a = 0; a < n; ++a) {
                auto rows = block.template middleRows<Dim>(Dim * a);
                for (int k = 0; k < plane; ++k) {
                    rows += slopes(a, k) * half.template middleRows<Dim>(Dim * k);
                }
            }
        }
        if (is_mean()) {
            if constexpr (patches_at_nodes) {
                stiffness.add_to_patches(c, (theta_slope / S(n)).eval());
            } else {
                const Eigen::Map<const CellVector> slope(theta_slope.data());
                block.noalias() += (pressures[std::size_t(c)].second / m_patch_volumes(c) * slope) * slope.transpose();
            }
        }
        stiffness.add_cell(c, block);
    }
    if (has_node_patches()) {
        for (Index p = 0; p < m_patch_volumes.size(); ++p) {
            stiffness.set_patch_weight(p, pressures[std::size_t(p)].second / m_patch_volumes(p));
        }
    }
}

} // namespace springfit::fem
