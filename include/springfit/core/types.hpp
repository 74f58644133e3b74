// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCore>

namespace springfit {

/// A body lives in the plane or in space.
template <int Dim>
concept SpatialDimension = (Dim == 2 || Dim == 3);

/// Sizes and loop counters. Node, cell and spring numbers in arrays are `int`.
using Index = Eigen::Index;

/// A point, displacement, velocity or force `[Dim]`.
template <int Dim, std::floating_point Scalar>
using Vector = Eigen::Matrix<Scalar, Dim, 1>;

/// One column per node `[Dim x n_nodes]`: positions in m, velocities in m/s, forces in N.
template <int Dim, std::floating_point Scalar>
using Points = Eigen::Matrix<Scalar, Dim, Eigen::Dynamic>;

/// One value per node, spring, parameter or degree of freedom `[n]`.
template <std::floating_point Scalar>
using Values = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// Dense matrix of run-time size.
template <std::floating_point Scalar>
using DenseMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Sparse matrix, column-major; symmetric ones hold their lower triangle only.
template <std::floating_point Scalar>
using SparseMatrix = Eigen::SparseMatrix<Scalar, Eigen::ColMajor, int>;

/// Pairs of node numbers `[2 x n_pairs]`: the edges of a mesh or the ends of springs.
using NodePairs = Eigen::Matrix<int, 2, Eigen::Dynamic>;

} // namespace springfit
