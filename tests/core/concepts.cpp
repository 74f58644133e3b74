// SPDX-License-Identifier: BSD-3-Clause
// Which types are models of which concepts, and the shapes of what they hold: checked by the compiler.

#include <doctest/doctest.h>

#include <springfit/springfit.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar, class Cell>
using Body = fem::Model<Dim, Scalar, Cell, fem::NeoHookean>;

// References, and those whose equilibria can be recorded.
static_assert(Reference<SpringNetwork<2, float>> && Reference<SpringNetwork<3, double>>);
static_assert(Reference<BiquadraticNetwork<2, double>> && Reference<BiquadraticNetwork<3, double>>);
static_assert(Reference<UserReference<2, float>> && Reference<UserReference<3, double>>);
static_assert(Reference<Body<2, double, Tri3>> && Reference<Body<3, double, Tet10>> && Reference<Body<3, float, Hex8>>);
static_assert(StaticReference<SpringNetwork<3, double>> && StaticReference<Body<3, double, Tet4>>);
static_assert(!StaticReference<UserReference<3, double>>);
static_assert(!Reference<Mesh<3, double, Tet4>> && !Reference<int>);

// Steppers and solvers.
static_assert(Stepper<SymplecticEuler<2, float>> && Stepper<ImplicitEuler<3, double>>);
static_assert(Stepper<ProjectiveEuler<3, double>> && Stepper<fem::Dynamics<3, double>>);
static_assert(Stepper<UserReference<3, double>>);
static_assert(StaticSolver<fem::Statics<2, double>> && StaticSolver<NetworkStatics<3, float>>);
static_assert(!Stepper<fem::Statics<3, double>> && !Stepper<SpringNetwork<3, double>>);

// Recorders of cases.
static_assert(std::derived_from<FemRecorder<3, double>, CaseRecorder<3, double>>);
static_assert(std::derived_from<ReferenceRecorder<SpringNetwork<2, float>>, CaseRecorder<2, float>>);

// Cells.
static_assert(CellType<Tri3> && CellType<Tet10> && !CellType<int>);
static_assert(SimplexCell<Tri3> && SimplexCell<Tet4> && !SimplexCell<Quad4> && !SimplexCell<Hex8>);
static_assert(std::same_as<LinearCell<Tet10>, Tet4> && std::same_as<LinearCell<Hex8>, Hex8>);
static_assert(fem::FiniteElementCell<Quad4> && fem::Material<fem::LinearElastic> && !fem::Material<double>);
static_assert(SpatialDimension<2> && SpatialDimension<3> && !SpatialDimension<1>);

// Shapes: one column per node, per spring, per cell.
static_assert(Points<3, double>::RowsAtCompileTime == 3 && Points<3, double>::ColsAtCompileTime == Eigen::Dynamic);
static_assert(NodePairs::RowsAtCompileTime == 2);
static_assert(Values<float>::ColsAtCompileTime == 1);
static_assert(std::same_as<decltype(Mesh<2, float, Quad4>::nodes), Points<2, float>>);
static_assert(decltype(Mesh<3, double, Tet10>::cells)::RowsAtCompileTime == 10);
static_assert(std::same_as<decltype(SpringNetwork<3, float>::stiffness), Values<float>>);
static_assert(std::same_as<decltype(Motion<2, double>::positions), std::vector<Points<2, double>>>);

// What a caller gets from a call.
static_assert(std::same_as<decltype(record(std::declval<const SpringNetwork<2, float>&>(),
                                           std::declval<const Scenario<2, float>&>(), RecordOptions<float>{})),
                           Recording<2, float>>);
static_assert(std::same_as<decltype(calibrate(std::declval<const SpringNetwork<3, double>&>(),
                                              std::declval<RecordedCases<3, double>>())),
                           Calibration<3>>);

// Plain data: copied and moved freely.
static_assert(std::copyable<SpringNetwork<3, double>> && std::copyable<Calibration<2>> &&
              std::copyable<Motion<3, float>>);
static_assert(std::is_aggregate_v<SpringNetwork<2, double>> && std::is_aggregate_v<CalibrateOptions>);

} // namespace

TEST_CASE("concepts and shapes are checked while this compiles") {
    CHECK(true);
}
