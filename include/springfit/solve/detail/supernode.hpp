// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace springfit::detail {

/// Neighbouring columns of a Cholesky factor that have the same rows below their triangle, as one dense array.
struct Supernode {
    int width;            ///< columns
    int height;           ///< rows: those of the triangle first, then those below
    const int* rows;      ///< their numbers [height], ascending; the first `width` are those of the columns
    const double* values; ///< [height x width], column-major; above the diagonal anything
};

} // namespace springfit::detail
