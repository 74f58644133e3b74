// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <csignal>
#include <iostream>

#ifdef SPRINGFIT_STUDY_CHOLMOD
#include <springfit/cholmod/supernodal_factor.hpp>
#endif
#ifdef SPRINGFIT_STUDY_PARALLEL
#include <springfit/parallel/tbb.hpp>
#endif

#include "study.hpp"

namespace {

volatile std::sig_atomic_t pressed = 0;

void on_interrupt(int signal) {
    pressed = 1;
    std::signal(signal, SIG_DFL); // a second one ends the program at once
}

constexpr const char* usage =
    "springfit_study [--quick] [--out DIR] [--data DIR] [--seed N] [--only PART]...\n"
    "  Fits every method on every mesh and scores it on unseen motion; writes tables and figures.\n"
    "  --quick     a few small rows of each part\n"
    "  --out DIR   where to write (docs/results; quick: study-quick)\n"
    "  --data DIR  a folder with elephant.off and other surfaces; without it they are left out\n"
    "  --seed N    of all load cases (1)\n"
    "  --only PART recovery, solids, surfaces, dynamics, coarse, strangers, time,\n"
    "              setups or plane; may be given again\n"
    "Exit codes: 0 when it ran, whatever the bars; 1 where known springs are not recovered; 2 for wrong arguments;\n"
    "130 where Ctrl-C ended it early, with all that was done so far in the files.\n";

using Part = void (*)(study::Report&, const study::Settings&);

constexpr std::pair<const char*, Part> parts[] = {
    {"recovery", study::study_recovery}, {"solids", study::study_solids}, {"surfaces", study::study_surfaces},
    {"dynamics", study::study_dynamics}, {"coarse", study::study_coarse}, {"strangers", study::study_strangers},
    {"time", study::study_time},         {"setups", study::study_setups}, {"plane", study::study_plane},
};

struct Arguments {
    study::Settings settings;
    std::string out;
    std::string command = "springfit_study";
    std::vector<std::string> only;
};

/// Prints what is wrong, and the usage.
int refuse(const std::string& what) {
    std::cerr << what << "\n" << usage;
    return 2;
}

/// The exit code where the program ends here, else -1.
int read(int argc, char** argv, Arguments& arguments) {
    for (int a = 1; a < argc; ++a) {
        const std::string option = argv[a];
        const std::string value = a + 1 < argc ? argv[a + 1] : "";
        if (option == "--help" || option == "-h") {
            std::cout << usage;
            return 0;
        }
        if (option == "--quick") {
            arguments.settings.quick = true;
            arguments.command += " " + option;
            continue;
        }
        if (value.empty()) {
            return refuse("unknown option, or one without its value: " + option);
        }
        ++a;
        if (option == "--out") {
            arguments.out = value;
        } else if (option == "--data") {
            arguments.settings.data = value;
            arguments.command += " --data DIR";
        } else if (option == "--seed") {
            if (value.size() > 9 || value.find_first_not_of("0123456789") != std::string::npos) {
                return refuse("--seed needs a number, not '" + value + "'");
            }
            arguments.settings.seed = static_cast<unsigned>(std::stoul(value));
            arguments.command += " --seed " + value;
        } else if (option == "--only") {
            if (std::none_of(std::begin(parts), std::end(parts), [&](const auto& p) { return p.first == value; })) {
                return refuse("no part '" + value + "'");
            }
            arguments.only.push_back(value);
            arguments.command += " --only " + value;
        } else {
            return refuse("unknown option " + option);
        }
    }
    if (arguments.out.empty()) {
        arguments.out = arguments.settings.quick ? "study-quick" : "docs/results";
    }
    return -1;
}

/// Runs the parts; true where the user ended it early.
bool run(study::Report& report, const Arguments& arguments) {
    const auto& only = arguments.only;
    try {
        for (const auto& [name, part] : parts) {
            if (only.empty() || std::find(only.begin(), only.end(), name) != only.end()) {
                part(report, arguments.settings);
                report.end_part();
            }
        }
        return false;
    } catch (const study::Interrupted&) {
        return true;
    }
}

} // namespace

namespace study {

bool interrupted() {
    return pressed != 0;
}

void stop_if_interrupted() {
    if (interrupted()) {
        throw Interrupted();
    }
}

springfit::ProgressCallback until_interrupted() {
    return [](const springfit::Progress&) { return !interrupted(); };
}

} // namespace study

int main(int argc, char** argv) {
    Arguments arguments;
    if (const int code = read(argc, argv, arguments); code >= 0) {
        return code;
    }
#ifdef SPRINGFIT_STUDY_CHOLMOD
    springfit::cholmod::use_supernodal_factors();
#endif
#ifdef SPRINGFIT_STUDY_PARALLEL
    arguments.settings.execution = springfit::parallel::tbb();
#endif
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    try {
        study::Report report(arguments.out, arguments.command, arguments.settings.seed, arguments.settings.quick);
        const bool cut_short = run(report, arguments);
        report.end(cut_short);
        std::cout << "\nresults in " << arguments.out << std::endl;
        return cut_short ? 130 : report.has_failed() ? 1 : 0;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
