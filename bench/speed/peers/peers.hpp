// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <springfit/fit/problem.hpp>
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

/// The problem in the variables x = sqrt(H_uu) theta_u, which suit every solver better: 1/2 x'Hx - g'x in a box.
struct ScaledProblem {
    springfit::SparseMatrix<double> hessian; ///< both triangles
    springfit::Values<double> linear, lower, upper, start;
    springfit::Values<double> scale; ///< theta = x / scale

    explicit ScaledProblem(const springfit::FitProblem& problem);
};

/// PETSc's toolkit TAO by the method of this name: bnls, bntr, gpcg.
/// `tolerance`: of the gradient's projection onto the box, relative to the largest entry of g.
[[nodiscard]] Solution tao(const ScaledProblem& problem, const std::string& method, double tolerance);

/// SciPy's L-BFGS-B, by a script that reads the problem from a file in a temporary folder.
[[nodiscard]] Solution scipy(const ScaledProblem& problem, double tolerance);

} // namespace bench::peers
