// SPDX-License-Identifier: BSD-3-Clause
// `springfit fit`: from a body to its calibrated springs.

#include <cstdio>

#include <springfit/mesh/pieces.hpp>
#include <springfit/parallel/tbb.hpp>
#include <springfit/score/embedded_error.hpp>

#include "commands.hpp"
#include "exact_solver.hpp"
#include "files.hpp"
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
    require(!options.fit_seconds || *options.fit_seconds > 0, "--fit-seconds", "a positive time, s",
            options.fit_seconds.value_or(0));
    if (options.frames) {
        require(*options.frames >= 4, "--frames", "at least 4", *options.frames);
    }
    (void)exact_solver(options.exact_solver);
    for (const auto& [count, name] : {std::pair{options.training_cases, "--training-cases"},
                                      std::pair{options.held_out_cases, "--held-out-cases"}}) {
        require(!count || *count >= 1, name, "at least one", count.value_or(0));
    }
    require(!options.zeta || (*options.zeta >= 0 && std::isfinite(*options.zeta)), "--zeta", "a value not below 0",
            options.zeta.value_or(0));
    require(!options.zeta || options.damping == "ratio", "--zeta", "--damping ratio beside it",
            "--damping " + options.damping);
    const bool is_recorded = !options.references.empty() || is_motion_file(options.input);
    require(!options.damping_ratio || !is_recorded || options.damping == "proportional", "--damping-ratio",
            "--damping proportional beside it, of a recorded motion", "--damping " + options.damping);
    if (options.gravity) {
        require(is_recorded, "--gravity", "a recorded motion; the FEM reference has its own loads", "none");
        for (double g : *options.gravity) {
            require(std::isfinite(g), "--gravity", "finite numbers, m/s^2", g);
        }
    }
    if (is_recorded) {
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
    } else {
        require(options.mass_from.empty(), "--mass-from", "a recorded motion; the FEM reference has its own masses",
                "none");
    }
    if (is_motion_file(options.input)) {
        require(!options.nodes, "--nodes", "a surface or an outline as INPUT", options.input);
        require(!options.cell_size, "--cell-size", "a surface or an outline as INPUT", options.input);
        require(options.fill_holes == 0, "--fill-holes", "a surface as INPUT", options.input);
    }
}

io::Json material_of(const FitOptions& options, int dimension) {
    io::Json material = {{"young", options.young}, {"poisson", options.poisson}, {"density", options.density}};
    if (options.thickness || dimension == 2) {
        material["thickness"] = options.thickness.value_or(1);
    }
    return material;
}

/// A given value, or the library's own.
template <class Value>
void take(const std::optional<Value>& given, auto& target) {
    if (given) {
        target = *given;
    }
}

CalibrateOptions calibrate_options(const FitOptions& options, const Execution& execution,
                                   const ProgressCallback& progress) {
    CalibrateOptions how;
    how.method = options.method == "auto"            ? Method::automatic
                 : options.method == "trajectory"    ? Method::trajectory
                 : options.method == "dominant-term" ? Method::dominant_term
                 : options.method == "exact"         ? Method::exact
                                                     : Method::closed_form;
    how.damping = options.damping == "ratio"    ? DampingRule::ratio
                  : options.damping == "fitted" ? DampingRule::fitted
                                                : DampingRule::proportional;
    take(options.zeta, how.zeta);
    how.exact_solver = exact_solver(options.exact_solver);
    how.matching_seconds = options.fit_seconds;
    how.damping_ratio = options.damping_ratio;
    how.execution = execution;
    how.progress = progress;
    return how;
}

/// The body on its way from the mesh to the files.
template <int Dim>
class Fit {
public:
    Fit(const FitOptions& options, const AnyMesh& mesh, const std::optional<FineMesh>& fine_mesh,
        const ProgressCallback& progress)
        : m_options(options), m_mesh(mesh), m_fine_mesh(fine_mesh),
          m_how(calibrate_options(options, parallel::tbb(options.threads), progress)),
          m_body(discretise<Dim>(mesh, options)) {
        print_pieces();
        std::printf("%lld nodes, %lld %s cells, %lld springs\n", static_cast<long long>(m_body.network.n_nodes()),
                    static_cast<long long>(m_body.topology.cells.cols()), m_body.cell_name.c_str(),
                    static_cast<long long>(m_body.network.n_springs()));
        m_source.input = options.input;
        m_source.material = material_of(options, Dim);
        m_source.seed = options.seed;
        m_source.detail = {{"threads", options.threads}, {"damping", options.damping}};
        if (fine_mesh) {
            take_fine_mesh();
        }
        if (!options.mass_from.empty()) {
            m_body.network.mass = read_masses(options.mass_from, m_body.network.n_nodes());
        }
        m_variants = variants_of<Dim>(mesh, options);
        for (auto& variant : m_variants) {
            for (auto& given : variant.given) {
                given.network.mass = m_body.network.mass; // of the finer mesh, where there is one
            }
        }
    }

    /// Motions that another program recorded.
    [[nodiscard]] RecordedCases<Dim, double> recorded(std::vector<Motion<Dim, double>> motions,
                                                      std::vector<Warning> warnings) {
        require(!m_options.gravity || static_cast<int>(m_options.gravity->size()) == Dim, "--gravity",
                text(Dim, " numbers, one per dimension"), m_options.gravity ? m_options.gravity->size() : 0);
        for (auto& motion : motions) {
            require(motion.n_nodes() == m_body.network.n_nodes(), text("reference ", motion.name),
                    text(m_body.network.n_nodes(), " nodes, as in the mesh"), motion.n_nodes());
            if (m_options.gravity) {
                add_gravity(motion);
            }
            if (!m_options.clamps.empty()) {
                motion.clamped = nodes_to_clamp<Dim>(m_options.clamps, m_body.network.rest_positions);
            }
        }
        auto cases = split_motions(std::move(motions));
        cases.warnings.insert(cases.warnings.begin(), warnings.begin(), warnings.end());
        m_source.reference = {{"kind", "recorded"}};
        return cases;
    }

    /// Motions and equilibria of the finite element model.
    [[nodiscard]] RecordedCases<Dim, double> simulated() {
        RecordCasesOptions<Dim, double> record;
        take(m_options.training_cases, record.training_motions);
        take(m_options.held_out_cases, record.held_out_motions);
        take(m_options.frames, record.frames);
        take(m_options.deformation, record.deformation);
        take(m_options.static_cases, record.training_equilibria);
        take(m_options.strain, record.strain);
        record.damping_ratio = m_options.damping_ratio;
        record.stiffness_damping = light_damping(m_variants.front().given.front().network);
        record.seed = m_options.seed;
        if (!matches_motion(m_how.method)) {
            record.training_equilibria = 0; // nothing would learn from them
        }
        if (m_fine) {
            record.holds = [this](const std::vector<int>& clamped) { return holds_network(clamped); };
        }
        record.execution = m_how.execution;
        record.progress = m_how.progress;
        const AnyMesh& mesh = m_fine_mesh ? m_fine_mesh->mesh : m_mesh;
        const auto reference = make_fem_reference<Dim>(mesh, m_options);
        auto cases = [&] {
            try {
                return record_cases<Dim, double>(*reference.recorder, specimen_of<Dim>(mesh, m_options), record);
            } catch (const InvalidArgument& error) {
                if (error.argument() == "clamps") {
                    throw InvalidArgument("--clamp",
                                          "sides that keep the body from moving as a whole: a deeper one (y-min:0.1; "
                                          "y-min alone, without "
                                          "the option, is 0.05 deep) or a finer mesh (--nodes) has more nodes",
                                          "one that still can");
                }
                throw;
            }
        }();
        m_source.reference = {{"kind", "fem"},
                              {"element", reference.element},
                              {"material", m_options.material.value_or(default_material)},
                              {"clamps", sides_to_clamp(m_options)}};
        if (m_fine) {
            m_source.reference["nodes"] = m_fine->nodes.rest_positions.cols();
            const auto& rest = m_body.network.rest_positions;
            cases.training = at_network(cases.training, m_fine->nodes, rest);
            m_fine->held_out = std::move(cases.held_out);
            cases.held_out = at_network(m_fine->held_out, m_fine->nodes, rest);
        }
        return cases;
    }

    /// Fits and judges; the seconds that went before are those of the report's first stages.
    int finish(RecordedCases<Dim, double> cases, io::OutputFolder& folder, io::NamedNumbers seconds) {
        if (cases.interrupted && (cases.training.empty() || cases.held_out.empty())) {
            throw Interrupted();
        }
        print_body(cases);
        auto calibration = calibrate(m_variants, std::move(cases), m_how);
        const Stopwatch at_fine;
        if (m_fine) {
            judge_fine_nodes(calibration);
            calibration.seconds.back().second += at_fine.seconds();
        }
        std::printf("\nthe springs: damping %.3g s times stiffness, %.2g %% of critical in the slowest motion\n",
                    calibration.best().stiffness_damping, 100 * calibration.damping_ratio);
        print_table(calibration);
        if (m_fine) {
            const auto& judged = m_source.detail["reference_nodes"];
            std::printf(
                "carried by the network, the %lld nodes of the reference have a held-out error of %.4f, of which "
                "carrying alone makes %.4f\n\n",
                static_cast<long long>(m_fine->nodes.rest_positions.cols()), judged["error"].template get<double>(),
                judged["error_of_carrying"].template get<double>());
        }
        for (const Warning& warning : calibration.warnings) {
            std::fprintf(stderr, "warning: %s\n", to_string(warning).c_str());
        }
        write(calibration, folder, std::move(seconds));
        const Verdict verdict = calibration.verdict;
        const auto& held_out = calibration.best().held_out;
        std::printf("verdict: %s (held-out error %.4f", std::string(to_string(verdict)).c_str(), held_out.error);
        if (held_out.noise > 0) {
            std::printf(", of which the noise makes %.4f and the model %.4f", held_out.noise, held_out.beside_noise());
        }
        std::printf(")\n");
        return calibration.status == Status::interrupted ? exit_interrupted : is_usable(verdict) ? 0 : exit_poor;
    }

private:
    /// Says where the body falls apart: no force passes between its pieces.
    void print_pieces() const {
        const auto sizes = pieces(m_body.network.n_nodes(), m_body.network.springs);
        if (sizes.size() < 2) {
            return;
        }
        std::string list;
        for (std::size_t p = 0; p < sizes.size() && p < 8; ++p) {
            list += text(p == 0 ? "" : ", ", sizes[p]);
        }
        const Index n = n_coinciding(m_body.network.rest_positions);
        std::fprintf(stderr, "%s: the body is in %zu pieces, of %s%s nodes; %lld points coincide with another%s\n",
                     m_options.input.c_str(), sizes.size(), list.c_str(), sizes.size() > 8 ? ", ..." : "",
                     static_cast<long long>(n),
                     n > 0 ? ": merge them in the mesher where the pieces hold together" : "");
    }

    /// The body and the recording, before the long work: what is in another unit shows.
    void print_body(const RecordedCases<Dim, double>& cases) const {
        const auto& rest = m_body.network.rest_positions;
        const Vector<Dim, double> size = rest.rowwise().maxCoeff() - rest.rowwise().minCoeff();
        std::string extent = text(size(0));
        for (int d = 1; d < Dim; ++d) {
            extent += text(" x ", size(d));
        }
        const double period = slowest_period(m_variants.front().given.front().network, cases);
        std::printf("the body: %s m, %.4g kg, slowest period about %.4g s\n", extent.c_str(), m_body.network.mass.sum(),
                    period);
        if (const double recorded = recorded_time(cases); recorded > 0) {
            std::printf("recorded: %.4g s in %lld frames\n", recorded,
                        static_cast<long long>(cases.held_out.motions.front().n_frames()));
        }
        for (const Warning& warning : warnings_of_units(period, cases)) {
            std::fprintf(stderr, "warning: %s\n", to_string(warning).c_str());
        }
        std::fflush(stdout);
    }

    void add_gravity(Motion<Dim, double>& motion) const {
        const auto& g = *m_options.gravity;
        const Points<Dim, double> weight = Vector<Dim, double>::Map(g.data()) * m_body.network.mass.transpose();
        for (auto& forces : motion.external_forces) {
            forces += weight;
        }
    }

    [[nodiscard]] bool holds_network(const std::vector<int>& clamped) const {
        return holds_rigidly(m_body.network.rest_positions, m_fine->nodes.clamped_at_network(clamped));
    }

    void take_fine_mesh() {
        const auto specimen = specimen_of<Dim>(m_fine_mesh->mesh, m_options);
        m_fine = FineSide<Dim>{{specimen.rest_positions, m_fine_mesh->at_network, m_fine_mesh->at_fine},
                               surface_of<Dim>(*m_fine_mesh),
                               {}};
        std::printf("%lld nodes of the reference\n", static_cast<long long>(specimen.n_nodes()));
        try {
            m_body.network.mass = restrict_masses(m_fine->nodes.at_fine, specimen.masses);
        } catch (const InvalidArgument&) {
            throw InvalidArgument("--reference-nodes",
                                  "a mesh so fine that every node of the network takes a share of its mass",
                                  text(specimen.n_nodes(), " nodes beside ", m_body.network.n_nodes()));
        }
        require(holds_network(specimen.clamps.front().nodes), "--clamp",
                "sides so deep (y-min:0.1) that they hold the network as they hold the reference",
                "too few of its nodes within");
    }

    void judge_fine_nodes(Calibration<Dim>& calibration) {
        const auto judged = embedded_error(calibration.best().network, calibration.cases.held_out, m_fine->held_out,
                                           m_fine->nodes, m_how.execution, m_how.progress);
        if (interrupted()) {
            calibration.status = Status::interrupted;
        }
        io::Json cases = io::Json::object();
        for (std::size_t c = 0; c < m_fine->held_out.size(); ++c) {
            cases[m_fine->held_out.motions[c].name] = judged.by_network.case_errors[c];
        }
        m_source.detail["reference_nodes"] = {{"nodes", m_fine->nodes.rest_positions.cols()},
                                              {"error", judged.by_network.error},
                                              {"error_of_carrying", judged.by_reference.error},
                                              {"cases", cases}};
    }

    void write(const Calibration<Dim>& calibration, io::OutputFolder& folder, io::NamedNumbers seconds) {
        const Stopwatch writing;
        auto model = io::model_of(calibration, m_source);
        if (m_fine) {
            model.surface = m_fine->surface.surface;
        }
        auto report = io::report_of(calibration, m_source);
        io::OutputGroup outputs;
        write_shown_motion<Dim>(outputs, folder.path(), m_body.topology, calibration, m_fine, report.warnings);
        io::write_model(outputs, folder.path() / "model.json", model);
        seconds.insert(seconds.end(), calibration.seconds.begin(), calibration.seconds.end());
        seconds.emplace_back("write", writing.seconds());
        for (const auto& stage : seconds) {
            report.seconds += stage.second;
        }
        report.stage_seconds = std::move(seconds);
        io::write_report(outputs, folder.path() / "report.json", report);
        outputs.commit();
        std::printf("wrote model.json, report.json, motion.h5%s and the .xdmf beside to %s\n",
                    m_fine ? ", surface.h5" : "", folder.path().string().c_str());
    }

    const FitOptions& m_options;
    const AnyMesh& m_mesh;
    const std::optional<FineMesh>& m_fine_mesh;
    CalibrateOptions m_how;
    Discretisation<Dim> m_body;
    std::vector<NetworkVariant<Dim>> m_variants;
    std::optional<FineSide<Dim>> m_fine;
    io::CalibrationSource m_source;
};

/// Everything from the body on, for one dimension; `mesh` is empty where INPUT is a recorded motion.
template <int Dim>
int fit_dimension(std::optional<AnyMesh> mesh, const std::optional<FineMesh>& fine_mesh, const FitOptions& options,
                  io::OutputFolder& folder, io::NamedNumbers seconds, const ProgressCallback& progress) {
    std::vector<Warning> warnings;
    std::vector<Motion<Dim, double>> motions;
    if (!mesh) {
        auto input = read_recorded<Dim>(options.input, options, warnings);
        mesh = mesh_of<Dim>(input, options.input);
        motions.push_back(std::move(input.motion));
    }
    for (const auto& path : options.references) {
        require(io::read_motion_dimension(path) == Dim, "--reference", text("a motion of dimension ", Dim), path);
        motions.push_back(read_recorded<Dim>(path, options, warnings).motion);
    }
    Fit<Dim> fit(options, *mesh, fine_mesh, progress);
    const Stopwatch recording;
    auto cases = motions.empty() ? fit.simulated() : fit.recorded(std::move(motions), std::move(warnings));
    seconds.emplace_back("reference", recording.seconds());
    return fit.finish(std::move(cases), folder, std::move(seconds));
}

} // namespace

int run_fit(FitOptions options) {
    require(!options.out.empty(), "--out", "a folder", "an empty name");
    options.inputs = expanded(options.inputs);
    options.input = options.inputs.front();
    options.references = expanded(options.references);
    options.references.insert(options.references.begin(), options.inputs.begin() + 1, options.inputs.end());
    for (const auto& path : options.references) {
        require(is_motion_file(path), "INPUT", "recorded motions (.xdmf .h5) after the first file", path);
    }
    check(options);
    if (is_motion_file(options.input)) {
        try_to_read(options.input);
    }
    std::for_each(options.references.begin(), options.references.end(), try_to_read);
    io::OutputFolder folder(options.out);
    Terminal terminal;
    io::NamedNumbers seconds;
    std::optional<AnyMesh> mesh;
    std::optional<FineMesh> fine_mesh;
    int dimension = 0;
    if (is_motion_file(options.input)) {
        dimension = io::read_motion_dimension(options.input);
    } else {
        const Stopwatch meshing;
        mesh = read_mesh(options, terminal.callback());
        dimension = dimension_of(*mesh);
        if (options.reference_nodes && !interrupted()) {
            fine_mesh = read_fine_mesh(options, *mesh, terminal.callback());
        }
        seconds.emplace_back("mesh", meshing.seconds());
    }
    if (interrupted()) {
        throw Interrupted();
    }
    return dimension == 2
               ? fit_dimension<2>(std::move(mesh), fine_mesh, options, folder, std::move(seconds), terminal.callback())
               : fit_dimension<3>(std::move(mesh), fine_mesh, options, folder, std::move(seconds), terminal.callback());
}

} // namespace program
