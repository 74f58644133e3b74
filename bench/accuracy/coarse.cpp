// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/cases/coarse_cases.hpp>

#include "solid.hpp"

namespace study {

namespace {

/// What a fine body did, as a network on a coarse mesh has it.
RecordedCases<3, double> carried(const RecordedCases<3, double>& fine, const FineNodes<3>& nodes,
                                 const TetMesh& coarse) {
    RecordedCases<3, double> result;
    result.training = at_network(fine.training, nodes, coarse.nodes);
    result.held_out = at_network(fine.held_out, nodes, coarse.nodes);
    result.warnings = fine.warnings;
    return result;
}

} // namespace

void study_coarse(Report& report, const Settings& settings) {
    report.begin(
        "coarse", "Networks coarser than the reference",
        "A network on a mesh of an eighth of the reference's nodes: positions are read off where its nodes lie in the "
        "reference, forces are handed over by the adjoint. The closed forms are those of the coarse "
        "mesh; small strain, the linear material.");
    const TetMesh fine = box_mesh(box_size, settings.quick ? 480 : 1200);
    const TetMesh coarse = box_mesh(box_size, settings.quick ? 60 : 150);
    const auto at_coarse = interpolation_at(fine, coarse.nodes);
    const auto at_fine = interpolation_at(coarse, fine.nodes);
    if (!at_coarse || !at_fine) {
        report.note("Left out: built without CGAL.");
        return;
    }
    const FineNodes<3> nodes{fine.nodes, *at_coarse, *at_fine};
    const auto ratios = settings.quick ? std::vector{0.25} : std::vector{0.25, 0.45};
    for (double poisson : ratios) {
        const ReferenceKind reference{.poisson = poisson, .mean_dilatation = poisson >= 0.45};
        const auto loads = load_cases(settings.quick ? 60 : 120, settings);
        const auto cases = carried(
            equilibria(recorder_of(fine, reference), body_of(fine), loads, small_strain, settings), nodes, coarse);
        const std::string setup = text("reference of ", fine.n_nodes(), " nodes");
        const auto forms = edge_form_scores(coarse, reference, cases, settings);
        for (const NetworkKind& kind : {edges_alone, with_volume, with_both}) {
            const Row row = solid_row("box, tetrahedra", coarse, reference, setup, kind, cases, forms,
                                      fit_options(!kind.volume && poisson == 0.25, settings));
            report.add(row);
            const std::string what = text("Network of 1/8 of the nodes, ", row.network, ", nu ", poisson);
            report.at_least(what + ": ratio to the best closed form, loads", row.ratio().loads, 3);
            report.at_least(what + ": ratio, kinds", row.ratio().kinds, 3);
        }
    }
}

} // namespace study
