// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/fem/model.hpp>

namespace springfit::fem {

namespace detail {

/// dX/dxi at a point of a cell `[Dim x dimension of the cell]`, in double whatever the mesh's scalar.
template <class Cell, int Dim, std::floating_point Scalar>
Eigen::Matrix<double, Dim, Element<Cell>::dimension>
jacobian(const Eigen::Matrix<Scalar, Dim, Element<Cell>::n_nodes>& nodes,
         const std::array<double, std::size_t(Element<Cell>::dimension)>& xi) {
    using Matrix = Eigen::Matrix<double, Dim, Element<Cell>::dimension>;
    const auto gradients = Element<Cell>::gradients(xi);
    Matrix result = Matrix::Zero();
    for (int a = 0; a < Element<Cell>::n_nodes; ++a) {
        for (int d = 0; d < Element<Cell>::dimension; ++d) {
            result.col(d) += nodes.col(a).template cast<double>() * gradients[std::size_t(a)][std::size_t(d)];
        }
    }
    return result;
}

/// Ratio of rest to reference volume; of areas or lengths where the cell has a lower dimension than the space.
template <int Rows, int Cols>
double measure(const Eigen::Matrix<double, Rows, Cols>& jacobian) {
    if constexpr (Rows == Cols) {
        return jacobian.determinant();
    } else if constexpr (Cols == 1) {
        return jacobian.norm();
    } else {
        return Vector<3, double>(jacobian.col(0)).cross(Vector<3, double>(jacobian.col(1))).norm();
    }
}

} // namespace detail

template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
void validate(const Mesh<Dim, Scalar, Cell>& mesh) {
    springfit::validate(mesh);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto nodes = mesh.cell_nodes(c);
        const double size = (nodes.colwise() - nodes.col(0)).colwise().norm().maxCoeff();
        const double least = 64. * std::numeric_limits<Scalar>::epsilon() * std::pow(size, Cell::dimension);
        for (const auto& point : Element<Cell>::stiffness_rule) {
            const double ratio = detail::measure(detail::jacobian<Cell>(nodes, point.xi));
            if (!(ratio > least)) {
                throw InvalidArgument("mesh", "cells of positive volume",
                                      text(Cell::name, " ", c, ratio < -least ? " inverted" : " degenerate",
                                           " (Jacobian determinant ", ratio, ")"));
            }
        }
    }
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
Model<Dim, S, Cell, Mat>::Model(const Mesh<Dim, S, Cell>& mesh, const Mat& material, double density,
                                const ModelOptions<S>& options)
    : m_mesh(mesh), m_material(material), m_options(options), m_density(static_cast<S>(density)) {
    fem::validate(m_mesh);
    fem::validate(m_material);
    require(density > 0 && std::isfinite(density), "density", "a positive density", density);
    check_options();
    const bool plane_stress = is_membrane || (Dim == 2 && options.plane == Plane::stress);
    m_law.moduli = detail::Law<Mat, S>::moduli_of(m_material, plane_stress);
    take_rest_gradients();
    take_masses();
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
void Model<Dim, S, Cell, Mat>::check_options() const {
    const bool strain = m_options.plane == Plane::strain;
    require(m_options.thickness > 0 && std::isfinite(m_options.thickness), "thickness", "a positive thickness",
            m_options.thickness);
    require(!is_solid || m_options.thickness == 1, "thickness", "none given for a solid", m_options.thickness);
    require(Dim == 2 || !strain, "plane", "plane strain for plane bodies only", is_membrane ? "a membrane" : "a solid");
    require(!is_mean() || is_solid || (Dim == 2 && strain), "dilatation",
            "pointwise in plane stress, which does not lock", "mean");
    require(m_options.mass_damping >= 0 && std::isfinite(m_options.mass_damping), "mass_damping", "a value not below 0",
            m_options.mass_damping);
    require(m_options.stiffness_damping >= 0 && std::isfinite(m_options.stiffness_damping), "stiffness_damping",
            "a value not below 0", m_options.stiffness_damping);
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
void Model<Dim, S, Cell, Mat>::take_rest_gradients() {
    const Index points = m_mesh.n_cells() * n_points;
    const double thickness = plane == 2 ? static_cast<double>(m_options.thickness) : 1.;
    m_gradients.resize(Eigen::NoChange, points);
    m_weights.resize(points);
    m_frames.resize(Eigen::NoChange, is_membrane ? points : 0);
    m_patch_volumes.setZero(is_mean() ? (patches_at_nodes ? m_mesh.n_nodes() : m_mesh.n_cells()) : 0);
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const auto nodes = m_mesh.cell_nodes(c);
        for (int k = 0; k < n_points; ++k) {
            const auto& point = Element<Cell>::stiffness_rule[std::size_t(k)];
            const Index q = c * n_points + k;
            const Eigen::Matrix<double, Dim, plane> j = detail::jacobian<Cell>(nodes, point.xi);
            Eigen::Matrix<double, plane, plane> local;
            if constexpr (is_membrane) {
                Eigen::Matrix<double, Dim, plane> frame;
                frame.col(0) = j.col(0).normalized();
                frame.col(1) = (j.col(1) - frame.col(0).dot(j.col(1)) * frame.col(0)).normalized();
                local = frame.transpose() * j;
                Eigen::Map<Deformation>(m_frames.col(q).data()) = frame.template cast<S>();
            } else {
                local = j;
            }
            const Eigen::Matrix<double, plane, plane> inverse = local.inverse();
            const auto reference = Element<Cell>::gradients(point.xi);
            for (int a = 0; a < n; ++a) {
                for (int d = 0; d < plane; ++d) {
                    double slope = 0;
                    for (int r = 0; r < plane; ++r) {
                        slope += reference[std::size_t(a)][std::size_t(r)] * inverse(r, d);
                    }
                    m_gradients(a + n * d, q) = static_cast<S>(slope);
                }
            }
            m_weights(q) = static_cast<S>(point.weight * local.determinant() * thickness);
            if (is_mean()) {
                for_patches(c, [&](Index patch, S share) { m_patch_volumes(patch) += share * m_weights(q); });
            }
        }
    }
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
template <class Visit>
void Model<Dim, S, Cell, Mat>::for_mass_points(const Visit& visit) const {
    const double thickness = plane == 2 ? static_cast<double>(m_options.thickness) : 1.;
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        const auto nodes = m_mesh.cell_nodes(c);
        for (const auto& point : Element<Cell>::mass_rule) {
            const auto values = Element<Cell>::values(point.xi);
            const double volume = point.weight * detail::measure(detail::jacobian<Cell>(nodes, point.xi)) * thickness;
            visit(c, Vector<n, double>(values.data()), volume);
        }
    }
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
void Model<Dim, S, Cell, Mat>::take_masses() {
    const double density = m_density;
    Eigen::Matrix<double, n, Eigen::Dynamic> sums = Eigen::Matrix<double, n, Eigen::Dynamic>::Zero(n, m_mesh.n_cells());
    Values<double> totals = Values<double>::Zero(m_mesh.n_cells());
    for_mass_points([&](Index cell, const Vector<n, double>& shape, double volume) {
        sums.col(cell) += density * volume * (n == Cell::n_corners ? shape : shape.cwiseAbs2().eval());
        totals(cell) += density * volume;
    });
    Values<double> masses = Values<double>::Zero(m_mesh.n_nodes());
    for (Index c = 0; c < m_mesh.n_cells(); ++c) {
        for (int a = 0; a < n; ++a) {
            masses(m_mesh.cells(a, c)) += sums(a, c) * totals(c) / sums.col(c).sum();
        }
    }
    m_masses = masses.template cast<S>();
}

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
SparseMatrix<S> Model<Dim, S, Cell, Mat>::consistent_mass(const FreeNodes& free) const {
    BlockMatrix<Dim, S> mass(free, cliques_of(m_mesh.cells));
    for_mass_points([&](Index cell, const Vector<n, double>& shape, double volume) {
        Eigen::Matrix<S, Dim * n, Dim * n> block = Eigen::Matrix<S, Dim * n, Dim * n>::Zero();
        for (int b = 0; b < n; ++b) {
            for (int a = 0; a < n; ++a) {
                block.template block<Dim, Dim>(Dim * a, Dim * b)
                    .diagonal()
                    .setConstant(static_cast<S>(m_density * volume * shape(a) * shape(b)));
            }
        }
        mass.add(cell, block);
    });
    return mass.matrix();
}

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

template <int Dim, std::floating_point S, FiniteElementCell Cell, Material Mat>
    requires SpatialDimension<Dim>
auto Model<Dim, S, Cell, Mat>::preconditioner() const -> std::unique_ptr<const ElasticBody<Dim, S>> {
    Mat material = m_material;
    material.poisson = std::min(material.poisson, decltype(material.poisson)(0.4));
    ModelOptions<S> options = m_options;
    options.dilatation = Dilatation::pointwise;
    return std::make_unique<Model>(m_mesh, material, m_density, options);
}

} // namespace springfit::fem
