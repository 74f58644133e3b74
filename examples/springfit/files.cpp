// SPDX-License-Identifier: BSD-3-Clause
// What `springfit fit` reads and writes besides meshes.

#include <csignal>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <springfit/io/json.hpp>
#include <springfit/motion/units.hpp>
#include <springfit/score/embedded_error.hpp>

#include "commands.hpp"
#include "files.hpp"
#include "interrupt.hpp"

namespace program {

using namespace springfit;

Values<double> read_masses(const std::string& path, Index n_nodes) {
    Values<double> masses(n_nodes);
    if (io::hdf5::File::is_hdf5(path)) {
        const auto file = io::hdf5::File::open(path);
        const io::hdf5::Shape expected{static_cast<hsize_t>(n_nodes)};
        if (const auto found = file.shape("/mesh/mass"); found != expected) {
            file.refuse("/mesh/mass",
                        text("expected one mass for each of ", n_nodes, " nodes, found ", io::hdf5::to_text(found)));
        }
        file.read("/mesh/mass", masses.data(), expected);
    } else {
        const io::Json model = io::read_json(path);
        const io::Json::json_pointer place("/nodes/mass");
        const io::Json mass = model.is_object() && model.contains(place) ? model.at(place) : io::Json();
        if (!mass.is_array() || static_cast<Index>(mass.size()) != n_nodes) {
            throw FileError(path, text("/nodes/mass: expected one mass for each of ", n_nodes, " nodes, found ",
                                       mass.is_array() ? text(mass.size()) : std::string(mass.type_name())));
        }
        for (Index i = 0; i < n_nodes; ++i) {
            const io::Json& entry = mass[static_cast<std::size_t>(i)];
            masses(i) = entry.is_number() ? entry.get<double>() : std::numeric_limits<double>::quiet_NaN();
        }
    }
    for (Index i = 0; i < n_nodes; ++i) {
        if (!(masses(i) > 0 && std::isfinite(masses(i)))) {
            throw FileError(path, text("expected positive masses, kg, found ", masses(i), " at node ", i));
        }
    }
    return masses;
}

void try_to_read(const std::string& path) {
    const pid_t child = ::fork();
    if (child < 0) {
        return; // no process to be had: read without a trial
    }
    if (child == 0) {
        const io::detail::Descriptor nowhere("/dev/null", O_WRONLY);
        ::dup2(nowhere.get(), STDERR_FILENO);
        for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
            std::signal(signal, SIG_DFL);
        }
        constexpr rlim_t seconds_of_processor = 100; // some 10 GB
        const rlimit limit{seconds_of_processor, seconds_of_processor};
        ::setrlimit(RLIMIT_CPU, &limit);
        try {
            io::scan_motion(path);
        } catch (const std::exception&) { // comes again
        }
        H5close(); // as at the end of the program
        ::_exit(0);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (interrupted()) {
        throw Interrupted();
    }
    if (WIFSIGNALED(status)) {
        throw FileError(path,
                        text("is damaged: HDF5 cannot read it (", ::strsignal(WTERMSIG(status)), "); write it anew"));
    }
}

template <int Dim>
io::RecordedMotion<Dim, double> read_recorded(const std::string& path, const FitOptions& options,
                                              std::vector<Warning>& warnings) {
    auto recorded = io::read_motion<Dim, double>(path);
    recorded.motion = in_si_units(std::move(recorded.motion), metres(options.unit), seconds(options.time_unit));
    const auto warn = [&](std::string message) {
        warnings.push_back({.code = WarningCode::incomplete_recording,
                            .about = path,
                            .message = std::move(message),
                            .advice = {},
                            .values = {}});
    };
    for (const std::string& column : recorded.differenced) {
        if (recorded.motion.n_frames() > 1) { // an equilibrium has none
            warn(path + ": " + column + " is not in the file and was differenced");
        }
    }
    if (const auto& gaps = recorded.motion.unobserved; !gaps.empty()) {
        std::size_t n = 0;
        for (const auto& frame : gaps) {
            n += frame.size();
        }
        const double percent =
            100 * static_cast<double>(n) / static_cast<double>(recorded.motion.n_frames() * recorded.motion.n_nodes());
        warnings.push_back({.code = WarningCode::unobserved,
                            .about = path,
                            .message = text(path, ": ", n, " positions of nodes (", percent,
                                            " %) are not in the file; they have no weight"),
                            .advice = {},
                            .values = {{"positions", static_cast<double>(n)}}});
    }
    if (!recorded.forces_recorded) {
        warn(path + ": external forces are not in the file and were taken as zero");
    }
    if (!recorded.clamped_recorded) {
        recorded.motion.clamped = still_nodes(recorded.motion);
        warn(text(path, ": clamped nodes are not in the file; the ", recorded.motion.clamped.size(),
                  " nodes that never move were taken as clamped"));
    }
    return recorded;
}

template <int Dim>
void write_shown_motion(io::OutputGroup& outputs, const std::filesystem::path& folder,
                        const io::MotionTopology& topology, const Calibration<Dim>& calibration,
                        const std::optional<FineSide<Dim>>& fine, std::vector<std::string>& warnings) {
    const auto& held_out = calibration.cases.held_out;
    const auto& reference = held_out.motions.front();
    const auto fitted = simulate(calibration.best().network, held_out.cases.front().scenario, reference.times).motion;
    if (fitted.n_frames() < reference.n_frames()) {
        warnings.push_back(text("motion.h5: the network's motion ended after ", fitted.n_frames(), " of ",
                                reference.n_frames(), " frames"));
    }
    const auto write = [&](const char* name, const Motion<Dim, double>& motion, const io::MotionTopology& cells,
                           const std::vector<Points<Dim, double>>& positions) {
        if (positions.empty()) {
            io::write_motion(outputs, folder / name, motion, cells);
        } else {
            const auto frames = static_cast<Index>(positions.size());
            io::write_motion(outputs, folder / name, excerpt(motion, 0, frames), cells, &positions);
        }
    };
    auto returned = topology; // with the springs of the network that is returned
    returned.springs = calibration.best().network.springs;
    write("motion.h5", reference, returned, fitted.positions);
    if (fine) {
        const auto& [surface, nodes] = fine->surface;
        write("surface.h5", motion_at(fine->held_out.motions.front(), nodes), io::motion_topology(surface),
              deform(surface, fitted));
    } else { // what a run with a finer reference left there is of another network
        outputs.remove(folder / "surface.h5");
        outputs.remove(folder / "surface.xdmf");
    }
}

namespace {

/// A dash where it was not scored.
std::string error_text(const CaseScores& scores) {
    char number[32];
    std::snprintf(number, sizeof number, "%.4f", scores.error);
    return scores.is_scored() ? number : "-";
}

} // namespace

template <int Dim>
void print_table(const Calibration<Dim>& calibration) {
    std::printf("\n%-16s %10s %10s %10s %12s %10s\n", "method", "held-out", "failed", "training", "stiffness",
                "seconds");
    for (const auto& candidate : calibration.candidates) {
        const CaseScores& scores = candidate.held_out;
        std::printf("%-16s %10s %10s %10s %12.3f %10.2f%s\n", candidate.name.c_str(), error_text(scores).c_str(),
                    text(scores.n_failed(), " of ", scores.n_tried()).c_str(), error_text(candidate.training).c_str(),
                    candidate.relative_stiffness, candidate.seconds,
                    &candidate == &calibration.best() ? "   <- returned" : "");
    }
    std::printf("(errors: |x - x_ref| / |x_ref - x_rest| over free nodes, frames and cases; failed: held-out cases "
                "that the network\n"
                "cannot be simulated in, which count as 1. Beside a good network one that fails is not tried on: what "
                "is left counts\n"
                "as 1, too. stiffness: energy in the reference's motion beside the first closed form)\n\n");
    for (const auto& [part, error] : calibration.parts) {
        std::printf("%s, held out: %-28s %.4f\n", calibration.best().name.c_str(), std::string(part).c_str(), error);
    }
    std::printf("\n");
}

template io::RecordedMotion<2, double> read_recorded<2>(const std::string&, const FitOptions&, std::vector<Warning>&);
template io::RecordedMotion<3, double> read_recorded<3>(const std::string&, const FitOptions&, std::vector<Warning>&);
template void write_shown_motion<2>(io::OutputGroup&, const std::filesystem::path&, const io::MotionTopology&,
                                    const Calibration<2>&, const std::optional<FineSide<2>>&,
                                    std::vector<std::string>&);
template void write_shown_motion<3>(io::OutputGroup&, const std::filesystem::path&, const io::MotionTopology&,
                                    const Calibration<3>&, const std::optional<FineSide<3>>&,
                                    std::vector<std::string>&);
template void print_table<2>(const Calibration<2>&);
template void print_table<3>(const Calibration<3>&);

} // namespace program
