// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/mesh/pieces.hpp>

using namespace springfit;

TEST_CASE("pieces are what pairs connect, the largest first") {
    NodePairs pairs(2, 4);
    pairs << 0, 1, 5, 6, //
        1, 2, 4, 5;
    CHECK(pieces(8, pairs) == std::vector<Index>{3, 3, 1, 1});
    CHECK(pieces(2, NodePairs(2, 0)) == std::vector<Index>{1, 1});
    pairs(0, 0) = 8;
    CHECK_THROWS_AS((void)pieces(8, pairs), InvalidArgument);
}

TEST_CASE_TEMPLATE("points that coincide are counted, in any unit", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    Points<dim, Scalar> points(dim, 30);
    for (Index i = 0; i < 30; ++i) {
        for (int d = 0; d < dim; ++d) {
            points(d, i) = static_cast<Scalar>((7 * i * i + 3 * i * (d + 1)) % 31);
        }
    }
    points.col(29).setConstant(40); // none of the others
    CHECK(n_coinciding<dim, Scalar>(points) == 0);
    points.col(4) = points.col(11);
    points.col(20) = points.col(11);
    points(0, 20) += Scalar(1e-6); // closer than a millionth of the size
    CHECK(n_coinciding<dim, Scalar>(points) == 3);
    CHECK(n_coinciding<dim, Scalar>(Scalar(1e-9) * points) == 3);
    CHECK(n_coinciding<dim, Scalar>(Points<dim, Scalar>::Zero(dim, 2)) == 2);
}

TEST_CASE("nodes of one piece have one number") {
    NodePairs pairs(2, 3);
    pairs << 4, 1, 3, //
        2, 4, 5;
    const auto piece = piece_of_nodes(6, pairs); // 0 | 1 4 2 | 3 5
    CHECK(piece[1] == piece[2]);
    CHECK(piece[1] == piece[4]);
    CHECK(piece[3] == piece[5]);
    CHECK(piece[0] != piece[1]);
    CHECK(piece[0] != piece[3]);
    CHECK(piece[1] != piece[3]);
}
