// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>

#include <Eigen/Core>

/// Numbers side by side that one instruction works on, by the vector types that GCC and Clang share: the compiler makes
/// AVX, SSE or scalar instructions of them, whatever it is told that the machine has. Values that do not depend on each
/// other (columns, bodies, rows, springs) stand in lanes as `Lanes`; a kernel that shuffles the coordinates of one node
/// takes `Simd` itself.
namespace springfit::detail {

template <std::floating_point Scalar, int Size>
struct SimdOf {
    typedef Scalar type __attribute__((vector_size(Size * sizeof(Scalar)))); // `using` would lose the attribute
};

/// One register, or as many as the machine needs for it. It goes in and out of functions by reference: how it goes by
/// value differs between machines, of which GCC warns (-Wpsabi).
template <std::floating_point Scalar, int Size>
using Simd = typename SimdOf<Scalar, Size>::type;

/// Arithmetic on `Size` numbers, lane by lane. A number stands for itself in every lane.
///
/// Aligned as a number is, so that it may lie anywhere in an array of numbers. One type for all formulas: of Eigen's
/// arrays each formula would be types of its own, and half a minute to compile.
template <std::floating_point Scalar, int Size>
struct Lanes {
    static constexpr int size = Size;
    Scalar lane[Size];

    Lanes() = default;
    Lanes(Scalar value) : Lanes(from(value - Register{})) {} // NOLINT(google-explicit-constructor)
    /// One number for each lane.
    template <class... Numbers>
        requires(sizeof...(Numbers) == Size && Size > 1)
    Lanes(Numbers... numbers) : lane{numbers...} {} // NOLINT(google-explicit-constructor)

    /// The numbers from an address on, as they lie there.
    static const Lanes& at(const Scalar* numbers) { return reinterpret_cast<const Lanes&>(*numbers); }
    static Lanes& at(Scalar* numbers) { return reinterpret_cast<Lanes&>(*numbers); }

    Scalar operator()(int place) const { return lane[place]; }
    Scalar& operator()(int place) { return lane[place]; }

    /// By halves: as a tree.
    [[nodiscard]] Scalar sum() const {
        if constexpr (Size == 4) {
            const auto halves =
                __builtin_shufflevector(simd(), simd(), 0, 1) + __builtin_shufflevector(simd(), simd(), 2, 3);
            return halves[0] + halves[1];
        } else {
            using Half = Lanes<Scalar, Size / 2>;
            return (Half::at(lane) + Half::at(lane + Size / 2)).sum();
        }
    }

    Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
    Lanes& operator-=(const Lanes& b) { return *this = *this - b; }

    friend Lanes operator-(const Lanes& a) { return from(-a.simd()); }
    friend Lanes operator+(const Lanes& a, const Lanes& b) { return from(a.simd() + b.simd()); }
    friend Lanes operator-(const Lanes& a, const Lanes& b) { return from(a.simd() - b.simd()); }
    friend Lanes operator*(const Lanes& a, const Lanes& b) { return from(a.simd() * b.simd()); }
    friend Lanes operator/(const Lanes& a, const Lanes& b) { return from(a.simd() / b.simd()); }

    /// In each lane `yes` where `a < b`, else `no`.
    friend Lanes where_less(const Lanes& a, const Lanes& b, const Lanes& yes, const Lanes& no) {
        return from(a.simd() < b.simd() ? yes.simd() : no.simd());
    }

    /// True where `a < b` in some lane.
    friend bool any_less(const Lanes& a, const Lanes& b) {
        bool any = false;
        for (int l = 0; l < Size; ++l) {
            any |= a(l) < b(l);
        }
        return any;
    }

    friend Lanes sqrt(const Lanes& a) {
        Lanes root; // Eigen's, since the compiler's would look for negative numbers one by one
        Eigen::Array<Scalar, Size, 1>::Map(root.lane) = Eigen::Array<Scalar, Size, 1>::Map(a.lane).sqrt();
        return root;
    }

private:
    typedef Scalar Register __attribute__((vector_size(Size * sizeof(Scalar)), aligned(sizeof(Scalar)), may_alias));

    [[nodiscard]] const Register& simd() const { return reinterpret_cast<const Register&>(lane); }
    static Lanes from(const Register& values) {
        Lanes result;
        reinterpret_cast<Register&>(result.lane) = values;
        return result;
    }
};

/// The same of single numbers, so that one formula serves both.
template <std::floating_point Scalar>
Scalar where_less(Scalar a, Scalar b, Scalar yes, Scalar no) {
    return a < b ? yes : no;
}
template <std::floating_point Scalar>
bool any_less(Scalar a, Scalar b) {
    return a < b;
}
using std::sqrt;

} // namespace springfit::detail
