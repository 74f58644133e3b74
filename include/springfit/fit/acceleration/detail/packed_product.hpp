// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/core/lanes.hpp>
#include <springfit/core/types.hpp>

namespace springfit::detail {

/// Entries that the vectors of `packed_product` take: n, rounded up to whole lanes.
[[nodiscard]] constexpr Index packed_room(Index n) {
    return (n + 3) / 4 * 4;
}

/// y = A x for a symmetric A `[n x n]` whose lower triangle is packed column by column.
///
/// x and y have `packed_room(n)` entries; those of x behind n are 0, those of y come out with anything. Four columns at
/// a time, so that the rows below their diagonal block are read and written once: an axpy down and a dot across.
inline void packed_product(const double* a, Index n, const double* x, double* y) {
    using Four = Lanes<double, 4>;
    for (Index p = 0; p < n; p += 4) {
        Four::at(y + p) = 0.;
    }
    Index q = 0;
    for (; q + 4 <= n; q += 4) {
        const double* const c0 = a; // each column from its diagonal on
        const double* const c1 = c0 + (n - q);
        const double* const c2 = c1 + (n - q - 1);
        const double* const c3 = c2 + (n - q - 2);
        a = c3 + (n - q - 3);
        const double x0 = x[q];
        const double x1 = x[q + 1];
        const double x2 = x[q + 2];
        const double x3 = x[q + 3];
        Four own(c0[0] * x0 + c0[1] * x1 + c0[2] * x2 + c0[3] * x3, c0[1] * x0 + c1[0] * x1 + c1[1] * x2 + c1[2] * x3,
                 c0[2] * x0 + c1[1] * x1 + c2[0] * x2 + c2[1] * x3, c0[3] * x0 + c1[2] * x1 + c2[1] * x2 + c3[0] * x3);
        if (q + 5 == n) { // one row below, where four lanes would reach behind the triangle
            const Four across(c0[4], c1[3], c2[2], c3[1]);
            y[q + 4] += (across * Four::at(x + q)).sum();
            own += across * x[q + 4];
        } else if (q + 5 < n) {
            Four s0 = 0.;
            Four s1 = 0.;
            Four s2 = 0.;
            Four s3 = 0.;
            for (Index p = q + 4; p < n; p += 4) {
                const Four below = Four::at(x + p);
                const Four h0 = Four::at(c0 + (p - q));
                const Four h1 = Four::at(c1 + (p - q - 1));
                const Four h2 = Four::at(c2 + (p - q - 2));
                const Four h3 = Four::at(c3 + (p - q - 3));
                Four::at(y + p) += (h0 * x0 + h1 * x1) + (h2 * x2 + h3 * x3);
                s0 += h0 * below;
                s1 += h1 * below;
                s2 += h2 * below;
                s3 += h3 * below;
            }
            own += Four(s0.sum(), s1.sum(), s2.sum(), s3.sum());
        }
        Four::at(y + q) += own;
    }
    for (; q < n; ++q) {
        double sum = *a++ * x[q];
        for (Index p = q + 1; p < n; ++p, ++a) {
            y[p] += *a * x[q];
            sum += *a * x[p];
        }
        y[q] += sum;
    }
}

} // namespace springfit::detail
