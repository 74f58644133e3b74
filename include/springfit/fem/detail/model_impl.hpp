// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/fem/model.hpp>
#include <springfit/mesh/detail/measure.hpp>

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

} // namespace detail

template <int Dim, std::floating_point Scalar, FiniteElementCell Cell>
void validate(const Mesh<Dim, Scalar, Cell>& mesh) {
    springfit::validate(mesh);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        const auto nodes = mesh.cell_nodes(c);
        const double size = (nodes.colwise() - nodes.col(0)).colwise().norm().maxCoeff();
        const double least = 64. * std::numeric_limits<Scalar>::epsilon() * std::pow(size, Cell::dimension);
        for (const auto& point : Element<Cell>::stiffness_rule) {
            const double ratio = springfit::detail::measure(detail::jacobian<Cell>(nodes, point.xi));
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
            const double volume =
                point.weight * springfit::detail::measure(detail::jacobian<Cell>(nodes, point.xi)) * thickness;
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
