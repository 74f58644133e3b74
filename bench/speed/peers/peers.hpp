// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <springfit/fit/acceleration/problem.hpp>
#include <springfit/network/spring_network.hpp>

/// Other programs on the very bodies and problems of the benchmarks, each in a file of its own that is built where the
/// program is installed.
namespace bench::peers {

/// Bullet's soft bodies, in the precision that the library was built for.
void add_bullet(springfit::Index springs);

/// MuJoCo: three sliding joints per node, a tendon per spring.
void add_mujoco(springfit::Index springs);

/// Sets PETSc up and takes it down; alive while its solvers are used.
class Petsc {
public:
    Petsc();
    ~Petsc();
    Petsc(const Petsc&) = delete;
    Petsc& operator=(const Petsc&) = delete;
};

/// The minimiser, and the time that finding it took where this is not all of the call.
struct Solution {
    springfit::Values<double> theta;
    double seconds = 0;
};

/// The problem in variables that suit every solver better, x = sqrt(H_uu) (theta_u - prior_u):
/// 1/2 x'Hx - g'x in a box, from x = 0. Away from 0 the value would lose the digits that line searches need.
struct ScaledProblem {
    springfit::SparseMatrix<double> hessian; ///< both triangles
    springfit::Values<double> linear, lower, upper;
    double tolerance; ///< of the entries of x - clip(x - gradient), where `kkt_residual` is the one asked for

    ScaledProblem(const springfit::AccelerationProblem& problem, double kkt_residual);

    /// The unknowns that belong to x, within their bounds.
    [[nodiscard]] springfit::Values<double> theta(const springfit::Values<double>& x) const;

private:
    springfit::Values<double> m_scale, m_prior, m_lowest, m_highest;
};

/// PETSc's toolkit TAO by the method of this name: bnls, bntr, gpcg.
[[nodiscard]] Solution tao(const ScaledProblem& problem, const std::string& method);

/// SciPy's L-BFGS-B, by a script that reads the problem from a file in a temporary folder.
[[nodiscard]] Solution scipy(const ScaledProblem& problem);

} // namespace bench::peers
