// SPDX-License-Identifier: BSD-3-Clause
// A small network fitted to a finite element model of sixteen times its cells, whose surface it then carries.

#include <cstdio>

#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/springfit.hpp>

using namespace springfit;

namespace {

/// Bilinear weights of points in the boxes of a grid; `cgal::interpolation` does this for any mesh.
Interpolation<double> in_grid(const GridSize<2>& cells, const Vector<2, double>& size,
                              const Points<2, double>& points) {
    Interpolation<double> result;
    result.weights.resize((cells[0] + 1) * (cells[1] + 1), points.cols());
    for (Index p = 0; p < points.cols(); ++p) {
        const double x = points(0, p) / size(0) * cells[0];
        const double y = points(1, p) / size(1) * cells[1];
        const int i = std::min(static_cast<int>(x), cells[0] - 1);
        const int j = std::min(static_cast<int>(y), cells[1] - 1);
        for (const int right : {0, 1}) {
            for (const int up : {0, 1}) {
                result.weights.coeffRef(i + right + (j + up) * (cells[0] + 1), p) =
                    (right == 1 ? x - i : 1 - x + i) * (up == 1 ? y - j : 1 - y + j);
            }
        }
    }
    return result;
}

} // namespace

int main() {
    const Vector<2, double> size{0.3, 0.1}; // a sheet, m
    const auto fine = triangle_grid<double>({36, 12}, size);
    const auto coarse = triangle_grid<double>({9, 3}, size);
    const auto at_coarse = in_grid({36, 12}, size, coarse.nodes);
    const auto at_fine = in_grid({9, 3}, size, fine.nodes);

    const fem::Model reference{fine, fem::NeoHookean{.young = 1e5, .poisson = 0.3}, 1000., {.thickness = 0.01}};
    std::vector<Scenario<2, double>> pulls(4);
    for (std::size_t c = 0; c < pulls.size(); ++c) {
        pulls[c].clamps.push_back({side_nodes(fine.nodes, {0, false}, 0.), {}});
        const double angle = 1.6 * static_cast<double>(c);
        pulls[c].gravity.push_back({.acceleration = {10 * std::cos(angle), 2 * std::sin(angle)}, .amplitude = {}});
    }
    std::vector<Motion<2, double>> at_rest; // where the fine model comes to rest, as the coarse nodes see it
    const auto recordings = record_statics(reference, pulls);
    for (const auto& recording : recordings) {
        at_rest.push_back(transfer(recording.motion, at_coarse, at_fine, coarse.nodes));
    }

    auto network = springs_along_edges(coarse, {.density = 1000., .thickness = 0.01});
    network.mass = restrict_masses(at_fine, reference.masses()); // the total is kept
    network.stiffness =
        van_gelder(coarse, network.springs, {.young = 1e5, .poisson = 0.3, .thickness = 0.01}).stiffness;
    const auto error = [&] {
        const std::vector unseen{at_rest.back()};
        return motion_error(network, {replay(unseen.front())}, unseen).error;
    };
    const double before = error();
    const TrajectoryProblem<2> motions(network, {at_rest.begin(), at_rest.end() - 1});
    apply(motions, gauss_newton(motions), network);

    const auto surface = boundary_surface(fine, at_fine);
    const auto drawn = deform(surface, coarse.nodes, equilibrium(network, replay(at_rest.back())).positions);
    const Points<2, double> wanted = recordings.back().motion.positions.front()(Eigen::all, boundary_nodes(fine));
    std::printf("%lld springs for %lld triangles; error under an unseen load %.3f, by the closed form %.3f\n",
                static_cast<long long>(network.n_springs()), static_cast<long long>(fine.n_cells()), error(), before);
    std::printf("%lld points of the surface are carried along, off by %.3f of the reference's motion\n",
                static_cast<long long>(surface.n_points()),
                (drawn - wanted).norm() / (wanted - surface.rest_positions).norm());
}
