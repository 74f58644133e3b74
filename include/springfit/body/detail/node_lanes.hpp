// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <springfit/mesh/simplex.hpp>

namespace springfit::detail {

/// Asks for an object in memory before it is needed; it may lie beyond the end of its array.
template <class Object>
void prefetch(const Object* object) {
    for (std::size_t line = 0; line < sizeof(Object); line += 64) {
        __builtin_prefetch(reinterpret_cast<const char*>(object) + line);
    }
}

/// Stores vectors of four one after another in one instruction: a load of all right after would wait for two.
template <int Size, class Four, std::floating_point Scalar>
void concatenate(const Four* parts, Scalar* target) {
    using All = Simd<Scalar, Size>;
    if constexpr (Size == 4) {
        *reinterpret_cast<All*>(target) = parts[0];
    } else {
        static_assert(Size == 8);
        *reinterpret_cast<All*>(target) = __builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
    }
}

/// The coordinates of a vector of a node or a spring in one register, those beyond the dimension without meaning. In a
/// struct, since a template argument cannot carry the vector attribute.
template <std::floating_point Scalar>
struct Four {
    Simd<Scalar, 4> lanes = {};
};

template <std::floating_point Scalar>
Four<Scalar> cross(const Four<Scalar>& a, const Four<Scalar>& b) {
    const Simd<Scalar, 4> turned_a = __builtin_shufflevector(a.lanes, a.lanes, 1, 2, 0, 3); // (y z x -)
    const Simd<Scalar, 4> turned_b = __builtin_shufflevector(b.lanes, b.lanes, 1, 2, 0, 3);
    const Simd<Scalar, 4> c = a.lanes * turned_b - turned_a * b.lanes;
    return {__builtin_shufflevector(c, c, 1, 2, 0, 3)};
}

template <std::floating_point Scalar>
Four<Scalar> clockwise(const Four<Scalar>& a) {
    const Simd<Scalar, 4> sign = {1, -1, 0, 0};
    return {sign * __builtin_shufflevector(a.lanes, a.lanes, 1, 0, 3, 2)};
}

template <std::floating_point Scalar>
Four<Scalar> counter_clockwise(const Four<Scalar>& a) {
    return {-clockwise(a).lanes};
}

template <int Dim, std::floating_point Scalar>
Scalar dot(const Four<Scalar>& a, const Four<Scalar>& b) {
    const Simd<Scalar, 4> products = a.lanes * b.lanes;
    return Dim == 2 ? products[0] + products[1] : products[0] + products[1] + products[2];
}

/// What the step kernel keeps of a node in one load: its position and its velocity, in space (x y z - u v w -).
///
/// The difference d = (r, s) of the records of a spring's ends gives its vector and their relative velocity at once.
template <int Dim, std::floating_point Scalar>
struct NodeLanes;

template <std::floating_point Scalar>
struct NodeLanes<3, Scalar> {
    using Record = Simd<Scalar, 8>;
    using Force = Simd<Scalar, 4>; ///< (x y z -)
    static constexpr int velocity = 4;

    static void split(const Record& record, Force& position, Force& velocities) {
        position = __builtin_shufflevector(record, record, 0, 1, 2, 3);
        velocities = __builtin_shufflevector(record, record, 4, 5, 6, 7);
    }
    static void join(const Force& position, const Force& velocities, Record& record) {
        record = __builtin_shufflevector(position, velocities, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    /// The vector r of a difference.
    static void vector(const Record& d, Force& r) { r = __builtin_shufflevector(d, d, 0, 1, 2, 3); }

    /// |r|^2 and r . s of four differences.
    static void products(const Record* d, Force& squares, Force& rates) {
        Record first, last;
        add_products(d[0], d[1], first);
        add_products(d[2], d[3], last);
        const Record sums = __builtin_shufflevector(first, last, 0, 1, 8, 9, 4, 5, 12, 13) +
                            __builtin_shufflevector(first, last, 2, 3, 10, 11, 6, 7, 14, 15);
        split(sums, squares, rates);
    }

private:
    /// Half of the sums of two differences: (r_1 r_1, .) in pairs of lanes.
    static void add_products(const Record& a, const Record& b, Record& sums) {
        const Record x = __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3) * a;
        const Record y = __builtin_shufflevector(b, b, 0, 1, 2, 3, 0, 1, 2, 3) * b;
        sums = __builtin_shufflevector(x, y, 0, 8, 1, 9, 4, 12, 5, 13) +
               __builtin_shufflevector(x, y, 2, 10, 3, 11, 6, 14, 7, 15);
    }
};

/// In the plane (x y u v); forces carry two lanes that mean nothing.
template <std::floating_point Scalar>
struct NodeLanes<2, Scalar> {
    using Record = Simd<Scalar, 4>;
    using Force = Simd<Scalar, 4>;
    static constexpr int velocity = 2;

    static void split(const Record& record, Force& position, Force& velocities) {
        position = record;
        velocities = __builtin_shufflevector(record, record, 2, 3, 0, 1);
    }
    static void join(const Force& position, const Force& velocities, Record& record) {
        record = __builtin_shufflevector(position, velocities, 0, 1, 4, 5);
    }
    static void vector(const Record& d, Force& r) { r = d; }

    static void products(const Record* d, Force& squares, Force& rates) {
        Record first, last;
        add_products(d[0], d[1], first);
        add_products(d[2], d[3], last);
        squares = __builtin_shufflevector(first, last, 0, 1, 4, 5);
        rates = __builtin_shufflevector(first, last, 2, 3, 6, 7);
    }

private:
    static void add_products(const Record& a, const Record& b, Record& sums) {
        const Record x = __builtin_shufflevector(a, a, 0, 1, 0, 1) * a;
        const Record y = __builtin_shufflevector(b, b, 0, 1, 0, 1) * b;
        sums = __builtin_shufflevector(x, y, 0, 4, 2, 6) + __builtin_shufflevector(x, y, 1, 5, 3, 7);
    }
};

} // namespace springfit::detail
