// SPDX-License-Identifier: BSD-3-Clause
#include "bodies.hpp"
#include "tolerance.hpp"

using namespace springfit;

namespace {

template <class B, class M>
void check_derivatives(const M& material, double shake) {
    constexpr int dim = B::dimension;
    const auto mesh = test::box<dim, double, typename B::Cell>(2);
    for (const auto& options : test::settings<B>()) {
        const fem::Model model{mesh, material, 1., options};
        const auto x = test::shaken<dim, double>(mesh.nodes, shake, 1);
        const Points<dim, double> forces = model.internal_forces(x);
        const FreeNodes free(mesh.n_nodes(), {0, 3});
        const auto lower = model.stiffness(x, free);
        auto tangent = model.make_stiffness(free);
        model.assemble(x, tangent);
        const double h = 1e-6;
        for (unsigned seed = 2; seed < 5; ++seed) {
            Points<dim, double> direction = Points<dim, double>::Zero(dim, x.cols());
            direction = test::shaken<dim, double>(direction, 1, seed);
            direction.col(0).setZero();
            direction.col(3).setZero();
            const double slope = (model.energy(x + h * direction) - model.energy(x - h * direction)) / (2 * h);
            const double expected = forces.cwiseProduct(direction).sum();
            CHECK(test::relative(slope, expected, forces.norm() * direction.norm()) < 1e-8);

            const Points<dim, double> ahead = model.internal_forces(x + h * direction);
            const Points<dim, double> behind = model.internal_forces(x - h * direction);
            const Values<double> change = free.gather<dim, double>(Points<dim, double>((ahead - behind) / (2 * h)));
            const Values<double> along = free.gather<dim, double>(direction);
            const Values<double> product = lower.template selfadjointView<Eigen::Lower>() * along;
            CHECK((product - change).norm() < 1e-7 * change.norm());
            Values<double> same;
            tangent.matrix().multiply(along, same);
            CHECK((product - same).norm() < 1e-12 * product.norm());
        }
        CHECK((tangent.matrix().diagonal() - lower.diagonal()).norm() < 1e-12 * lower.diagonal().norm());
    }
}

} // namespace

TEST_CASE_TEMPLATE("forces and tangent are the derivatives of the energy, in every element and dilatation", B,
                   SPRINGFIT_TEST_BODIES(double)) {
    check_derivatives<B>(fem::NeoHookean{2., 0.4}, 0.05);
}

TEST_CASE_TEMPLATE("forces and tangent are the derivatives of the energy, for every material", B,
                   test::Body<2, double, Tri3>, test::Body<3, double, Tet4>, test::Body<3, double, Quad4>) {
    check_derivatives<B>(fem::LinearElastic{2., 0.4}, 0.1);
    check_derivatives<B>(fem::Corotated{2., 0.4}, 0.1);
    check_derivatives<B>(fem::StVenantKirchhoff{2., 0.4}, 0.1);
}
