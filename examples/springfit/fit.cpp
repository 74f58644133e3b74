// SPDX-License-Identifier: BSD-3-Clause
// `springfit fit`: from a body to its calibrated springs.

#include <cstdio>

#include <springfit/core/version.hpp>
#include <springfit/io/model_json.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/io/report_json.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/parallel/tbb.hpp>
#include <springfit/score/motion_error.hpp>
#include <springfit/step/stable_step.hpp>

#include "candidates.hpp"
#include "coarse_from_fine.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

namespace {

/// Refuses what can be refused before any long work.
void check(const FitOptions& options) {
    require(options.young > 0 && std::isfinite(options.young), "--young", "a positive modulus, Pa", options.young);
    require(options.poisson > -1 && options.poisson < 0.5, "--poisson", "a value in (-1, 0.5)", options.poisson);
    require(options.density > 0 && std::isfinite(options.density), "--density", "a positive density, kg/m^3",
            options.density);
    require(options.threads >= 0, "--threads", "0 (all) or a positive number", options.threads);
    if (options.thickness) {
        require(*options.thickness > 0 && std::isfinite(*options.thickness), "--thickness", "a positive length, m",
                *options.thickness);
    }
    if (options.cell_size) {
        require(*options.cell_size > 0 && std::isfinite(*options.cell_size), "--cell-size", "a positive length, m",
                *options.cell_size);
    }
    if (options.nodes) {
        require(*options.nodes >= 4, "--nodes", "at least 4", *options.nodes);
    }
    if (options.reference_nodes && !options.cell_size) {
        const int nodes = options.nodes.value_or(default_nodes);
        require(*options.reference_nodes > nodes, "--reference-nodes", text("more than the ", nodes, " of --nodes"),
                *options.reference_nodes);
    }
    if (options.deformation) {
        require(*options.deformation > 0 && *options.deformation < 1, "--deformation",
                "a part of the body's size in (0, 1)", *options.deformation);
    }
    if (options.damping_ratio) {
        require(*options.damping_ratio >= 0 && *options.damping_ratio < 1, "--damping-ratio",
                "a part of critical in [0, 1)", *options.damping_ratio);
    }
    if (options.static_cases) {
        require(*options.static_cases >= 1, "--static-cases", "at least one", *options.static_cases);
    }
    if (options.strain) {
        require(*options.strain > 0 && *options.strain < 1, "--strain", "a strain in (0, 1)", *options.strain);
    }
    require(options.fit_seconds > 0, "--fit-seconds", "a positive time, s", options.fit_seconds);
    if (options.frames) {
        require(*options.frames >= 4, "--frames", "at least 4", *options.frames);
    }
    for (const auto& [count, name] : {std::pair{options.training_cases, "--training-cases"},
                                      std::pair{options.held_out_cases, "--held-out-cases"}}) {
        require(!count || *count >= 1, name, "at least one", count.value_or(0));
    }
    require(!options.zeta || (*options.zeta >= 0 && std::isfinite(*options.zeta)), "--zeta", "a value not below 0",
            options.zeta.value_or(0));
    require(!options.zeta || options.damping == "ratio", "--zeta", "--damping ratio beside it",
            "--damping " + options.damping);
    if (!options.references.empty() || is_motion_file(options.input)) {
        const auto refuse = [](bool given, const char* name) {
            require(!given, name, "an FEM reference", "a recorded motion, for which it has no meaning");
        };
        refuse(options.material.has_value(), "--material");
        refuse(options.element.has_value(), "--element");
        refuse(options.reference_nodes.has_value(), "--reference-nodes");
        refuse(options.training_cases.has_value(), "--training-cases");
        refuse(options.held_out_cases.has_value(), "--held-out-cases");
        refuse(options.frames.has_value(), "--frames");
        refuse(options.deformation.has_value(), "--deformation");
        refuse(options.static_cases.has_value(), "--static-cases");
        refuse(options.strain.has_value(), "--strain");
    }
    if (is_motion_file(options.input)) {
        require(!options.nodes, "--nodes", "a surface or an outline as INPUT", options.input);
        require(!options.cell_size, "--cell-size", "a surface or an outline as INPUT", options.input);
        require(options.fill_holes == 0, "--fill-holes", "a surface as INPUT", options.input);
    }
}

template <int Dim>
io::Json material_of(const FitOptions& options) {
    io::Json material = {{"young", options.young}, {"poisson", options.poisson}, {"density", options.density}};
    if (options.thickness || Dim == 2) {
        material["thickness"] = options.thickness.value_or(1);
    }
    return material;
}

template <int Dim>
void print_table(const std::vector<Candidate<Dim>>& candidates, std::size_t best) {
    std::printf("\n%-16s %10s %10s %12s %10s\n", "method", "held-out", "training", "stiffness", "seconds");
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const auto& candidate = candidates[c];
        std::printf("%-16s %10.4f %10.4f %12.3f %10.2f%s\n", candidate.name.c_str(), candidate.held_out,
                    candidate.training, candidate.relative_stiffness, candidate.seconds,
                    c == best ? "   <- returned" : "");
    }
    std::printf(
        "(errors: |x - x_ref| / |x_ref - x_rest| over free nodes, frames and cases, inf where a network does not come "
        "through a case;\nstiffness: energy in the reference's motion beside the first closed form)\n\n");
}

/// Writes the motion of the reference and of the network under the first held-out load case, as far as both go, and
/// where there is a surface that the network carries the same at its points.
template <int Dim>
void write_shown_motion(io::OutputGroup& outputs, const std::filesystem::path& folder, const Discretisation<Dim>& body,
                        const CaseSet<Dim>& held_out, const SpringNetwork<Dim, double>& network,
                        const std::optional<CoarseFromFine<Dim>>& fine, std::vector<std::string>& warnings) {
    const auto& reference = held_out.motions.front();
    const auto fitted = simulate(network, held_out.scenarios.front(), reference.times).motion;
    if (fitted.n_frames() < reference.n_frames()) {
        warnings.push_back(text("motion.h5: the network's motion ended after ", fitted.n_frames(), " of ",
                                reference.n_frames(), " frames"));
    }
    const auto write = [&](const char* name, const Motion<Dim, double>& motion, const io::MotionTopology& topology,
                           const std::vector<Points<Dim, double>>& positions) {
        if (positions.empty()) {
            io::write_motion(outputs, folder / name, motion, topology);
        } else {
            const auto frames = static_cast<Index>(positions.size());
            io::write_motion(outputs, folder / name, excerpt(motion, 0, frames), topology, &positions);
        }
    };
    write("motion.h5", reference, body.topology, fitted.positions);
    if (fine) {
        const auto& surface = fine->surface();
        write("surface.h5", fine->shown_at_surface(), io::motion_topology(surface), carry(surface, fitted));
    } else { // what a run with a finer reference left there is of another network
        outputs.remove(folder / "surface.h5");
        outputs.remove(folder / "surface.xdmf");
    }
}

template <int Dim>
int fit_body(const AnyMesh& mesh, const std::optional<FineMesh>& fine_mesh, std::vector<Motion<Dim, double>> recorded,
             std::vector<std::string> warnings, const FitOptions& options, io::OutputFolder& folder,
             io::NamedNumbers stages) {
    const auto since = [&stages](const Timer& timer, const char* name) { stages.emplace_back(name, timer.seconds()); };
    const Execution execution = parallel::tbb(options.threads);
    Discretisation<Dim> body = discretise<Dim>(mesh, options);
    std::printf("%lld nodes, %lld %s cells, %lld springs\n", static_cast<long long>(body.network.n_nodes()),
                static_cast<long long>(body.topology.cells.cols()), body.cell_name.c_str(),
                static_cast<long long>(body.network.n_springs()));
    std::optional<CoarseFromFine<Dim>> fine;
    if (fine_mesh) {
        fine.emplace(*fine_mesh, options, body);
        std::printf("%lld nodes of the reference\n", static_cast<long long>(fine->body().n_nodes()));
    }

    const Timer recording;
    const ReferenceCases<Dim> cases = [&] {
        if (!recorded.empty()) {
            return split_recorded<Dim>(std::move(recorded), body, options);
        }
        const AnyMesh& reference_mesh = fine_mesh ? fine_mesh->mesh : mesh;
        auto on_reference = record_cases<Dim>(
            *make_fem_reference<Dim>(reference_mesh, options), body_of<Dim>(reference_mesh, options), body, options,
            execution, [&](const std::vector<int>& clamped) { return !fine || fine->holds_network(clamped); });
        if (fine) {
            return fine->carried_to_network(std::move(on_reference));
        }
        return on_reference;
    }();
    since(recording, "reference");
    warnings.insert(warnings.end(), cases.warnings.begin(), cases.warnings.end());

    const bool cut_short = interrupted();
    if (cut_short) {
        watch_for_interrupt(); // what is there is fitted; a further Ctrl-C ends that as well
    }
    const Timer fitting;
    auto candidates = make_candidates<Dim>(body, cases, options, execution);
    const bool fit_interrupted = interrupted();
    watch_for_interrupt();
    since(fitting, "fit");
    const Timer scoring;
    score<Dim>(candidates, cases, execution);

    const bool choose = options.method == "auto" || options.method == "closed-form";
    std::size_t best = choose ? 0 : candidates.size() - 1; // a method asked for by name comes last
    if (choose) {
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            if (candidates[c].held_out < candidates[best].held_out) {
                best = c;
            }
        }
    }
    for (const auto& candidate : candidates) {
        if (candidate.fit && candidate.relative_stiffness < 0.9) {
            warnings.push_back(text(candidate.name, " came out softer than the closed form (",
                                    candidate.relative_stiffness,
                                    " of its stiffness): accelerations alone lose stiffness where springs cannot "
                                    "represent the material"));
        }
        if (candidate.fit && !candidate.fit->not_identified.empty()) {
            warnings.push_back(text(candidate.name, ": ", candidate.fit->not_identified.size(),
                                    " values that no motion excites kept their prior"));
        }
        if (candidate.n_clamped > 0) {
            warnings.push_back(
                text(candidate.name, ": ", candidate.n_clamped, " springs would be negative and were set to 0"));
        }
    }
    const Candidate<Dim>& chosen = candidates[best];
    io::Json at_reference_nodes;
    if (fine) {
        at_reference_nodes = fine->errors_at_fine_nodes(chosen.network, cases.held_out, execution);
    }
    const bool score_interrupted = interrupted();
    since(scoring, "score");
    if (!cut_short && !fit_interrupted && !score_interrupted && !(chosen.held_out < 0.25)) {
        warnings.push_back(text("the returned network moves unlike the reference (held-out error ", chosen.held_out,
                                "); cells that hold their volume (--volume), smaller motions (--strain, --deformation) "
                                "or more --nodes may help"));
    }
    print_table<Dim>(candidates, best);
    const io::NamedNumbers parts = held_out_parts<Dim>(chosen, cases.held_out);
    for (const auto& [part, error] : parts) {
        std::printf("%s, held out: %-28s %.4f\n", chosen.name.c_str(), part.c_str(), error);
    }
    std::printf("\n");
    if (fine) {
        std::printf("carried by the network, the %lld nodes of the reference have a held-out error of %.4f, of which "
                    "carrying alone makes %.4f\n\n",
                    static_cast<long long>(fine->body().n_nodes()), at_reference_nodes["error"].template get<double>(),
                    at_reference_nodes["error_of_carrying"].template get<double>());
    }
    for (const std::string& warning : warnings) {
        std::fprintf(stderr, "warning: %s\n", warning.c_str());
    }

    io::Model<Dim, double> model;
    model.network = chosen.network;
    if (chosen.trajectory) {
        model.data_share = chosen.data_share;
    }
    model.fixed = cases.held_out.motions.front().clamped;
    if (fine) {
        model.surface = fine->surface();
    }
    model.stable_time_step = stable_step(chosen.network, model.fixed);
    model.provenance = {
        {"springfit", SPRINGFIT_VERSION_STRING}, {"method", chosen.name}, {"input", options.input},
        {"material", material_of<Dim>(options)}, {"seed", options.seed},  {"reference", cases.description}};

    io::Report report;
    const bool early = cut_short || fit_interrupted || score_interrupted;
    report.status = early               ? Status::interrupted
                    : chosen.fit        ? chosen.fit->status
                    : chosen.trajectory ? chosen.trajectory->status
                                        : Status::converged;
    report.method = chosen.name;
    report.nodes = body.network.n_nodes();
    report.springs = body.network.n_springs();
    report.held_out.error = chosen.held_out;
    report.training.error = chosen.training;
    io::Json fits = io::Json::object();
    for (const auto& candidate : candidates) {
        report.held_out.baselines.emplace_back(candidate.name, candidate.held_out);
        report.training.baselines.emplace_back(candidate.name, candidate.training);
        fits[candidate.name] = candidate.fit          ? describe(*candidate.fit)
                               : candidate.trajectory ? describe(*candidate.trajectory)
                                                      : io::Json::object();
        fits[candidate.name]["relative_stiffness"] = candidate.relative_stiffness;
        fits[candidate.name]["seconds"] = candidate.seconds;
        if (!candidate.caveat.empty()) {
            fits[candidate.name]["caveat"] = candidate.caveat;
        }
    }
    report.detail = {{"fits", fits},
                     {"reference", cases.description},
                     {"seed", options.seed},
                     {"threads", options.threads},
                     {"damping", options.damping},
                     {"held_out_parts", io::Json::object()}};
    for (const auto& [part, error] : parts) {
        report.detail["held_out_parts"][part] = error;
    }
    if (fine) {
        report.detail["reference_nodes"] = at_reference_nodes;
    }

    io::OutputGroup outputs;
    const Timer writing;
    write_shown_motion<Dim>(outputs, folder.path(), body, cases.held_out, chosen.network, fine, warnings);
    report.warnings = warnings;
    io::write_model(outputs, folder.path() / "model.json", model);
    since(writing, "write");
    for (const auto& stage : stages) {
        report.seconds += stage.second;
    }
    report.stage_seconds = stages;
    io::write_report(outputs, folder.path() / "report.json", report);
    outputs.commit();
    std::printf("wrote model.json, report.json, motion.h5%s and the .xdmf beside to %s\n", fine ? ", surface.h5" : "",
                folder.path().string().c_str());
    return early ? exit_interrupted : 0;
}

/// A recorded motion, with what the report has to say of it.
template <int Dim>
io::RecordedMotion<Dim, double> read_recorded(const std::string& path, std::vector<std::string>& warnings) {
    auto recorded = io::read_motion<Dim, double>(path);
    for (const std::string& column : recorded.differenced) {
        warnings.push_back(path + ": " + column + " is not in the file and was differenced");
    }
    if (!recorded.forces_recorded) {
        warnings.push_back(path + ": external forces are not in the file and were taken as zero");
    }
    if (!recorded.clamped_recorded) {
        // Nodes that never leave their place are taken as held.
        auto& motion = recorded.motion;
        for (Index i = 0; i < motion.n_nodes(); ++i) {
            const bool still = std::all_of(motion.positions.begin(), motion.positions.end(), [&](const auto& frame) {
                return (frame.col(i) - motion.rest_positions.col(i)).isZero(0);
            });
            if (still) {
                motion.clamped.push_back(static_cast<int>(i));
            }
        }
        warnings.push_back(text(path, ": clamped nodes are not in the file; the ", motion.clamped.size(),
                                " nodes that never move were taken as clamped"));
    }
    return recorded;
}

/// Everything from the body on, for one dimension; `mesh` is empty where INPUT is a recorded motion.
template <int Dim>
int fit_dimension(std::optional<AnyMesh> mesh, const std::optional<FineMesh>& fine_mesh, const FitOptions& options,
                  io::OutputFolder& folder, io::NamedNumbers stages) {
    std::vector<std::string> warnings;
    std::vector<Motion<Dim, double>> motions;
    if (!mesh) {
        auto input = read_recorded<Dim>(options.input, warnings);
        mesh = mesh_of<Dim>(input, options.input);
        motions.push_back(std::move(input.motion));
    }
    for (const auto& path : options.references) {
        require(io::read_motion_dimension(path) == Dim, "--reference", text("a motion of dimension ", Dim), path);
        motions.push_back(read_recorded<Dim>(path, warnings).motion);
    }
    return fit_body<Dim>(*mesh, fine_mesh, std::move(motions), std::move(warnings), options, folder, std::move(stages));
}

} // namespace

int run_fit(const FitOptions& options) {
    check(options);
    io::OutputFolder folder(options.out);
    io::NamedNumbers stages;
    std::optional<AnyMesh> mesh;
    std::optional<FineMesh> fine_mesh;
    int dimension = 0;
    if (is_motion_file(options.input)) {
        dimension = io::read_motion_dimension(options.input);
    } else {
        const Timer timer;
        mesh = read_mesh(options);
        dimension = dimension_of(*mesh);
        if (options.reference_nodes && !interrupted()) {
            fine_mesh = read_fine_mesh(options, *mesh);
        }
        stages.emplace_back("mesh", timer.seconds());
    }
    if (interrupted()) {
        throw Interrupted();
    }
    return dimension == 2 ? fit_dimension<2>(std::move(mesh), fine_mesh, options, folder, std::move(stages))
                          : fit_dimension<3>(std::move(mesh), fine_mesh, options, folder, std::move(stages));
}

} // namespace program
