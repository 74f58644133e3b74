// SPDX-License-Identifier: BSD-3-Clause
// The command-line program: `springfit fit` and `springfit simulate`.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include <CLI/CLI.hpp>

#ifdef SPRINGFIT_PROGRAM_CHOLMOD
#include <springfit/cholmod/supernodal_factor.hpp>
#endif
#include <springfit/core/error.hpp>
#include <springfit/core/version.hpp>

#include "commands.hpp"
#include "interrupt.hpp"

namespace {

/// CLI11 does not know std::optional here: an option that keeps whether it was given.
template <class Value>
CLI::Option* add_optional(CLI::App& app, const std::string& name, std::optional<Value>& target,
                          const std::string& help) {
    return app.add_option_function<Value>(name, [&target](const Value& value) { target = value; }, help);
}

void declare_fit(CLI::App& app, program::FitOptions& options) {
    app.add_option("INPUT", options.inputs,
                   "closed surface (.off .obj .stl .ply), outline (.poly .wkt), mesh (.msh .mesh .node .vtk), or a "
                   "recorded motion (.xdmf .h5); after it more recorded motions of the same nodes, patterns "
                   "(\"motion_*.h5\"), too")
        ->required();
    app.add_option("--young", options.young, "Young's modulus, Pa")->required();
    app.add_option("--poisson", options.poisson, "Poisson's ratio, in (-1, 0.5)")->required();
    app.add_option("--density", options.density, "density, kg/m^3")->required();
    app.add_option("--out", options.out,
                   "folder for model.json, report.json, motion.h5, motion.xdmf; with "
                   "--reference-nodes surface.h5, surface.xdmf, too")
        ->required();

    const std::string reference = "Reference simulation";
    add_optional(app, "--material", options.material, "material of the FEM reference (default neo-hookean)")
        ->check(CLI::IsMember({"linear", "corotated", "st-venant-kirchhoff", "neo-hookean"}))
        ->group(reference);
    add_optional(
        app, "--element", options.element,
        "tet4-mean-dilatation, tet4 or tet10; hex8; tri3 or tri6; quad4 (default: the first that fits the cells)")
        ->check(CLI::IsMember({"tet4", "tet4-mean-dilatation", "tet10", "hex8", "tri3", "tri6", "quad4"}))
        ->group(reference);
    add_optional(app, "--thickness", options.thickness, "thickness of a plane body or membrane, m (default 1)")
        ->group(reference);
    add_optional(
        app, "--damping-ratio", options.damping_ratio,
        "damping of the body's slowest motion, as a part of critical (default: of the FEM so light that it takes "
        "a quarter of the explicit step, of recordings found with the fit)")
        ->group(reference);
    app.add_option("--reference", options.references,
                   "recorded motion of the same nodes (.xdmf .h5), in place of the FEM; may be given several times")
        ->group(reference);

    app.add_option(
           "--mass-from", options.mass_from,
           "file with the masses of the nodes, kg: a model.json, or HDF5 with /mesh/mass (default: by --density)")
        ->group(reference);
    app.add_option_function<std::vector<double>>(
           "--gravity", [&options](const std::vector<double>& g) { options.gravity = g; },
           "acceleration that acted on the whole body in recorded motions, m/s^2, where their forces do not have it "
           "(0,0,-9.81; default none)")
        ->delimiter(',')
        ->group(reference);

    app.add_option("--time-unit", options.time_unit, "unit of times in recorded motions")
        ->check(CLI::IsMember({"s", "ms", "us"}))
        ->capture_default_str()
        ->group(reference);

    const std::string mesh = "Mesh";
    app.add_option("--unit", options.unit, "unit of lengths in INPUT and recorded motions; --cell-size is in it, too")
        ->check(CLI::IsMember({"m", "cm", "mm", "um", "inch"}))
        ->capture_default_str()
        ->group(mesh);
    auto* cell_size = add_optional(app, "--cell-size", options.cell_size, "size of the cells, m")->group(mesh);
    add_optional(app, "--nodes", options.nodes, "number of nodes to aim at (default 1000)")
        ->excludes(cell_size)
        ->group(mesh);
    add_optional(
        app, "--reference-nodes", options.reference_nodes,
        "nodes of a finer mesh for the FEM, more than --nodes; its surface is carried by the network (default: the "
        "network's own mesh)")
        ->group(mesh);
    app.add_option("--fill-holes", options.fill_holes,
                   "close holes of the surface of at most this many edges (default none)")
        ->group(mesh);

    const std::string cases = "Load cases";
    app.add_option(
           "--clamp", options.clamps,
           "side of the bounding box whose nodes are held, as y-min or x-max:0.1 (the part of the box's extent; "
           "default 0.05); may be given several times (default y-min)")
        ->group(cases);
    add_optional(app, "--training-cases", options.training_cases, "load cases the fit sees (default 6)")->group(cases);
    add_optional(app, "--held-out-cases", options.held_out_cases, "load cases it never sees (default 3)")->group(cases);
    add_optional(app, "--static-cases", options.static_cases,
                 "equilibria, under three clamps, that matching of motion learns from (default 36)")
        ->group(cases);
    add_optional(
        app, "--strain", options.strain,
        "strain that the loads of every second one, and of those that judge, aim at (default 0.05; linear: 0.001)")
        ->group(cases);
    add_optional(app, "--frames", options.frames, "frames of each recorded motion (default 32)")->group(cases);
    add_optional(app, "--deformation", options.deformation,
                 "displacement the loads in time aim at, as a part of the body's size (default 0.05, less where the "
                 "strain is above "
                 "that of --strain)")
        ->group(cases);
    app.add_option("--seed", options.seed, "seed of everything random")->capture_default_str()->group(cases);

    const std::string fit = "Springs";
    app.add_option("--method", options.method, "auto scores all methods on held-out motion and returns the best")
        ->check(CLI::IsMember({"auto", "trajectory", "dominant-term", "exact", "closed-form"}))
        ->capture_default_str()
        ->group(fit);
    app.add_option("--exact-solver", options.exact_solver,
                   "of the exact fit: native (an active set) or ipopt (an interior point; where built with Ipopt)")
        ->check(CLI::IsMember({"native", "ipopt"}))
        ->capture_default_str()
        ->group(fit);
    app.add_option("--damping", options.damping,
                   "proportional to stiffness, a ratio of critical (2 zeta sqrt(k (m_i + m_j))), or fitted")
        ->check(CLI::IsMember({"proportional", "ratio", "fitted"}))
        ->capture_default_str()
        ->group(fit);
    add_optional(app, "--zeta", options.zeta, "zeta of --damping ratio (default 0.05)")->group(fit);
    app.add_option(
           "--parts", options.parts,
           "auto: springs along edges, with cells that hold their volume and the second ring where springs alone "
           "are not good; edges: springs along edges alone, for engines that know no others")
        ->check(CLI::IsMember({"auto", "edges"}))
        ->capture_default_str()
        ->group(fit);
    app.add_flag("--second-ring", options.second_ring, "springs between opposite vertices of neighbouring cells, too")
        ->group(fit);
    app.add_flag("--volume", options.volume, "cells that hold their volume, too; for nearly incompressible materials")
        ->group(fit);
    add_optional(
        app, "--fit-seconds", options.fit_seconds,
        "end matching of motion after this time, s; the result then depends on the machine (default: no limit)")
        ->group(fit);
    app.add_option("--threads", options.threads, "threads, 0 for all")->capture_default_str()->group(fit);
}

void declare_simulate(CLI::App& app, program::SimulateOptions& options) {
    app.add_option("MODEL", options.model, "a model.json")->required();
    app.add_option("--out", options.out,
                   "folder for motion.h5 and motion.xdmf; surface.h5 and surface.xdmf where the model has a surface")
        ->required();
    app.add_option_function<std::vector<double>>(
           "--gravity", [&options](const std::vector<double>& g) { options.gravity = g; },
           "acceleration of the whole body, m/s^2, one number per dimension (default 0,-9.81[,0])")
        ->delimiter(',');
    app.add_option("--duration", options.duration, "time to simulate, s")->capture_default_str();
    app.add_option("--frames", options.frames, "frames to write")->capture_default_str();
    app.add_option("--integrator", options.integrator,
                   "explicit (symplectic Euler), implicit (implicit Euler) or projective (implicit Euler by a few "
                   "local-global iterations, springs alone)")
        ->check(CLI::IsMember({"explicit", "implicit", "projective"}))
        ->capture_default_str();
    add_optional(app, "--time-step", options.time_step,
                 "longest step, s (default: the stable step, or the time between frames for implicit and projective)");
}

/// One line to standard error, whatever names and texts of files are in the message.
int refuse(int exit_code, std::string message) {
    constexpr std::size_t longest = 2000;
    if (message.size() > longest) {
        message.replace(longest, std::string::npos, "...");
    }
    for (char& c : message) {
        const auto code = static_cast<unsigned char>(c);
        c = code < 32 || code == 127 ? ' ' : c;
    }
    std::fprintf(stderr, "springfit: %s\n", message.c_str());
    return exit_code;
}

/// What may ask for more memory than there is, in the words of the command line.
std::string size_of_task(const program::FitOptions& fit, const program::SimulateOptions& simulate, bool fits) {
    if (!fits) {
        return springfit::text(simulate.model, " with --frames ", simulate.frames);
    }
    std::string task = fit.inputs.front();
    if (fit.cell_size) {
        task += springfit::text(" with --cell-size ", *fit.cell_size);
    } else if (fit.nodes) {
        task += springfit::text(" with --nodes ", *fit.nodes);
    }
    if (fit.reference_nodes) {
        task += springfit::text(" and --reference-nodes ", *fit.reference_nodes);
    }
    return task;
}

constexpr const char* exit_codes = "Exit codes: 0 the result is written; 1 a fault of springfit's own; 2 the input "
                                   "cannot be used, nothing is written;\n"
                                   "3 the result is written, but its verdict is poor or unusable; 130 interrupted "
                                   "(Ctrl-C, SIGTERM, SIGHUP), with what "
                                   "there\nwas by then written.";

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"springfit: mass-spring models calibrated against a reference simulation"};
    app.set_version_flag("--version", SPRINGFIT_VERSION_STRING);
    app.require_subcommand(1);
    app.get_formatter()->column_width(32);
    app.footer(exit_codes);

    program::FitOptions fit_options;
    program::SimulateOptions simulate_options;
    auto* fit = app.add_subcommand("fit", "derive stiffness, mass and damping of a mass-spring model");
    auto* simulate = app.add_subcommand("simulate", "step a fitted model and write its motion");
    declare_fit(*fit, fit_options);
    declare_simulate(*simulate, simulate_options);
    fit->footer(exit_codes);
    simulate->footer(exit_codes);

    program::keep_on_writing();
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) { // --help, --version
        return app.exit(request);
    } catch (const CLI::ParseError& error) {
        return refuse(program::exit_refused, error.what());
    }
    program::watch_for_interrupt();
#ifdef SPRINGFIT_PROGRAM_CHOLMOD
    springfit::cholmod::use_supernodal_factors();
#endif
    try {
        return fit->parsed() ? program::run_fit(fit_options) : program::run_simulate(simulate_options);
    } catch (const springfit::InvalidArgument& error) {
        return refuse(program::exit_refused, error.what());
    } catch (const springfit::FileError& error) {
        return refuse(program::exit_refused, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return refuse(program::exit_refused, error.what());
    } catch (const std::bad_alloc&) {
        return refuse(program::exit_refused,
                      "not enough memory for " + size_of_task(fit_options, simulate_options, fit->parsed()));
    } catch (const std::length_error&) { // of a container that can never be so large
        return refuse(program::exit_refused,
                      "not enough memory for " + size_of_task(fit_options, simulate_options, fit->parsed()));
    } catch (const program::Interrupted&) {
        return refuse(program::exit_interrupted, "interrupted before there was a result; nothing was written");
    } catch (const std::exception& error) {
        return refuse(program::exit_fault, springfit::text("internal error: ", error.what(),
                                                           "; this is a fault of springfit's, please report it with "
                                                           "the command and its input"));
    }
}
