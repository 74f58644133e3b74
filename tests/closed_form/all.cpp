// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/closed_form/all.hpp>
#include <springfit/mesh/structured.hpp>

using namespace springfit;

namespace {

/// The names of the forms, after a check of what they hold.
template <int Dim, class Cell>
std::string names(const Mesh<Dim, double, Cell>& mesh, bool braced = true) {
    auto network = springs_along_edges(mesh, {.diagonals = braced});
    std::string result;
    for (const auto& [name, form] : closed_forms(mesh, network.springs, {.young = 1, .poisson = 0.3})) {
        CHECK(form.stiffness.sum() > 0);
        CHECK(form.caveat != "");
        apply(form, network);
        validate(network);
        result += name + " ";
    }
    return result;
}

} // namespace

TEST_CASE("the forms that hold for a mesh, the most common one first") {
    const auto triangles = triangle_grid<double>({2, 2}, {1., 1.});
    const std::string of_triangles = "van_gelder van_gelder_nu projection lloyd natsupakpong ";
    CHECK(names(triangles) == of_triangles);
    CHECK(names(quadratic(triangles)) == of_triangles);
    CHECK(names(membrane(triangles)) == of_triangles);
    CHECK(names(tetrahedron_grid<double>({1, 1, 1}, {1., 1., 1.})) == "van_gelder projection lloyd natsupakpong ");

    auto quads = quad_grid<double>({2, 2}, {1., 1.});
    CHECK(names(quads) == "baudet lloyd natsupakpong ");
    CHECK(names(membrane(quads)) == "baudet natsupakpong ");
    CHECK(names(quads, false) == "");
    CHECK(names(quad_grid<double>({2, 2}, {1., 2.})) == "baudet natsupakpong ");
    jitter(quads, 0.1, 1);
    CHECK(names(quads) == "natsupakpong ");

    auto hexes = hex_grid<double>({2, 2, 2}, {1., 1., 1.});
    CHECK(names(hexes) == "cubic_cell baudet san_vicente natsupakpong ");
    CHECK(names(hex_grid<double>({1, 1, 1}, {1., 1., 1.1})) == "cubic_cell baudet natsupakpong ");
    jitter(hexes, 0.1, 1);
    CHECK(names(hexes) == "natsupakpong ");
}

TEST_CASE("materials out of range and inverted cells are refused, not left out") {
    auto mesh = triangle_grid<double>({2, 2}, {1., 1.});
    const auto springs = edges(mesh);
    CHECK_THROWS_AS((void)closed_forms(mesh, springs, {.young = 1, .poisson = 0.5}), InvalidArgument);
    mesh.cells.col(1).reverseInPlace();
    CHECK_THROWS_AS((void)closed_forms(mesh, springs, {.young = 1, .poisson = 0.3}), InvalidArgument);
}
