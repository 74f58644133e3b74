// SPDX-License-Identifier: BSD-3-Clause
#include "../network/biquadratic_example.hpp"
#include "tolerance.hpp"

#include <springfit/closed_form/delingette.hpp>
#include <springfit/fem/model.hpp>
#include <springfit/network/biquadratic_forces.hpp>

using namespace springfit;

TEST_CASE_TEMPLATE("biquadratic springs are the St Venant-Kirchhoff finite elements at every deformation", T,
                   test::Space<2, double>, test::Space<3, double>, test::Space<3, float>) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto mesh = test::triangles<dim, Scalar>();
    const Scalar h = Scalar(0.02);
    for (const bool plane_strain : {false, true}) {
        for (const double nu : {-0.2, 0., 0.45}) {
            if (plane_strain && dim == 3) {
                continue;
            }
            auto network = biquadratic_network(mesh, {.density = Scalar(1), .thickness = h});
            apply(delingette(mesh, {.young = 300, .poisson = nu, .thickness = h, .plane_strain = plane_strain}),
                  network);
            fem::ModelOptions<Scalar> options;
            options.thickness = h;
            options.plane = plane_strain ? fem::Plane::strain : fem::Plane::stress;
            const fem::Model model{mesh, fem::StVenantKirchhoff{.young = 300, .poisson = nu}, 1., options};
            CHECK(test::relative_difference(network.mass, model.masses()) < test::rounding<Scalar>());
            for (unsigned seed = 1; seed < 5; ++seed) {
                const auto x = test::moved<dim, Scalar>(mesh.nodes, Scalar(0.15), seed);
                const Scalar energy = elastic_energy<dim, Scalar>(network, x);
                CHECK(test::relative(energy, model.energy(x), energy) < test::rounding<Scalar>());
                Points<dim, Scalar> forces = Points<dim, Scalar>::Zero(dim, x.cols());
                add_elastic_forces<dim, Scalar>(network, x, forces);
                CHECK(test::relative_difference(-forces, model.internal_forces(x)) < test::rounding<Scalar>());
                const FreeNodes free(x.cols(), {1});
                auto matrix = network_matrix(network, free);
                add_stiffness<dim, Scalar>(network, x, HessianForm::exact, matrix);
                CHECK(test::relative_difference(DenseMatrix<Scalar>(matrix.matrix()),
                                                DenseMatrix<Scalar>(model.stiffness(x, free))) <
                      test::rounding<Scalar>());
            }
        }
    }
}

TEST_CASE("materials and networks that do not fit are refused") {
    const auto mesh = test::triangles<2, double>();
    CHECK_THROWS_AS((void)delingette(mesh, {.young = 1, .poisson = 0.5}), InvalidArgument);
    CHECK_THROWS_AS((void)delingette(membrane(mesh), {.young = 1, .poisson = 0.3, .plane_strain = true}),
                    InvalidArgument);
    auto other = biquadratic_network(test::triangles<2, double>(2));
    CHECK_THROWS_AS(apply(delingette(mesh, {.young = 1, .poisson = 0.3}), other), InvalidArgument);
}
