// SPDX-License-Identifier: BSD-3-Clause
#include "tolerance.hpp"

#include <springfit/cases/load_cases.hpp>
#include <springfit/mesh/structured.hpp>

#include "specimens.hpp"

using namespace springfit;

namespace {

/// Rank of the rigid motions of the plane or of space at some nodes: Dim (Dim + 1) / 2 where clamping them holds a
/// body.
template <int Dim, class Scalar>
Index rigid_rank(const Points<Dim, Scalar>& x, const std::vector<int>& nodes) {
    constexpr int n = Dim * (Dim + 1) / 2;
    DenseMatrix<Scalar> modes = DenseMatrix<Scalar>::Zero(Dim * static_cast<Index>(nodes.size()), n);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
        auto rows = modes.middleRows(Dim * static_cast<Index>(a), Dim);
        rows.template leftCols<Dim>().setIdentity();
        const Vector<Dim, Scalar> r = x.col(nodes[a]);
        if constexpr (Dim == 2) {
            rows.col(2) << -r(1), r(0);
        } else {
            for (int d = 0; d < 3; ++d) {
                rows.col(3 + d) = Vector<3, Scalar>::Unit(d).cross(r);
            }
        }
    }
    Eigen::ColPivHouseholderQR<DenseMatrix<Scalar>> qr(modes);
    qr.setThreshold(Scalar(1e-3));
    return qr.rank();
}

} // namespace

TEST_CASE_TEMPLATE("the sides of a box are its layers", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto body = test::box_body<dim, Scalar>();
    const auto& x = body.rest_positions;
    for (int axis = 0; axis < dim; ++axis) {
        const auto low = side_nodes(x, {axis, false});
        const auto high = side_nodes(x, {axis, true});
        const auto half = side_nodes(x, {axis, false}, Scalar(0.5));
        CHECK(std::is_sorted(low.begin(), low.end()));
        CHECK(low.size() == high.size());
        const Scalar end = x.row(axis).maxCoeff();
        for (Index i = 0; i < x.cols(); ++i) {
            const auto has = [&](const std::vector<int>& nodes) {
                return std::binary_search(nodes.begin(), nodes.end(), static_cast<int>(i));
            };
            CHECK(has(low) == (x(axis, i) < Scalar(0.05) * end));
            CHECK(has(high) == (x(axis, i) > Scalar(0.95) * end));
            CHECK(has(half) == (x(axis, i) < Scalar(0.501) * end));
        }
        // As deep as the coordinates' rounding, wherever the body stands.
        const Points<dim, Scalar> away = x.colwise() + Vector<dim, Scalar>::Constant(Scalar(33.3));
        CHECK(side_nodes(away, {axis, true}, Scalar(0)) == high);
    }
    CHECK_THROWS_WITH_AS((void)side_nodes(x, {dim, true}),
                         text("side: expected an axis in [0, ", dim, "), found ", dim).c_str(), InvalidArgument);
    CHECK_THROWS_AS((void)side_nodes(x, {0, true}, Scalar(1)), InvalidArgument);
    CHECK_THROWS_AS((void)side_nodes(x, {0, true}, std::numeric_limits<Scalar>::quiet_NaN()), InvalidArgument);
}

TEST_CASE("a point or, in space, a line does not hold a body") {
    const auto plane = test::box_body<2, double>();
    CHECK(!holds_rigidly(plane.rest_positions, {}));
    CHECK(!holds_rigidly(plane.rest_positions, {3}));
    CHECK(!holds_rigidly(plane.rest_positions, {3, 3}));
    CHECK(holds_rigidly(plane.rest_positions, {3, 4}));
    const auto solid = test::box_body<3, double>();
    CHECK(!holds_rigidly(solid.rest_positions, {3, 4}));
    CHECK(!holds_rigidly(solid.rest_positions, {0, 1, 2, 3, 4})); // along x
    const auto far = static_cast<int>(solid.n_nodes() - 1);
    CHECK(holds_rigidly(solid.rest_positions, {0, 1, far}));
    CHECK(rigid_rank<3, double>(solid.rest_positions, {0, 1, 2, 3, 4}) == 5);
    CHECK(rigid_rank<3, double>(solid.rest_positions, {0, 1, far}) == 6);
}

TEST_CASE_TEMPLATE("clamp sets differ, hold the body and go by positions", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    auto body = test::box_body<dim, Scalar>();
    body.clamps = {{side_nodes(body.rest_positions, {0, false}), {}}};
    const int n = 9; // more than there are sides
    const auto sets = clamp_sets(body, {.training = n - 1});
    auto all = sets.training;
    all.insert(all.begin() + 1, sets.held_out);
    CHECK(all.size() == n);
    CHECK(all[0] == body.clamps[0].nodes);
    CHECK(sets.held_out == side_nodes(body.rest_positions, {0, true})); // the far end of the long body
    for (std::size_t a = 0; a < all.size(); ++a) {
        CHECK(rigid_rank<dim, Scalar>(body.rest_positions, all[a]) == dim * (dim + 1) / 2);
        CHECK(2 * static_cast<Index>(all[a].size()) <= body.n_nodes());
        for (std::size_t b = 0; b < a; ++b) {
            CHECK(all[a] != all[b]);
        }
    }
    // Other numbers, the same places.
    const auto permuted = test::renumbered(body, 5);
    const auto again = clamp_sets(permuted.body, {.training = n - 1});
    for (std::size_t s = 0; s < sets.training.size(); ++s) {
        CHECK(permuted.back(again.training[s]) == sets.training[s]);
    }
    CHECK(permuted.back(again.held_out) == sets.held_out);
    CHECK_THROWS_AS((void)clamp_sets(body, {.training = 200}), InvalidArgument);
    CHECK_THROWS_AS((void)clamp_sets(body, {.training = 0}), InvalidArgument);
    CHECK_THROWS_AS((void)clamp_sets(body, {.part = 1.}), InvalidArgument);
}

TEST_CASE("a flat sheet in space is clamped within its plane, a body without clamps somewhere") {
    auto sheet = test::sheet_body<double>();
    const auto sets = clamp_sets(sheet, {.training = 3, .part = 0.3});
    for (const auto& nodes : sets.training) {
        CHECK(holds_rigidly(sheet.rest_positions, nodes));
        CHECK(2 * static_cast<Index>(nodes.size()) <= sheet.n_nodes());
    }
    CHECK(sets.training.size() == 3);
    CHECK(sets.held_out != sets.training[0]);
    sheet.masses(2) = 0;
    CHECK_THROWS_AS((void)clamp_sets(sheet), InvalidArgument);
}

TEST_CASE_TEMPLATE("every set holds every piece of a body that is in two", T, test::Space<2, double>,
                   test::Space<3, double>) {
    constexpr int dim = T::dimension;
    const auto one = test::small_specimen<dim>();
    const auto n = one.n_nodes();
    Specimen<dim, double> two;
    two.rest_positions.resize(dim, 2 * n);
    two.rest_positions << one.rest_positions, one.rest_positions;
    two.rest_positions.row(0).tail(n).array() += 2 * one.size();
    two.masses.resize(2 * n);
    two.masses << one.masses, one.masses;
    two.edges.resize(2, 2 * one.edges.cols());
    two.edges << one.edges, one.edges.array() + static_cast<int>(n);
    for (int i = 0; i < 2 * static_cast<int>(n); ++i) {
        two.surface.push_back(i);
    }
    two.clamps = {{side_nodes(two.rest_positions, {.axis = 1}), {}}};
    const auto sets = clamp_sets(two, {.training = 3, .held_out = false});
    CHECK(sets.training.size() >= 2); // the two sides across y at least
    for (const auto& nodes : sets.training) {
        const auto middle = std::lower_bound(nodes.begin(), nodes.end(), static_cast<int>(n));
        CHECK(holds_rigidly(two.rest_positions, {nodes.begin(), middle}));
        CHECK(holds_rigidly(two.rest_positions, {middle, nodes.end()}));
    }
    CHECK(clamp_sets(two, {.training = 50, .held_out = false}).training.size() < 50);
    const auto cases = random_load_cases(two, {.training = 12, .clamps = 50});
    CHECK(cases.size() >= 12);
}
