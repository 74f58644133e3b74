// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <petsctao.h>

#include "peers.hpp"

namespace bench::peers {

namespace {

/// PETSc's own error number as an exception.
void check(PetscErrorCode error) {
    if (error != 0) {
        throw std::runtime_error("PETSc error " + std::to_string(static_cast<int>(error)));
    }
}

/// A vector of PETSc that sees the values in place.
Vec in_place(const springfit::Values<double>& values) {
    Vec result;
    check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(values.size()), values.data(), &result));
    return result;
}

/// Value 1/2 x'Hx - g'x and gradient Hx - g.
struct Quadratic {
    Mat hessian;
    Vec linear;
};

PetscErrorCode value_and_gradient(Tao, Vec x, PetscReal* value, Vec gradient, void* context) {
    const auto& quadratic = *static_cast<const Quadratic*>(context);
    PetscReal product = 0;
    PetscReal slope = 0;
    PetscCall(MatMult(quadratic.hessian, x, gradient));
    PetscCall(VecDot(x, gradient, &product));
    PetscCall(VecDot(x, quadratic.linear, &slope));
    PetscCall(VecAXPY(gradient, -1, quadratic.linear));
    *value = product / 2 - slope;
    return static_cast<PetscErrorCode>(0);
}

PetscErrorCode constant_hessian(Tao, Vec, Mat, Mat, void*) {
    return static_cast<PetscErrorCode>(0);
}

/// Ends where the projected gradient is nowhere above the problem's tolerance; TAO's own test sums over all unknowns.
PetscErrorCode is_converged(Tao solver, void* context) {
    const auto& problem = *static_cast<const ScaledProblem*>(context);
    PetscCall(TaoDefaultConvergenceTest(solver, nullptr));
    Vec x = nullptr;
    Vec gradient = nullptr;
    PetscCall(TaoGetSolution(solver, &x));
    PetscCall(TaoGetGradient(solver, &gradient, nullptr, nullptr));
    const PetscScalar* values = nullptr;
    const PetscScalar* slopes = nullptr;
    PetscCall(VecGetArrayRead(x, &values));
    PetscCall(VecGetArrayRead(gradient, &slopes));
    double largest = 0;
    for (springfit::Index u = 0; u < problem.linear.size(); ++u) {
        const double moved = std::min(std::max(values[u] - slopes[u], problem.lower(u)), problem.upper(u));
        largest = std::max(largest, std::abs(values[u] - moved));
    }
    PetscCall(VecRestoreArrayRead(x, &values));
    PetscCall(VecRestoreArrayRead(gradient, &slopes));
    if (largest <= problem.tolerance) {
        PetscCall(TaoSetConvergedReason(solver, TAO_CONVERGED_USER));
    }
    return static_cast<PetscErrorCode>(0);
}

} // namespace

Petsc::Petsc() {
    check(PetscInitializeNoArguments());
    check(PetscOptionsSetValue(nullptr, "-tao_bnk_pc_type", "icc")); // 2 to 3 times as fast as its default
}

Petsc::~Petsc() {
    PetscFinalize();
}

Solution tao(const ScaledProblem& problem, const std::string& method) {
    const auto n = static_cast<PetscInt>(problem.linear.size());
    const auto& h = problem.hessian;
    // A symmetric matrix has the same rows as columns; PETSc only reads the arrays.
    Quadratic quadratic{};
    check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, const_cast<int*>(h.outerIndexPtr()),
                                    const_cast<int*>(h.innerIndexPtr()), const_cast<double*>(h.valuePtr()),
                                    &quadratic.hessian));
    check(MatSetOption(quadratic.hessian, MAT_SYMMETRIC, PETSC_TRUE));
    check(MatSetOption(quadratic.hessian, MAT_SPD, PETSC_TRUE));
    quadratic.linear = in_place(problem.linear);
    const springfit::Values<double> lowest = problem.lower.cwiseMax(double(PETSC_NINFINITY));
    const springfit::Values<double> highest = problem.upper.cwiseMin(double(PETSC_INFINITY));
    const springfit::Values<double> solution = springfit::Values<double>::Zero(n);
    Vec x = in_place(solution);
    Vec lower = in_place(lowest);
    Vec upper = in_place(highest);

    Tao solver;
    check(TaoCreate(PETSC_COMM_SELF, &solver));
    check(TaoSetType(solver, method.c_str()));
    check(TaoSetSolution(solver, x));
    check(TaoSetObjectiveAndGradient(solver, nullptr, value_and_gradient, &quadratic));
    check(TaoSetHessian(solver, quadratic.hessian, quadratic.hessian, constant_hessian, nullptr));
    check(TaoSetVariableBounds(solver, lower, upper));
    check(TaoSetTolerances(solver, 0, 0, 0));
    check(TaoSetConvergenceTest(solver, is_converged, const_cast<ScaledProblem*>(&problem)));
    check(TaoSetMaximumIterations(solver, 500));
    check(TaoSetFromOptions(solver));
    check(TaoSolve(solver));
    check(TaoDestroy(&solver));
    for (Vec* vector : {&x, &lower, &upper, &quadratic.linear}) {
        check(VecDestroy(vector));
    }
    check(MatDestroy(&quadratic.hessian));
    return {problem.theta(solution)};
}

} // namespace bench::peers
