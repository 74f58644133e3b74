// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/springfit.hpp>

int main() {
    const auto mesh = springfit::tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.});
    return springfit::edges(mesh).cols() > 0 ? 0 : 1;
}
