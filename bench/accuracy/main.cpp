// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <iostream>

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
    "  --quick     a part of it\n"
    "  --out DIR   where to write (docs/results; quick: study-quick)\n"
    "  --data DIR  a folder with elephant.off and other surfaces; without it they are left out\n"
    "  --seed N    of all load cases (1)\n"
    "  --only PART plane or solids; may be given again\n";

} // namespace

namespace study {

bool interrupted() { return pressed != 0; }

} // namespace study

int main(int argc, char** argv) {
    using namespace study;
    Settings settings;
    std::string out;
    std::string command = "springfit_study";
    std::vector<std::string> only;
    for (int a = 1; a < argc; ++a) {
        const std::string option = argv[a];
        const bool has_value = a + 1 < argc;
        if (option == "--quick") {
            settings.quick = true;
            command += " --quick";
        } else if (option == "--out" && has_value) {
            out = argv[++a];
        } else if (option == "--data" && has_value) {
            settings.data = argv[++a];
            command += " --data DIR";
        } else if (option == "--seed" && has_value) {
            try {
                settings.seed = static_cast<unsigned>(std::stoul(argv[++a]));
            } catch (const std::exception&) {
                std::cerr << "--seed needs a number, not '" << argv[a] << "'\n";
                return 2;
            }
            command += " --seed " + std::string(argv[a]);
        } else if (option == "--only" && has_value) {
            only.emplace_back(argv[++a]);
            command += " --only " + only.back();
        } else {
            const bool help = option == "--help" || option == "-h";
            (help ? std::cout : std::cerr) << (help ? "" : "unknown option, or one without its value: " + option + "\n")
                                           << usage;
            return help ? 0 : 2;
        }
    }
    if (out.empty()) {
        out = settings.quick ? "study-quick" : "docs/results";
    }
#ifdef SPRINGFIT_STUDY_PARALLEL
    settings.execution = springfit::parallel::tbb();
#endif
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    using Part = void (*)(Report&, const Settings&);
    const std::vector<std::pair<std::string, Part>> parts = {
        {"plane", study_plane}, {"solids", study_solids}};
    for (const std::string& wanted : only) {
        if (std::none_of(parts.begin(), parts.end(), [&](const auto& part) { return part.first == wanted; })) {
            std::cerr << "no part '" << wanted << "'\n" << usage;
            return 2;
        }
    }
    try {
        Report report(out, command, settings.seed, settings.quick);
        for (const auto& [name, part] : parts) {
            if (!interrupted() && (only.empty() || std::find(only.begin(), only.end(), name) != only.end())) {
                part(report, settings);
            }
        }
        report.end(interrupted());
        std::cout << "\n" << report.n_rows() << " rows in " << out << std::endl;
        return interrupted() ? 130 : report.n_rows() > 0 ? 0 : 1;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
