// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <random>

#include <springfit/fem/detail/law.hpp>

using namespace springfit;
using namespace springfit::fem;

namespace {

/// A shape of F and a setting: plane strain, plane stress, membrane, solid.
template <int R, int C, bool Stress>
struct Setting {
    static constexpr int rows = R;
    static constexpr int cols = C;
    static constexpr bool plane_stress = Stress;
};

template <class M, class Scalar>
fem::detail::Law<M, Scalar> law_of(const M& material, bool plane_stress) {
    fem::detail::Law<M, Scalar> law;
    law.moduli = fem::detail::Law<M, Scalar>::moduli_of(material, plane_stress);
    return law;
}

/// Identity (of a membrane: the first two columns of it) plus a random change of up to `size`.
template <int R, int C>
Eigen::Matrix<double, R, C> random_deformation(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> entry(-size, size);
    Eigen::Matrix<double, R, C> f = Eigen::Matrix<double, R, C>::Identity();
    for (double& value : f.reshaped()) {
        value += entry(random);
    }
    return f;
}

/// W and its derivatives with U taken at the point.
template <class M, int R, int C>
void full_energy(const fem::detail::Law<M, double>& law, const Eigen::Matrix<double, R, C>& f,
                 fem::detail::Invariant<R, C, double>& w) {
    fem::detail::Response<R, C, double> r;
    law.template evaluate<2>(f, r);
    const auto u = law.volumetric(r.theta.value);
    w.value = r.shear.value + u.value;
    w.gradient = r.shear.gradient + u.first * r.theta.gradient;
    w.hessian = r.shear.hessian + u.first * r.theta.hessian +
                u.second * r.theta.gradient.reshaped() * r.theta.gradient.reshaped().transpose();
}

template <class M, int R, int C>
void check_derivatives(const fem::detail::Law<M, double>& law, double size) {
    std::mt19937 random(11);
    for (int trial = 0; trial < 10; ++trial) {
        const auto f = random_deformation<R, C>(random, size);
        fem::detail::Invariant<R, C, double> w;
        full_energy(law, f, w);
        Eigen::Matrix<double, R, C> gradient;
        Eigen::Matrix<double, R * C, R * C> hessian;
        const double h = 1e-5;
        for (int i = 0; i < R * C; ++i) {
            auto ahead = f;
            auto behind = f;
            ahead.reshaped()(i) += h;
            behind.reshaped()(i) -= h;
            fem::detail::Invariant<R, C, double> plus;
            fem::detail::Invariant<R, C, double> minus;
            full_energy(law, ahead, plus);
            full_energy(law, behind, minus);
            gradient.reshaped()(i) = (plus.value - minus.value) / (2 * h);
            hessian.col(i) = (plus.gradient - minus.gradient).reshaped() / (2 * h);
        }
        CHECK(test::relative_difference(w.gradient, gradient) < 1e-7);
        CHECK(test::relative_difference(w.hessian, hessian) < 1e-7);
        CHECK((w.hessian - w.hessian.transpose()).norm() <= 1e-12 * w.hessian.norm());
    }
}

} // namespace

#define SETTINGS Setting<2, 2, false>, Setting<2, 2, true>, Setting<3, 2, true>, Setting<3, 3, false>

TEST_CASE_TEMPLATE("stress and tangent are the derivatives of the energy", S, SETTINGS) {
    for (double poisson : {-0.3, 0., 0.3, 0.49}) {
        if constexpr (S::rows == S::cols) {
            check_derivatives<LinearElastic, S::rows, S::cols>(
                law_of<LinearElastic, double>({2., poisson}, S::plane_stress), 0.4);
        }
        check_derivatives<Corotated, S::rows, S::cols>(law_of<Corotated, double>({2., poisson}, S::plane_stress), 0.4);
        check_derivatives<StVenantKirchhoff, S::rows, S::cols>(
            law_of<StVenantKirchhoff, double>({2., poisson}, S::plane_stress), 0.4);
        check_derivatives<NeoHookean, S::rows, S::cols>(law_of<NeoHookean, double>({2., poisson}, S::plane_stress),
                                                        0.25);
    }
}

TEST_CASE("the polar decomposition keeps its derivatives where a cell is turned inside out") {
    const auto law = law_of<Corotated, double>({2., 0.3}, false);
    std::mt19937 random(3);
    int inverted = 0;
    for (int trial = 0; trial < 20; ++trial) {
        Eigen::Matrix3d f = random_deformation<3, 3>(random, 0.3);
        f.col(1) *= -0.6;
        inverted += f.determinant() < 0 ? 1 : 0;
        const Eigen::Matrix3d r = rotation_of<double>(f);
        CHECK((r.transpose() * r - Eigen::Matrix3d::Identity()).norm() < 1e-12);
        CHECK(r.determinant() > 0);
        fem::detail::Response<3, 3, double> at;
        law.evaluate<2>(f, at);
        const Eigen::Matrix3d direction = random_deformation<3, 3>(random, 0.5);
        const double h = 1e-6;
        fem::detail::Response<3, 3, double> plus;
        fem::detail::Response<3, 3, double> minus;
        law.evaluate<1>(Eigen::Matrix3d(f + h * direction), plus);
        law.evaluate<1>(Eigen::Matrix3d(f - h * direction), minus);
        const Eigen::Matrix3d slope = (plus.theta.gradient - minus.theta.gradient) / (2 * h);
        const Eigen::Matrix<double, 9, 1> predicted = at.theta.hessian * direction.reshaped();
        CHECK((predicted - slope.reshaped()).norm() < 1e-5 * (1 + predicted.norm()));
    }
    CHECK(inverted == 20);
}

TEST_CASE_TEMPLATE("rest is free of stress and has Hooke's tangent", S, SETTINGS) {
    constexpr int r = S::rows;
    constexpr int c = S::cols;
    const double young = 3;
    const double poisson = 0.35;
    const double mu = young / (2 * (1 + poisson));
    const double lambda =
        young * poisson / (S::plane_stress ? 1 - poisson * poisson : (1 + poisson) * (1 - 2 * poisson));
    const auto check = [&](const auto& law) {
        fem::detail::Invariant<r, c, double> w;
        const Eigen::Matrix<double, r, c> identity = Eigen::Matrix<double, r, c>::Identity();
        full_energy(law, identity, w);
        CHECK(std::abs(w.value) < 1e-15);
        CHECK(w.gradient.norm() < 1e-14);
        const auto hessian = [&](int i, int k, int j, int l) { return w.hessian(i + r * k, j + r * l); };
        CHECK(std::abs(hessian(0, 0, 0, 0) - (lambda + 2 * mu)) < 1e-13);
        CHECK(std::abs(hessian(0, 0, 1, 1) - lambda) < 1e-13);
        CHECK(std::abs(hessian(0, 1, 0, 1) - mu) < 1e-13);
        CHECK(std::abs(hessian(0, 1, 1, 0) - mu) < 1e-13);
    };
    if constexpr (r == c) {
        check(law_of<LinearElastic, double>({young, poisson}, S::plane_stress));
    }
    check(law_of<Corotated, double>({young, poisson}, S::plane_stress));
    check(law_of<StVenantKirchhoff, double>({young, poisson}, S::plane_stress));
    check(law_of<NeoHookean, double>({young, poisson}, S::plane_stress));
}

TEST_CASE_TEMPLATE("a finite rotation changes neither energy nor the size of the stress", M, Corotated,
                   StVenantKirchhoff, NeoHookean) {
    const auto law = law_of<M, double>({2., 0.4}, false);
    std::mt19937 random(7);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    const Eigen::Matrix3d f = random_deformation<3, 3>(random, 0.3);
    fem::detail::Invariant<3, 3, double> w;
    fem::detail::Invariant<3, 3, double> turned;
    full_energy(law, f, w);
    full_energy(law, Eigen::Matrix3d(turn * f), turned);
    CHECK(test::relative(turned.value, w.value, w.value) < 1e-12);
    CHECK((turned.gradient - turn * w.gradient).norm() < 1e-12 * w.gradient.norm());
}

TEST_CASE_TEMPLATE("plane stress is the solid with a thickness free of stress", M, Corotated, StVenantKirchhoff,
                   NeoHookean) {
    for (double poisson : {-0.2, 0.3, 0.49}) {
        const auto solid = law_of<M, double>({2., poisson}, false);
        const auto sheet = law_of<M, double>({2., poisson}, true);
        std::mt19937 random(9);
        const Eigen::Matrix2d f = random_deformation<2, 2>(random, 0.2);
        Eigen::Matrix3d full = Eigen::Matrix3d::Identity();
        full.topLeftCorner<2, 2>() = f;
        fem::detail::Invariant<3, 3, double> w;
        for (int iteration = 0; iteration < 30; ++iteration) {
            full_energy(solid, full, w);
            full(2, 2) -= w.gradient(2, 2) / w.hessian(8, 8);
        }
        full_energy(solid, full, w);
        fem::detail::Invariant<2, 2, double> plane;
        full_energy(sheet, f, plane);
        CHECK(test::relative(plane.value, w.value, w.value) < 1e-12);
        CHECK((plane.gradient - w.gradient.topLeftCorner<2, 2>()).norm() < 1e-12 * w.gradient.norm());
        // and the same sheet laid into space
        Eigen::Matrix<double, 3, 2> surface = Eigen::Matrix<double, 3, 2>::Zero();
        surface.topRows<2>() = f;
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
        fem::detail::Invariant<3, 2, double> membrane;
        full_energy(sheet, Eigen::Matrix<double, 3, 2>(turn * surface), membrane);
        CHECK(test::relative(membrane.value, w.value, w.value) < 1e-12);
    }
}

TEST_CASE("materials that cannot be are refused") {
    const auto message = [](const auto& material) -> std::string {
        try {
            validate(material);
        } catch (const InvalidArgument& error) {
            return error.what();
        }
        return "";
    };
    CHECK(message(NeoHookean{.young = 1., .poisson = 0.5}) == "poisson: expected a value in (-1, 0.5), found 0.5");
    CHECK(message(LinearElastic{.young = 1., .poisson = -1.}) == "poisson: expected a value in (-1, 0.5), found -1");
    CHECK(message(Corotated{.young = 0., .poisson = 0.3}) == "young: expected a positive modulus, found 0");
    CHECK(!message(Corotated{.young = std::nan(""), .poisson = 0.3}).empty());
    CHECK(!message(StVenantKirchhoff{.young = 1., .poisson = std::nan("")}).empty());
    CHECK(message(StVenantKirchhoff{.young = 1., .poisson = 0.49}).empty());
}
