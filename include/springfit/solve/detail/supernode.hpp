// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/types.hpp>

namespace springfit::detail {

/// Neighbouring columns of a Cholesky factor that have the same rows below their triangle, as one dense array.
struct Supernode {
    int width;            ///< columns
    int height;           ///< rows: those of the triangle first, then those below
    const int* rows;      ///< their numbers [height], ascending; the first `width` are those of the columns
    const double* values; ///< [height x width], column-major; above the diagonal anything
};

/// Where the supernodes of a factor lie, one after another.
struct Supernodes {
    int size = 0;
    const int* first_column = nullptr; ///< of each [size + 1]; none where each is one column
    const int* first_row = nullptr;    ///< of each in `rows` [size + 1]
    const int* first_value = nullptr;  ///< of each in `values` [size]
    const int* rows = nullptr;
    const double* values = nullptr; ///< none before the factor is found

    [[nodiscard]] int width(int s) const { return first_column ? first_column[s + 1] - first_column[s] : 1; }
    [[nodiscard]] int height(int s) const { return first_row[s + 1] - first_row[s]; }
    [[nodiscard]] Supernode operator[](int s) const {
        return {width(s), height(s), rows + first_row[s], values + first_value[s]};
    }
};

} // namespace springfit::detail
