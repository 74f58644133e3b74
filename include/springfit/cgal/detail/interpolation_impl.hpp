// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cgal/interpolation.hpp>
#include <springfit/cgal/location.hpp>

namespace springfit::cgal {

template <int Dim, std::floating_point Scalar, CellType Cell>
Interpolation<Scalar> interpolation(const Mesh<Dim, Scalar, Cell>& mesh, const Points<Dim, Scalar>& points,
                                    Scalar max_distance) {
    require(max_distance >= 0, "max_distance", "a length not below 0", max_distance);
    const Locator locator(mesh);
    const Scalar farthest = max_distance > 0 ? max_distance : locator.diameter() / 10;
    std::vector<Eigen::Triplet<Scalar>> entries;
    const auto add = [&](Index target, const auto& nodes, const auto& weights) {
        const Scalar negligible = 10 * std::numeric_limits<Scalar>::epsilon();
        Scalar kept = 0;
        for (Index a = 0; a < weights.size(); ++a) {
            kept += std::abs(weights(a)) > negligible ? weights(a) : Scalar(0);
        }
        for (Index a = 0; a < weights.size(); ++a) {
            if (std::abs(weights(a)) > negligible) {
                entries.emplace_back(nodes(a), static_cast<int>(target), weights(a) / kept);
            }
        }
    };
    for (Index target = 0; target < points.cols(); ++target) {
        const Vector<Dim, Scalar> point = points.col(target);
        if (const auto inside = locator.cell_at(point)) {
            add(target, mesh.cells.col(inside->cell), inside->weights);
        } else {
            const auto place = locator.nearest(point);
            if (!(place.distance <= farthest)) {
                throw InvalidArgument("points", text("points at most ", farthest, " m from the mesh"),
                                      text("point ", target, " at ", place.distance, " m"));
            }
            add(target, place.nodes, place.weights);
        }
    }
    Interpolation<Scalar> result;
    result.weights.resize(mesh.n_nodes(), points.cols());
    result.weights.setFromTriplets(entries.begin(), entries.end());
    return result;
}

} // namespace springfit::cgal
