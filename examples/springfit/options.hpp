// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace program {

constexpr int default_nodes = 1000; ///< of a body that is meshed
constexpr const char* default_material = "neo-hookean";

/// What `springfit fit` was asked for. Values left out are chosen from the body.
struct FitOptions {
    std::vector<std::string> inputs;     ///< as given: patterns, INPUT first, recorded motions after it
    std::string input;                   ///< the first file of those
    std::vector<std::string> references; ///< recorded motions instead of the FEM
    std::string mass_from;               ///< file with the masses of the nodes; empty: they follow from the density
    std::string out;
    std::string unit = "m";      ///< of lengths in files
    std::string time_unit = "s"; ///< of times in recorded motions

    double young = 0;                    ///< Pa
    double poisson = 0;                  ///< -
    double density = 0;                  ///< kg/m^3
    std::optional<double> thickness;     ///< m, plane bodies and membranes
    std::optional<std::string> material; ///< default neo-hookean
    std::optional<std::string> element;
    std::optional<double> damping_ratio; ///< of the body's slowest motion

    std::optional<double> cell_size; ///< m
    std::optional<int> nodes;
    std::optional<int> reference_nodes; ///< of a finer mesh for the FEM; else it is on the network's mesh
    int fill_holes = 0;                 ///< holes of at most this many edges are closed
    std::vector<std::string> clamps;

    std::string method = "auto";
    std::string exact_solver = "native";
    std::string damping = "proportional";
    std::optional<double> zeta;                   ///< of `--damping ratio`
    std::optional<std::vector<double>> gravity{}; ///< of recorded motions, m/s^2
    std::string parts = "auto";
    bool second_ring = false;
    bool volume = false;               ///< cells that hold their volume, too
    std::optional<double> fit_seconds; ///< for matching motion

    std::optional<int> training_cases;
    std::optional<int> held_out_cases;
    std::optional<int> static_cases; ///< equilibria that matching of motion learns from
    std::optional<double> strain;    ///< of those
    std::optional<int> frames;
    std::optional<double> deformation; ///< largest displacement wanted, as a part of the body's size
    unsigned seed = 1;
    int threads = 0;
};

/// What `springfit simulate` was asked for.
struct SimulateOptions {
    std::string model;
    std::string out;
    std::optional<std::vector<double>> gravity; ///< m/s^2
    double duration = 2;                        ///< s
    int frames = 100;
    std::string integrator = "explicit";
    std::optional<double> time_step; ///< s
};

} // namespace program
