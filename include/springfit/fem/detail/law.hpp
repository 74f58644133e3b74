// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/fem/detail/invariants.hpp>
#include <springfit/fem/material.hpp>

namespace springfit::fem::detail {

/// The response of a material to one deformation gradient F: its shear energy per rest volume and its volume measure
/// theta.
template <int Rows, int Cols, std::floating_point Scalar>
struct Response {
    Invariant<Rows, Cols, Scalar> shear;
    Invariant<Rows, Cols, Scalar> theta;
};

/// A scalar function of theta with its first and second derivative.
template <std::floating_point Scalar>
struct Volumetric {
    Scalar value = 0;
    Scalar first = 0;
    Scalar second = 0;
};

/// The constants of a material in its setting; `lambda` is the one of plane stress there.
template <std::floating_point Scalar>
struct Moduli {
    Scalar mu = 0;
    Scalar lambda = 0;
    bool plane_stress = false;
};

template <class M, std::floating_point Scalar>
struct Law;

/// U = lambda/2 theta^2, shared by the materials that are quadratic in a strain. In plane stress the free thickness
/// strain leaves the same form with lambda mu 2 / (lambda + 2 mu) = E nu / (1 - nu^2).
template <std::floating_point Scalar>
struct QuadraticLaw {
    Moduli<Scalar> moduli;

    template <class M>
    static Moduli<Scalar> moduli_of(const M& material, bool plane_stress) {
        return {static_cast<Scalar>(shear_modulus(material)),
                static_cast<Scalar>(plane_stress ? plane_stress_lambda(material) : lame_lambda(material)),
                plane_stress};
    }

    [[nodiscard]] Volumetric<Scalar> volumetric(Scalar theta) const {
        return {moduli.lambda / 2 * theta * theta, moduli.lambda * theta, moduli.lambda};
    }
};

template <std::floating_point Scalar>
struct Law<LinearElastic, Scalar> : QuadraticLaw<Scalar> {
    static constexpr bool frame_indifferent = false;

    template <int Order, int D>
    void evaluate(const Eigen::Matrix<Scalar, D, D>& f, Response<D, D, Scalar>& out) const {
        using Matrix = Eigen::Matrix<Scalar, D, D>;
        const Matrix strain = (f + f.transpose()) / 2 - Matrix::Identity();
        const Scalar mu = this->moduli.mu;
        out.shear.value = mu * strain.squaredNorm();
        out.theta.value = strain.trace();
        if constexpr (Order >= 1) {
            out.shear.gradient = 2 * mu * strain;
            out.theta.gradient.setIdentity();
        }
        if constexpr (Order >= 2) {
            out.shear.hessian.setZero();
            for (int i = 0; i < D; ++i) {
                for (int j = 0; j < D; ++j) {
                    out.shear.hessian(i + D * j, i + D * j) += mu;
                    out.shear.hessian(i + D * j, j + D * i) += mu;
                }
            }
            out.theta.hessian.setZero();
        }
    }
};

template <std::floating_point Scalar>
struct Law<Corotated, Scalar> : QuadraticLaw<Scalar> {
    static constexpr bool frame_indifferent = true;

    /// mu |S - I|^2 = mu |F - R|^2.
    template <int Order, int Rows, int Cols>
    void evaluate(const Eigen::Matrix<Scalar, Rows, Cols>& f, Response<Rows, Cols, Scalar>& out) const {
        const Scalar mu = this->moduli.mu;
        stretch_trace<std::max(Order, 1)>(f, out.theta);
        out.shear.gradient = 2 * mu * (f - out.theta.gradient);
        out.shear.value = mu * (f - out.theta.gradient).squaredNorm();
        if constexpr (Order >= 2) {
            out.shear.hessian = -2 * mu * out.theta.hessian;
            out.shear.hessian.diagonal().array() += 2 * mu;
        }
        out.theta.value -= Cols;
    }
};

template <std::floating_point Scalar>
struct Law<StVenantKirchhoff, Scalar> : QuadraticLaw<Scalar> {
    static constexpr bool frame_indifferent = true;

    template <int Order, int Rows, int Cols>
    void evaluate(const Eigen::Matrix<Scalar, Rows, Cols>& f, Response<Rows, Cols, Scalar>& out) const {
        const Scalar mu = this->moduli.mu;
        const Eigen::Matrix<Scalar, Cols, Cols> strain =
            (f.transpose() * f - Eigen::Matrix<Scalar, Cols, Cols>::Identity()) / 2;
        out.shear.value = mu * strain.squaredNorm();
        out.theta.value = strain.trace();
        if constexpr (Order >= 1) {
            out.shear.gradient.noalias() = 2 * mu * f * strain;
            out.theta.gradient = f;
        }
        if constexpr (Order >= 2) {
            // d(2 mu F E) = 2 mu (dF E + F sym(F'dF))
            const Eigen::Matrix<Scalar, Rows, Rows> outer = f * f.transpose();
            for (int k = 0; k < Cols; ++k) {
                for (int l = 0; l < Cols; ++l) {
                    auto block = out.shear.hessian.template block<Rows, Rows>(Rows * k, Rows * l);
                    block.noalias() = mu * f.col(l) * f.col(k).transpose();
                    block.diagonal().array() += 2 * mu * strain(k, l);
                    if (k == l) {
                        block += mu * outer;
                    }
                }
            }
            out.theta.hessian.setIdentity();
        }
    }
};

/// shear = mu/2 (I1 - d) - mu ln J, U = lambda/2 (ln J)^2. In plane stress the thickness stretch c that minimises
/// W(F, c) depends on the J of the plane alone, by mu (c^2 - 1) + lambda ln(J c) = 0; then shear = mu/2 (I1 - 2) and
/// U(J) = mu/2 (c^2 - 1) - mu ln(J c) + lambda/2 (ln J c)^2.
template <std::floating_point Scalar>
struct Law<NeoHookean, Scalar> {
    static constexpr bool frame_indifferent = true;
    Moduli<Scalar> moduli;

    static Moduli<Scalar> moduli_of(const NeoHookean& material, bool plane_stress) {
        return {static_cast<Scalar>(shear_modulus(material)), static_cast<Scalar>(lame_lambda(material)), plane_stress};
    }

    [[nodiscard]] Volumetric<Scalar> volumetric(Scalar j) const {
        const Scalar a = std::log(j);
        const Scalar lambda = moduli.lambda;
        if (!moduli.plane_stress) {
            return {lambda / 2 * a * a, lambda * a / j, lambda * (1 - a) / (j * j)};
        }
        const Scalar mu = moduli.mu;
        const Scalar b = log_thickness(a);
        const Scalar c2 = std::exp(2 * b);
        const Scalar slope = lambda * (a + b) - mu; // dU / d ln J, the thickness following
        const Scalar curvature = 2 * mu * c2 * lambda / (2 * mu * c2 + lambda);
        return {mu / 2 * std::expm1(2 * b) - mu * (a + b) + lambda / 2 * (a + b) * (a + b), slope / j,
                (curvature - slope) / (j * j)};
    }

    template <int Order, int Rows, int Cols>
    void evaluate(const Eigen::Matrix<Scalar, Rows, Cols>& f, Response<Rows, Cols, Scalar>& out) const {
        const Scalar mu = moduli.mu;
        volume_ratio<Order>(f, out.theta);
        const Scalar j = out.theta.value;
        out.shear.value = mu / 2 * (f.squaredNorm() - Cols);
        if constexpr (Order >= 1) {
            out.shear.gradient = mu * f;
        }
        if constexpr (Order >= 2) {
            out.shear.hessian.setZero();
            out.shear.hessian.diagonal().setConstant(mu);
        }
        if (!moduli.plane_stress) {
            out.shear.value -= mu * std::log(j); // NaN where inverted
            if constexpr (Order >= 1) {
                out.shear.gradient -= mu / j * out.theta.gradient;
            }
            if constexpr (Order >= 2) {
                const Eigen::Map<const Vector<Rows * Cols, Scalar>> slope(out.theta.gradient.data());
                out.shear.hessian.noalias() += (mu / (j * j) * slope) * slope.transpose();
                out.shear.hessian -= mu / j * out.theta.hessian;
            }
        }
    }

private:
    /// ln c with mu (c^2 - 1) + lambda (a + ln c) = 0, by Newton's method; NaN where there is none (strong compression
    /// of a material with nu < 0).
    [[nodiscard]] Scalar log_thickness(Scalar a) const {
        const Scalar mu = moduli.mu;
        const Scalar lambda = moduli.lambda;
        Scalar b = -lambda * a / (2 * mu + lambda);
        for (int iteration = 0; iteration < 50; ++iteration) {
            const Scalar step = (mu * std::expm1(2 * b) + lambda * (a + b)) / (2 * mu * std::exp(2 * b) + lambda);
            b -= step;
            if (std::abs(step) <= 4 * std::numeric_limits<Scalar>::epsilon() * std::max(Scalar(1), std::abs(b))) {
                return b;
            }
        }
        return std::numeric_limits<Scalar>::quiet_NaN();
    }
};

} // namespace springfit::fem::detail
