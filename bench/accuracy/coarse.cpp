// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/motion/replay.hpp>

#include "solid.hpp"

namespace study {

namespace {

/// A fine body seen from a coarse mesh.
struct Transfer {
    Interpolation<double> at_coarse; ///< fine nodes to coarse nodes
    Interpolation<double> at_fine;   ///< coarse nodes to fine nodes
    TetMesh coarse;

    [[nodiscard]] Cases<3> operator()(const Cases<3>& fine) const {
        Cases<3> result;
        result.left_out = fine.left_out;
        for (const auto& motion : fine.motions) {
            auto moved = transfer<3, double>(motion, at_coarse, at_fine, coarse.nodes);
            result.add(replay(moved), moved);
        }
        return result;
    }
};

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
    const Transfer carried{*at_coarse, *at_fine, coarse};
    const auto ratios = settings.quick ? std::vector{0.25} : std::vector{0.25, 0.45};
    for (double poisson : ratios) {
        const ReferenceKind reference{.poisson = poisson, .mean_dilatation = poisson >= 0.45};
        CaseSettings cases;
        cases.training = settings.quick ? 60 : 120;
        const auto sets = record_solid(fine, reference, body_of(fine), cases, settings);
        const CaseSets<3> moved{carried(sets.training), carried(sets.loads), carried(sets.kinds), carried(sets.clamp)};
        const std::string setup = text("reference of ", fine.n_nodes(), " nodes");
        const auto forms = edge_form_scores(coarse, reference, moved, settings);
        for (const NetworkKind& kind : {edges_alone, with_volume, with_both}) {
            const Row row = solid_row("box, tetrahedra", coarse, reference, setup, kind, moved, forms,
                                      {.acceleration = !kind.volume && poisson == 0.25}, settings);
            report.add(row);
            const std::string what = text("Network of 1/8 of the nodes, ", row.network, ", nu ", poisson);
            report.at_least(what + ": ratio to the best closed form, loads", row.ratio().loads, 3);
            report.at_least(what + ": ratio, kinds", row.ratio().kinds, 3);
        }
    }
}

} // namespace study
