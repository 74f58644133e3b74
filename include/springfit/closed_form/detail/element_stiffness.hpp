// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/closed_form/isotropic_solid.hpp>
#include <springfit/mesh/element.hpp>
#include <springfit/mesh/mesh.hpp>

namespace springfit::detail {

/// Stiffness of one linear finite element at rest `[Dim n_corners x Dim n_corners]`, N/m, in double:
///
///     K_ab = int lambda g_a g_b' + mu g_b g_a' + mu (g_a . g_b) P dV ,
///
/// g_a the gradient of shape function a, P the projection on the tangent plane of a membrane, else I. `constants`
/// carry the thickness. Throws InvalidArgument for an inverted cell.
template <int Dim, std::floating_point Scalar, fem::FiniteElementCell Cell>
auto element_stiffness(const Mesh<Dim, Scalar, Cell>& mesh, Index cell, const ElasticConstants<Scalar>& constants) {
    constexpr int n = Cell::n_nodes;
    constexpr int d = Cell::dimension;
    using Element = fem::Element<Cell>;
    const auto lambda = static_cast<double>(constants.lambda);
    const auto mu = static_cast<double>(constants.mu);
    const auto nodes = mesh.cell_nodes(cell);
    Eigen::Matrix<double, Dim * n, Dim * n> stiffness = Eigen::Matrix<double, Dim * n, Dim * n>::Zero();
    for (const auto& point : Element::stiffness_rule) {
        const auto slopes = Element::gradients(point.xi);
        Eigen::Matrix<double, n, d> reference;
        for (int a = 0; a < n; ++a) {
            for (int k = 0; k < d; ++k) {
                reference(a, k) = slopes[std::size_t(a)][std::size_t(k)];
            }
        }
        const Eigen::Matrix<double, Dim, d> jacobian = nodes.template cast<double>() * reference;
        const Eigen::Matrix<double, d, d> metric = jacobian.transpose() * jacobian;
        const Eigen::Matrix<double, Dim, d> dual = jacobian * metric.inverse();
        double volume = std::sqrt(metric.determinant());
        if constexpr (Dim == d) {
            volume = jacobian.determinant();
        }
        if (!(volume > 0)) {
            throw InvalidArgument("mesh", "cells of positive volume", text("cell ", cell, ", inverted or flat"));
        }
        const Eigen::Matrix<double, Dim, n> g = dual * reference.transpose();
        const Eigen::Matrix<double, Dim, Dim> plane = dual * jacobian.transpose();
        const double weight = point.weight * volume;
        for (int a = 0; a < n; ++a) {
            for (int b = 0; b < n; ++b) {
                stiffness.template block<Dim, Dim>(Dim * a, Dim * b) +=
                    weight * (lambda * g.col(a) * g.col(b).transpose() + mu * g.col(b) * g.col(a).transpose() +
                              mu * g.col(a).dot(g.col(b)) * plane);
            }
        }
    }
    return stiffness;
}

} // namespace springfit::detail
