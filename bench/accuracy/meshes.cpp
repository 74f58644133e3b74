// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <iostream>
#include <numbers>
#include <numeric>
#include <random>

#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>

#include "study.hpp"

#ifdef SPRINGFIT_STUDY_COMPILED_CGAL
#include <springfit/cgal/interpolation.hpp>
#include <springfit/cgal/tetrahedralize.hpp>
#include <springfit/cgal/triangulate.hpp>
#endif

namespace study {

using namespace springfit;

Mesh<3, double, Tet4> random_cut_box(const std::array<int, 3>& cells, const std::array<double, 3>& size,
                                     unsigned seed) {
    auto hexahedra = hex_grid<double>(cells, {size[0], size[1], size[2]});
    jitter(hexahedra, 0.2, seed);
    // Hexahedra are cut from the corner of the lowest number: numbers at random make cuts at random that fit together.
    std::vector<int> number(static_cast<std::size_t>(hexahedra.n_nodes()));
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 random(seed);
    std::shuffle(number.begin(), number.end(), random);
    Mesh<3, double, Hex8> renumbered = hexahedra;
    for (Index i = 0; i < hexahedra.n_nodes(); ++i) {
        renumbered.nodes.col(number[static_cast<std::size_t>(i)]) = hexahedra.nodes.col(i);
    }
    for (int& node : renumbered.cells.reshaped()) {
        node = number[static_cast<std::size_t>(node)];
    }
    SpringOptions<double> options;
    options.volume = true;
    const auto network = springs_along_edges(renumbered, options);
    return {renumbered.nodes, network.cells};
}

#ifdef SPRINGFIT_STUDY_COMPILED_CGAL

Mesh<2, double, Tri3> rectangle_mesh(double length, double height, Index n_nodes) {
    cgal::Outline outline;
    outline.points.resize(2, 4);
    outline.points << 0, length, length, 0, 0, 0, height, height;
    outline.segments.resize(2, 4);
    outline.segments << 0, 1, 2, 3, 1, 2, 3, 0;
    return cgal::triangulate<double>(outline, {.n_nodes = n_nodes});
}

Mesh<2, double, Tri3> perforated_rectangle(double length, double height, double radius, Index n_nodes) {
    constexpr int n_round = 40;
    cgal::Outline outline;
    outline.points.resize(2, 4 + n_round);
    outline.segments.resize(2, 4 + n_round);
    outline.points.leftCols(4) << 0, length, length, 0, 0, 0, height, height;
    outline.segments.leftCols(4) << 0, 1, 2, 3, 1, 2, 3, 0;
    for (int i = 0; i < n_round; ++i) {
        const double angle = 2 * std::numbers::pi * i / n_round;
        outline.points.col(4 + i) << length / 2 + radius * std::cos(angle), height / 2 + radius * std::sin(angle);
        outline.segments.col(4 + i) << 4 + i, 4 + (i + 1) % n_round;
    }
    outline.holes.resize(2, 1);
    outline.holes << length / 2, height / 2;
    return cgal::triangulate<double>(outline, {.n_nodes = n_nodes});
}

namespace {

cgal::Surface box_surface(const std::array<double, 3>& size) {
    cgal::Surface surface;
    surface.nodes.resize(3, 8);
    for (int i = 0; i < 8; ++i) {
        surface.nodes.col(i) << ((i & 1) != 0 ? size[0] : 0.), ((i & 2) != 0 ? size[1] : 0.),
            ((i & 4) != 0 ? size[2] : 0.);
    }
    surface.cells.resize(3, 12);
    surface.cells << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1, //
        2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,              //
        3, 1, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
    return surface;
}

} // namespace

Mesh<3, double, Tet4> box_mesh(const std::array<double, 3>& size, Index n_nodes) {
    return cgal::tetrahedralize<double>(box_surface(size), {.n_nodes = n_nodes});
}

std::optional<Mesh<3, double, Tet4>> two_boxes_mesh(const std::array<double, 3>& size, double apart, Index n_nodes) {
    auto surface = box_surface(size);
    const auto one = surface;
    surface.nodes.conservativeResize(3, 2 * one.nodes.cols());
    surface.cells.conservativeResize(3, 2 * one.cells.cols());
    surface.nodes.rightCols(one.nodes.cols()) = one.nodes.colwise() + Vector<3, double>(size[0] + apart, 0, 0);
    surface.cells.rightCols(one.cells.cols()) = one.cells.array() + static_cast<int>(one.nodes.cols());
    return cgal::tetrahedralize<double>(surface, {.n_nodes = n_nodes});
}

std::optional<Mesh<3, double, Tet4>> ring_mesh(double radius, double section, Index n_nodes) {
    constexpr int around = 48, across = 8;
    cgal::Surface surface;
    surface.nodes.resize(3, around * across);
    surface.cells.resize(3, 2 * around * across);
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double turn = 2 * std::numbers::pi * i / around;
            const double angle = 2 * std::numbers::pi * j / across;
            const double away = radius + section * std::cos(angle);
            const int node = across * i + j;
            surface.nodes.col(node) << away * std::cos(turn), away * std::sin(turn), section * std::sin(angle);
            const int next = across * ((i + 1) % around);
            const int beside = (j + 1) % across;
            surface.cells.col(2 * node) << node, next + j, next + beside;
            surface.cells.col(2 * node + 1) << node, next + beside, across * i + beside;
        }
    }
    return cgal::tetrahedralize<double>(surface, {.n_nodes = n_nodes});
}

std::optional<Mesh<3, double, Tet4>> solid_mesh(const std::filesystem::path& path, Index n_nodes) {
    try {
        return cgal::tetrahedralize<double>(path, {.n_nodes = n_nodes});
    } catch (const std::exception& error) {
        std::cout << "  " << path.filename().string() << " is skipped: " << error.what() << std::endl;
        return {};
    }
}

std::optional<Interpolation<double>> interpolation_at(const Mesh<3, double, Tet4>& mesh,
                                                      const Points<3, double>& points) {
    return cgal::interpolation(mesh, points);
}

#else

Mesh<2, double, Tri3> perforated_rectangle(double length, double height, double /*radius*/, Index n_nodes) {
    return rectangle_mesh(length, height, n_nodes);
}

Mesh<2, double, Tri3> rectangle_mesh(double length, double height, Index n_nodes) {
    const double cell = std::sqrt(length * height / static_cast<double>(n_nodes));
    const auto along = [&](double extent) { return std::max(1, static_cast<int>(std::lround(extent / cell))); };
    auto mesh = triangle_grid<double>({along(length), along(height)}, {length, height});
    jitter(mesh, 0.3, 1u);
    return mesh;
}

Mesh<3, double, Tet4> box_mesh(const std::array<double, 3>& size, Index n_nodes) {
    const double cell = std::cbrt(size[0] * size[1] * size[2] / (0.6 * static_cast<double>(n_nodes)));
    const auto along = [&](double extent) { return std::max(1, static_cast<int>(std::lround(extent / cell))); };
    return random_cut_box({along(size[0]), along(size[1]), along(size[2])}, size, 1);
}

std::optional<Mesh<3, double, Tet4>> two_boxes_mesh(const std::array<double, 3>&, double, Index) {
    return {};
}

std::optional<Mesh<3, double, Tet4>> ring_mesh(double, double, Index) {
    return {};
}

std::optional<Mesh<3, double, Tet4>> solid_mesh(const std::filesystem::path& path, Index) {
    std::cout << "  " << path.filename().string() << " is skipped: built without CGAL" << std::endl;
    return {};
}

std::optional<Interpolation<double>> interpolation_at(const Mesh<3, double, Tet4>&, const Points<3, double>&) {
    return {};
}

#endif

} // namespace study
