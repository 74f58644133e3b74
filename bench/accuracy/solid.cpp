// SPDX-License-Identifier: BSD-3-Clause
#include "solid.hpp"

#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/network/builders.hpp>

namespace study {

namespace {

constexpr double most_volume_stiffness = 6; ///< of the start against a reference that does not lock, shear moduli

SpringNetwork<3, double> empty_network(const TetMesh& mesh, const NetworkKind& kind) {
    return springs_along_edges(mesh, {.second_ring = kind.second_ring, .volume = kind.volume, .density = density});
}

CauchySplit<double> capped(CauchySplit<double> split, const ReferenceKind& reference) {
    if (reference.mean_dilatation) {
        const double mu = young / (2 * (1 + reference.poisson));
        split.volume_stiffness = split.volume_stiffness.cwiseMin(most_volume_stiffness * mu);
    }
    return split;
}

/// Scores of springs and cells by `cauchy_split`, as it is and as a fit starts from it.
void add_split_scores(Row& row, const TetMesh& mesh, const ReferenceKind& reference,
                      const SpringNetwork<3, double>& network, const CaseSets<3>& sets, const Settings& settings) {
    const auto split = cauchy_split(mesh, network.springs, reference.solid());
    const auto start = capped(split, reference);
    const auto add = [&](const char* name, const CauchySplit<double>& values) {
        auto closed = network;
        apply(values, closed);
        row.scores.push_back({name, true, errors(closed, sets, settings), 0, values.springs.caveat});
    };
    add("cauchy_split", split);
    if (start.volume_stiffness != split.volume_stiffness) {
        add("cauchy_split, at most 6 mu", start);
    }
}

} // namespace

Specimen<3, double> body_of(const TetMesh& mesh, int axis, double depth) {
    Specimen<3, double> body{mesh.nodes, node_masses(mesh, density), boundary_nodes(mesh), {}};
    body.clamps = {{side_nodes<3, double>(mesh.nodes, {axis, false}, depth), {}}};
    return body;
}

SpringNetwork<3, double> prior_network(const TetMesh& mesh, const ReferenceKind& reference, const NetworkKind& kind) {
    auto network = empty_network(mesh, kind);
    if (kind.volume) {
        apply(capped(cauchy_split(mesh, network.springs, reference.solid()), reference), network);
    } else {
        apply(van_gelder(mesh, network.springs, reference.solid()), network);
    }
    return network;
}

std::vector<Score> edge_form_scores(const TetMesh& mesh, const ReferenceKind& reference, const CaseSets<3>& sets,
                                    const Settings& settings) {
    auto network = empty_network(mesh, edges_alone);
    return closed_form_scores(mesh, reference.solid(), network, sets, settings);
}

Row solid_row(const std::string& name, const TetMesh& mesh, const ReferenceKind& reference, const std::string& setup,
              const NetworkKind& kind, const CaseSets<3>& sets, const std::vector<Score>& edge_forms,
              const Methods& methods, const Settings& settings) {
    Row row;
    row.mesh = name;
    row.material = name_of(reference.material) + (reference.mean_dilatation ? ", mean dilatation" : "");
    row.poisson = reference.poisson;
    row.network = name_of(kind);
    row.setup = setup;
    if (sets.left_out() > 0) {
        row.setup += text(", ", sets.left_out(), " cases without equilibrium left out");
    }
    row.scores = edge_forms;
    auto network = prior_network(mesh, reference, kind);
    if (kind.volume) {
        add_split_scores(row, mesh, reference, network, sets, settings);
    }
    add_fits(row, network, sets, methods, settings);
    return row;
}

std::vector<Row> solid_rows(const std::string& name, const TetMesh& mesh, const Specimen<3, double>& body,
                            const ReferenceKind& reference, const CaseSettings& cases,
                            const std::vector<NetworkKind>& networks, const Methods& methods,
                            const Settings& settings) {
    const auto sets = record_solid(mesh, reference, body, cases, settings);
    const auto forms = edge_form_scores(mesh, reference, sets, settings);
    std::vector<Row> rows;
    for (const NetworkKind& kind : networks) {
        Methods own = methods;
        own.acceleration = methods.acceleration && !kind.second_ring && !kind.volume;
        rows.push_back(solid_row(name, mesh, reference, strain_text(cases.strain), kind, sets, forms, own, settings));
    }
    return rows;
}

} // namespace study
