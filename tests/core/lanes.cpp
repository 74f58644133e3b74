// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "tolerance.hpp"

#include <springfit/core/lanes.hpp>

using namespace springfit;
using detail::Lanes;

namespace {

template <class S, int N>
struct Width {
    using Scalar = S;
    static constexpr int size = N;
};

/// Different numbers of both signs.
template <class L>
L numbers(int seed) {
    L result;
    for (int l = 0; l < L::size; ++l) {
        result(l) = static_cast<decltype(result.sum())>((seed + 7 * l) % 11 - 5) / 4;
    }
    return result;
}

} // namespace

#define SPRINGFIT_TEST_WIDTHS Width<double, 4>, Width<double, 8>, Width<float, 8>, Width<float, 16>

TEST_CASE_TEMPLATE("lanes compute what their numbers would", T, SPRINGFIT_TEST_WIDTHS) {
    using Scalar = typename T::Scalar;
    using L = Lanes<Scalar, T::size>;
    static_assert(sizeof(L) == T::size * sizeof(Scalar));
    static_assert(alignof(L) == alignof(Scalar));
    const L a = numbers<L>(1), b = numbers<L>(3);
    const L sum = a + b, difference = a - b, product = a * b, quotient = a / (b * b + Scalar(1)), opposite = -a;
    const L root = sqrt(a * a + Scalar(2)), less = where_less(a, b, Scalar(10), b);
    L added = a, taken = a;
    added += b;
    taken -= Scalar(3);
    Scalar total = 0;
    bool any = false;
    for (int l = 0; l < T::size; ++l) {
        CAPTURE(l);
        CHECK(sum(l) == a(l) + b(l));
        CHECK(difference(l) == a(l) - b(l));
        CHECK(product(l) == a(l) * b(l));
        CHECK(test::relative(quotient(l), a(l) / (b(l) * b(l) + 1), Scalar(1)) < test::rounding<Scalar>(4));
        CHECK(opposite(l) == -a(l));
        CHECK(test::relative(root(l), std::sqrt(a(l) * a(l) + 2), root(l)) < test::rounding<Scalar>(4));
        CHECK(less(l) == (a(l) < b(l) ? Scalar(10) : b(l)));
        CHECK(added(l) == sum(l));
        CHECK(taken(l) == a(l) - 3);
        total += a(l);
        any = any || a(l) < b(l);
    }
    CHECK(test::relative(a.sum(), total, Scalar(T::size)) < test::rounding<Scalar>());
    CHECK(any_less(a, b) == any);
    CHECK_FALSE(any_less(a, a));
    CHECK_FALSE(any_less(L(std::numeric_limits<Scalar>::quiet_NaN()), L(Scalar(1))));
}

TEST_CASE_TEMPLATE("lanes lie anywhere in an array of numbers", T, SPRINGFIT_TEST_WIDTHS) {
    using Scalar = typename T::Scalar;
    using L = Lanes<Scalar, T::size>;
    std::array<Scalar, 2 * T::size> numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<Scalar>(i);
    }
    L::at(numbers.data() + 3) += Scalar(100);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        CHECK(numbers[i] == static_cast<Scalar>(i) + (i >= 3 && i < 3 + T::size ? 100 : 0));
    }
    const auto& constant = numbers;
    CHECK(L::at(constant.data() + 1)(0) == 1);
}
