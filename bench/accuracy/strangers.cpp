// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <map>

#include <springfit/calibrate/calibrate.hpp>

#include "study.hpp"

namespace study {

using namespace springfit;

namespace {

constexpr double young = 5e4;
constexpr double density = 1000;

template <int Dim, class Cell>
using MeshOf = Mesh<Dim, double, Cell>;

/// How many held-out cases a candidate fails in, and how, in words.
template <int Dim>
std::string failures_of(const Candidate<Dim>& candidate) {
    std::map<Status, int> how;
    for (const Status status : candidate.held_out.statuses) {
        if (status != Status::converged && status != Status::interrupted) {
            ++how[status];
        }
    }
    std::string words;
    for (const auto& [status, count] : how) {
        words += text(words.empty() ? "" : ", ", count, status == Status::diverged ? " fly apart" : " find no balance");
    }
    return words.empty() ? "" : candidate.name + ": " + words;
}

/// The closed form with the least error.
template <int Dim>
const Candidate<Dim>* best_closed_form(const Calibration<Dim>& result) {
    const Candidate<Dim>* best = nullptr;
    for (const auto& candidate : result.candidates) {
        const bool is_given = !candidate.acceleration && !candidate.trajectory;
        if (is_given && (best == nullptr || candidate.held_out.error < best->held_out.error)) {
            best = &candidate;
        }
    }
    return best;
}

/// Calibrates bodies with the defaults alone, as someone does who has only a mesh and a material.
class Newcomer {
public:
    Newcomer(Report& report, const Settings& settings) : m_report(report), m_settings(settings) {
        m_table = {.name = "strangers",
                   .text = "Held-out errors: motions in time / equilibria of trained kinds / of unseen kinds. *closed "
                           "form*: the one with the least error, likewise. *failed*: held-out cases that a candidate "
                           "does not come through, of the returned network and of the fits that were left.",
                   .columns = {"body", "nodes", "nu", "verdict", "returned", "springs and cells", "held-out", "parts",
                               "closed form", "parts of that", "failed", "s"}};
    }

    template <int Dim, class Cell>
    void try_body(const std::string& name, const MeshOf<Dim, Cell>& mesh, double poisson) {
        stop_if_interrupted();
        const Stopwatch stopwatch;
        BodyOptions<Dim> body;
        body.density = density;
        body.clamped = side_nodes(mesh.nodes, {1, false});
        body.how.execution = m_settings.execution;
        body.how.progress = until_interrupted();
        if (m_settings.quick) {
            body.record.training_equilibria = 18;
            body.record.training_motions = 1;
            body.how.matching_iterations = 4;
        }
        std::vector<std::string> line{name, text(mesh.n_nodes()), number(poisson)};
        try {
            const auto result = calibrate(mesh, fem::NeoHookean{.young = young, .poisson = poisson}, body);
            add(result, line);
        } catch (const InvalidArgument& error) { // as of clamps that do not hold a body of several pieces
            line.insert(line.end(), {"refused", error.what(), "", "", "", "", "", ""});
        }
        line.push_back(number(stopwatch.seconds()));
        m_table.lines.push_back(line);
        m_report.table(m_table);
    }

private:
    template <int Dim>
    static std::string parts_of(const Candidate<Dim>& candidate, const Calibration<Dim>& result) {
        std::string parts;
        for (const auto& [part, error] : held_out_parts(candidate, result.cases.held_out)) {
            parts += (parts.empty() ? "" : " / ") + number(error);
        }
        return parts;
    }

    template <int Dim>
    void add(const Calibration<Dim>& result, std::vector<std::string>& line) {
        const auto& best = result.best();
        std::string failed = failures_of(best);
        for (const auto& candidate : result.candidates) {
            if (const auto words = failures_of(candidate); candidate.trajectory && &candidate != &best) {
                failed += (failed.empty() || words.empty() ? "" : "; ") + words;
            }
        }
        const auto* closed = best_closed_form(result);
        line.insert(line.end(), {std::string(to_string(result.verdict)), best.name, text(best.n_parts()),
                                 number(best.held_out.error), parts_of(best, result)});
        line.insert(line.end(), {closed == nullptr ? "" : closed->name + " " + number(closed->held_out.error),
                                 closed == nullptr ? "" : parts_of(*closed, result), failed});
    }

    Report& m_report;
    const Settings& m_settings;
    Table m_table;
};

/// A plate .4 x .15 m with a round hole.
Mesh<2, double, Tri3> plate_with_hole(Index n_nodes) {
    return perforated_rectangle(0.4, 0.15, 0.03, n_nodes);
}

} // namespace

void study_strangers(Report& report, const Settings& settings) {
    report.begin(
        "strangers", "Bodies of strangers, with the defaults",
        "What `springfit fit BODY --young 5e4 --poisson NU --density 1000` does with bodies that nothing was "
        "tuned on: slender, thin, in pieces, with holes, and surfaces from CGAL's demo data. Held at the lowest "
        "5 % in y.");
    Newcomer newcomer(report, settings);
    const auto box = [&](const char* name, const std::array<double, 3>& size, Index n_nodes, double poisson) {
        newcomer.try_body(name, box_mesh(size, n_nodes), poisson);
    };
    if (settings.quick) {
        box("block", {0.3, 1, 0.3}, 80, 0.45);
        newcomer.try_body("plate with a hole", plate_with_hole(80), 0.3);
        return;
    }
    box("block", {0.3, 1, 0.3}, 363, 0.45);
    box("rod, 10:1", {0.1, 1, 0.1}, 600, 0.3);
    box("rod, 40:1", {0.025, 1, 0.025}, 600, 0.3);
    box("plate, 20:1", {1, 1, 0.05}, 600, 0.3);
    if (const auto ring = ring_mesh(0.5, 0.05, 600)) {
        newcomer.try_body("ring, 20:1", *ring, 0.3);
    }
    if (const auto boxes = two_boxes_mesh({0.2, 1, 0.2}, 0.1, 600)) {
        newcomer.try_body("two pieces", *boxes, 0.3);
    }
    for (const Index n_nodes : {80, 150, 300, 900}) {
        newcomer.try_body("plate with a hole", plate_with_hole(n_nodes), 0.3);
    }
    if (settings.data.empty()) {
        report.note("Surfaces are left out: no folder given by --data.");
        return;
    }
    const auto surface = [&](const std::string& name, Index n_nodes, double poisson) {
        if (const auto mesh = solid_mesh(settings.data / (name + ".off"), n_nodes)) {
            newcomer.try_body(name, *mesh, poisson);
        } else {
            report.note(name + ": left out, no solid mesh.");
        }
    };
    for (const Index n_nodes : {300, 1000, 2000}) {
        surface("elephant", n_nodes, 0.45);
    }
    for (const std::string name : {"bear", "femur", "homer"}) {
        surface(name, 600, 0.25);
        surface(name, 600, 0.45);
    }
}

} // namespace study
