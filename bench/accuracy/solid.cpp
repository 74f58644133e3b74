// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"

#include <springfit/network/builders.hpp>

namespace study {

namespace {

constexpr double most_volume_stiffness = 6; ///< of the start against a reference that does not lock, shear moduli

SpringNetwork<3, double> empty_network(const TetMesh& mesh, const NetworkKind& kind) {
    return springs_along_edges(mesh, {.second_ring = kind.second_ring, .volume = kind.volume, .density = density});
}

} // namespace

Specimen<3, double> body_of(const TetMesh& mesh, int axis, double depth) {
    auto body = specimen_of(mesh, density);
    body.clamps = {{side_nodes<3, double>(mesh.nodes, {axis, false}, depth), {}}};
    return body;
}

std::vector<NamedNetwork<3>> edge_forms(const TetMesh& mesh, const ReferenceKind& reference) {
    return closed_form_networks(mesh, empty_network(mesh, edges_alone), reference.solid());
}

std::vector<NamedNetwork<3>> start_of(const TetMesh& mesh, const ReferenceKind& reference, const NetworkKind& kind) {
    const auto network = empty_network(mesh, kind);
    if (!kind.volume) {
        std::vector<NamedNetwork<3>> start{{"van_gelder", network}};
        apply(van_gelder(mesh, network.springs, reference.solid()), start.front().network);
        return start;
    }
    auto split = closed_form_networks(mesh, network, reference.solid()).back();
    NamedNetwork<3> start = split;
    auto& volume_stiffness = start.network.volume_stiffness;
    if (reference.mean_dilatation) {
        const double mu = young / (2 * (1 + reference.poisson));
        volume_stiffness = volume_stiffness.cwiseMin(most_volume_stiffness * mu);
    }
    if (volume_stiffness == split.network.volume_stiffness) {
        return {split};
    }
    start.name = "cauchy_split, at most 6 mu";
    return {split, start};
}

std::vector<Score> edge_form_scores(const TetMesh& mesh, const ReferenceKind& reference,
                                    const RecordedCases<3, double>& cases, const Settings& settings) {
    auto how = fit_options(false, settings);
    how.method = Method::closed_form;
    Row row;
    add_scores(row, edge_forms(mesh, reference), cases, how);
    return row.scores;
}

Row solid_row(const std::string& name, const TetMesh& mesh, const ReferenceKind& reference, const std::string& setup,
              const NetworkKind& kind, const RecordedCases<3, double>& cases, const std::vector<Score>& forms,
              const CalibrateOptions& how) {
    Row row;
    row.mesh = name;
    row.material = name_of(reference.material) + (reference.mean_dilatation ? ", mean dilatation" : "");
    row.poisson = reference.poisson;
    row.network = name_of(kind);
    row.setup = setup;
    if (!cases.warnings.empty()) {
        row.setup += text(", ", cases.warnings.size(), " cases without equilibrium left out");
    }
    row.scores = forms;
    const auto start = start_of(mesh, reference, kind);
    auto own = how;
    own.start = start.size() - 1;
    add_scores(row, start, cases, own);
    return row;
}

std::vector<Row> solid_rows(const std::string& name, const TetMesh& mesh, const Specimen<3, double>& body,
                            const ReferenceKind& reference, const LoadCaseOptions& cases, double strain,
                            const std::vector<NetworkKind>& networks, const CalibrateOptions& how,
                            const Settings& settings) {
    const auto recorded = equilibria(recorder_of(mesh, reference), body, cases, strain, settings);
    const auto forms = edge_form_scores(mesh, reference, recorded, settings);
    std::vector<Row> rows;
    for (const NetworkKind& kind : networks) {
        auto own = how;
        own.method = kind.second_ring || kind.volume ? Method::trajectory : how.method;
        rows.push_back(solid_row(name, mesh, reference, strain_text(strain), kind, recorded, forms, own));
    }
    return rows;
}

} // namespace study
