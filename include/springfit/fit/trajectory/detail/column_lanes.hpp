// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/solve/block_cholesky.hpp>

namespace springfit::detail {

/// The same row of `block_lanes` columns side by side: arithmetic on each. A number stands for itself in every lane.
///
/// One type for all formulas: of Eigen's arrays each formula would be types of its own, and half a minute to compile.
struct ColumnLanes {
    double lane[block_lanes];

    ColumnLanes() = default;
    ColumnLanes(double value) : lane{value, value, value, value} {}

    double operator()(int column) const { return lane[column]; }

    [[nodiscard]] double sum() const {
        const auto halves =
            __builtin_shufflevector(simd(), simd(), 0, 1) + __builtin_shufflevector(simd(), simd(), 2, 3);
        return halves[0] + halves[1];
    }

    ColumnLanes& operator+=(const ColumnLanes& b) { return *this = *this + b; }
    ColumnLanes& operator-=(const ColumnLanes& b) { return *this = *this - b; }

    friend ColumnLanes operator-(const ColumnLanes& a) { return from(-a.simd()); }
    friend ColumnLanes operator+(const ColumnLanes& a, const ColumnLanes& b) { return from(a.simd() + b.simd()); }
    friend ColumnLanes operator-(const ColumnLanes& a, const ColumnLanes& b) { return from(a.simd() - b.simd()); }
    friend ColumnLanes operator*(const ColumnLanes& a, const ColumnLanes& b) { return from(a.simd() * b.simd()); }
    friend ColumnLanes operator/(const ColumnLanes& a, const ColumnLanes& b) { return from(a.simd() / b.simd()); }

    /// In each lane `yes` where `a < b`, else `no`.
    friend ColumnLanes where_less(const ColumnLanes& a, const ColumnLanes& b, const ColumnLanes& yes,
                                  const ColumnLanes& no) {
        return from(a.simd() < b.simd() ? yes.simd() : no.simd());
    }

    friend ColumnLanes sqrt(const ColumnLanes& a) {
        ColumnLanes root;
        Eigen::Array4d::Map(root.lane) = Eigen::Array4d::Map(a.lane).sqrt();
        return root;
    }

private:
    /// Of two instructions where the machine has no longer vectors; `using` would lose the attributes.
    typedef double Four __attribute__((vector_size(block_lanes * sizeof(double)), aligned(sizeof(double))));

    [[nodiscard]] const Four& simd() const { return reinterpret_cast<const Four&>(lane); }
    static ColumnLanes from(const Four& values) {
        ColumnLanes result;
        reinterpret_cast<Four&>(result.lane) = values;
        return result;
    }
};

[[nodiscard]] inline bool any_less(const ColumnLanes& a, const ColumnLanes& b) {
    bool any = false;
    for (int c = 0; c < block_lanes; ++c) {
        any |= a(c) < b(c);
    }
    return any;
}

/// The lanes of a row of a block from a column on, a multiple of `block_lanes`.
inline const ColumnLanes& lanes(const ColumnBlock& block, Index row, Index column) {
    return reinterpret_cast<const ColumnLanes&>(block.data()[row * block.cols() + column]);
}

inline ColumnLanes& lanes(ColumnBlock& block, Index row, Index column) {
    return reinterpret_cast<ColumnLanes&>(block.data()[row * block.cols() + column]);
}

/// The same of values of the columns.
inline const ColumnLanes& lanes(const Eigen::ArrayXd& values, Index column) {
    return reinterpret_cast<const ColumnLanes&>(values.data()[column]);
}

inline ColumnLanes& lanes(Eigen::ArrayXd& values, Index column) {
    return reinterpret_cast<ColumnLanes&>(values.data()[column]);
}

/// Calls `body(row, column)` for all lanes of a block.
template <class Body>
void for_lanes(const ColumnBlock& block, const Body& body) {
    for (Index row = 0; row < block.rows(); ++row) {
        for (Index column = 0; column < block.cols(); column += block_lanes) {
            body(row, column);
        }
    }
}

} // namespace springfit::detail
