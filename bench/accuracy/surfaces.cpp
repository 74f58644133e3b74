// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"

namespace study {

namespace {

/// A surface, the axis along which the solid in it is clamped at its lowest side, and how deep.
struct Surface {
    std::string name;
    int axis;
};

void add_bars(Report& report, const Row& row) {
    const std::string what = "Elephant, neo-Hookean, nu 0.45, " + row.setup + ", " + row.network;
    report.at_most(what + ": unseen loads", row.errors_of("trajectory").loads, 0.05);
    report.at_most(what + ": unseen kinds", row.errors_of("trajectory").kinds, 0.10);
    report.at_least(what + ": ratio to the best closed form, loads", row.ratio().loads, 5);
}

} // namespace

void study_surfaces(Report& report, const Settings& settings) {
    report.begin(
        "surfaces", "Solids bounded by surfaces",
        "The insides of surfaces from CGAL's demo data, neo-Hookean at nu = 0.45, clamped at the lowest side along an "
        "axis. A strain is that of 95 % of the edges in the linear answer; the rest is strained by up to four times as "
        "much. The reference does not lock (*mean dilatation*); one row has linear tetrahedra as they are.");
    if (settings.data.empty()) {
        report.note("Left out: no folder given by --data.");
        return;
    }
    auto how = fit_options(false, settings);
    how.matching_iterations = settings.quick ? 6 : 40;
    const ReferenceKind locking{.material = MaterialKind::neo_hookean, .poisson = 0.45};
    ReferenceKind mean = locking;
    mean.mean_dilatation = true;
    const std::vector<Surface> surfaces = {{"elephant", 1}, {"fandisk", 0}, {"knot1", 0}, {"bear", 1}};
    for (const Surface& surface : surfaces) {
        const std::string& name = surface.name;
        const bool is_main = name == "elephant";
        if (settings.quick && !is_main) {
            break;
        }
        const auto mesh = solid_mesh(settings.data / (name + ".off"), settings.quick ? 250 : is_main ? 600 : 400);
        if (!mesh) {
            report.note(name + ": left out, no solid mesh.");
            continue;
        }
        const auto body = body_of(*mesh, surface.axis, 0.05);
        const auto rows_of = [&](double strain, int training, const ReferenceKind& reference,
                                 const std::vector<NetworkKind>& networks) {
            auto cases = load_cases(training, settings);
            cases.held_out_clamp = 6;
            for (const Row& row : solid_rows(name, *mesh, body, reference, cases, strain, networks, how, settings)) {
                report.add(row);
                if (is_main && reference.mean_dilatation && row.network == name_of(with_volume)) {
                    add_bars(report, row);
                }
            }
        };
        rows_of(0.05, settings.quick ? 24 : is_main ? 60 : 36, mean, {edges_alone, with_volume});
        if (is_main && !settings.quick) {
            rows_of(0.1, 120, mean, {with_volume}); // held by a strip it swings far, and that takes more to know
            rows_of(0.05, 36, locking, {with_volume});
        }
    }
}

} // namespace study
