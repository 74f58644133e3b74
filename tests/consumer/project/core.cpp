// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

int main() {
    const auto mesh = springfit::tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.});
    const auto network = springfit::springs_along_edges(mesh, {.density = 1000.});
    const auto form = springfit::van_gelder(mesh, network.springs, {.young = 1e4, .poisson = 0.25});
    return form.stiffness.minCoeff() > 0 ? 0 : 1;
}
