// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/body/detail/node_lanes.hpp>
#include <springfit/mesh/simplex.hpp>

using namespace springfit;

namespace {

template <int Dim, class Scalar>
using Matrix = Eigen::Matrix<Scalar, Dim, Dim>;

/// As an array of columns of another type of vector; `make(column)` makes one.
template <class Vec, int Dim, class Scalar, class Make>
std::array<Vec, Dim> columns_of(const Matrix<Dim, Scalar>& matrix, const Make& make) {
    std::array<Vec, Dim> columns;
    for (int a = 0; a < Dim; ++a) {
        columns[static_cast<std::size_t>(a)] = make(Vector<Dim, Scalar>(matrix.col(a)));
    }
    return columns;
}

/// What the kernel finds for each kind of vector: `value` and `gradient` of numbers, of lanes (in lane `lane`) and of
/// the registers of the real-time bodies.
template <int Dim, class Scalar>
struct Found {
    Scalar value;
    Matrix<Dim, Scalar> gradient;
};

template <int Dim, class Scalar>
Found<Dim, Scalar> by_numbers(const Matrix<Dim, Scalar>& sides) {
    Found<Dim, Scalar> found;
    std::array<Vector<Dim, Scalar>, Dim> gradient;
    const auto same = [](const Vector<Dim, Scalar>& v) { return v; };
    found.value = detail::spanned_volume<Dim>(columns_of<Vector<Dim, Scalar>, Dim, Scalar>(sides, same), gradient);
    for (int a = 0; a < Dim; ++a) {
        found.gradient.col(a) = gradient[static_cast<std::size_t>(a)];
    }
    return found;
}

template <int Dim, class Scalar>
Found<Dim, Scalar> by_lanes(const Matrix<Dim, Scalar>& sides, int lane) {
    using L = detail::Lanes<Scalar, 8>;
    using Vec = std::array<L, Dim>;
    Found<Dim, Scalar> found;
    std::array<Vec, Dim> gradient;
    const auto fill = [&](const Vector<Dim, Scalar>& v) {
        Vec lanes;
        for (int d = 0; d < Dim; ++d) {
            lanes[static_cast<std::size_t>(d)] = Scalar(d + 1); // the other lanes hold something else
            lanes[static_cast<std::size_t>(d)](lane) = v(d);
        }
        return lanes;
    };
    found.value = detail::spanned_volume<Dim>(columns_of<Vec, Dim, Scalar>(sides, fill), gradient)(lane);
    for (int a = 0; a < Dim; ++a) {
        for (int d = 0; d < Dim; ++d) {
            found.gradient(d, a) = gradient[static_cast<std::size_t>(a)][static_cast<std::size_t>(d)](lane);
        }
    }
    return found;
}

template <int Dim, class Scalar>
Found<Dim, Scalar> by_registers(const Matrix<Dim, Scalar>& sides) {
    using Four = detail::Four<Scalar>;
    Found<Dim, Scalar> found;
    std::array<Four, Dim> gradient;
    const auto fill = [](const Vector<Dim, Scalar>& v) {
        Four four;
        four.lanes = detail::Simd<Scalar, 4>{7, 7, 7, 7}; // beyond the dimension without meaning
        for (int d = 0; d < Dim; ++d) {
            four.lanes[d] = v(d);
        }
        return four;
    };
    found.value = detail::spanned_volume<Dim>(columns_of<Four, Dim, Scalar>(sides, fill), gradient);
    for (int a = 0; a < Dim; ++a) {
        for (int d = 0; d < Dim; ++d) {
            found.gradient(d, a) = gradient[static_cast<std::size_t>(a)].lanes[d];
        }
    }
    return found;
}

} // namespace

TEST_CASE_TEMPLATE("the volume that sides span is their determinant, its gradient the cofactors", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    for (int sample = 0; sample < 20; ++sample) {
        CAPTURE(sample);
        const Matrix<dim, Scalar> sides = Matrix<dim, Scalar>::Random();
        const Matrix<dim, Scalar> cofactors = sides.determinant() * sides.inverse().transpose();
        for (const auto& found : {by_numbers<dim, Scalar>(sides), by_lanes<dim, Scalar>(sides, sample % 8),
                                  by_registers<dim, Scalar>(sides)}) {
            CHECK(test::relative(found.value, sides.determinant(), Scalar(1)) < test::rounding<Scalar>(20));
            CHECK((found.gradient - cofactors).norm() < test::rounding<Scalar>(1000));
        }
    }
}

TEST_CASE_TEMPLATE("the volume of a simplex of 45 degrees, its gradient adds up to 0, and turns inside out", T,
                   SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    SimplexCorners<dim, Scalar> corners = SimplexCorners<dim, Scalar>::Constant(Scalar(0.5));
    corners.template rightCols<dim>() += 2 * Matrix<dim, Scalar>::Identity();
    const Scalar volume = dim == 2 ? Scalar(4) / 2 : Scalar(8) / 6;
    CHECK(test::relative(signed_volume<dim, Scalar>(corners), volume, volume) < test::rounding<Scalar>(10));
    CHECK(volume_gradient<dim, Scalar>(corners).rowwise().sum().norm() < test::rounding<Scalar>(10));
    CHECK(test::relative((volume_gradient<dim, Scalar>(corners).cwiseProduct(corners)).sum(), dim * volume, volume) <
          test::rounding<Scalar>(20)); // homogeneous of degree Dim
    corners.col(0).swap(corners.col(1));
    CHECK(test::relative(signed_volume<dim, Scalar>(corners), -volume, volume) < test::rounding<Scalar>(10));
}

TEST_CASE_TEMPLATE("the change of the gradient is its derivative", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    using Vec = Vector<dim, Scalar>;
    std::array<Vec, dim> sides, moved, ahead, behind, after, before;
    const Scalar h = Scalar(0.25); // the gradient is at most quadratic: central differences are exact
    for (std::size_t a = 0; a < dim; ++a) {
        sides[a] = Vec::Random();
        moved[a] = Vec::Random();
        ahead[a] = sides[a] + h * moved[a];
        behind[a] = sides[a] - h * moved[a];
    }
    (void)detail::spanned_volume<dim>(ahead, after);
    (void)detail::spanned_volume<dim>(behind, before);
    const auto change = detail::spanned_gradient_along<dim>(sides, moved);
    for (std::size_t a = 0; a < dim; ++a) {
        CHECK(((after[a] - before[a]) / (2 * h) - change[a]).norm() < test::rounding<Scalar>(100));
    }
}
