// SPDX-License-Identifier: BSD-3-Clause
#include "coarse_from_fine.hpp"

#include <springfit/cases/clamp_sets.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/score/motion_error.hpp>
#include <springfit/step/equilibrium.hpp>

#include "interrupt.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

namespace {

/// A node of the network is held where held nodes make up this part of what it is read from: whatever the meshes, the
/// network is then held where `--clamp` says.
constexpr double clamped_share = 0.5;

/// A replay whose equilibria are looked for from rest first, as those of a reference on the network's own mesh are.
template <int Dim>
Scenario<Dim, double> from_rest(const Motion<Dim, double>& motion) {
    auto scenario = replay(motion);
    if (motion.n_frames() == 1) {
        scenario.initial_positions.resize(Dim, 0);
    }
    return scenario;
}

/// Positions of the network in the frames of a case: as far as it comes in time, at rest for a single frame.
template <int Dim>
std::vector<Points<Dim, double>>
positions_under(const SpringNetwork<Dim, double>& network, const Scenario<Dim, double>& scenario,
                const Motion<Dim, double>& reference, const ProgressCallback& progress) {
    if (reference.n_frames() > 1) {
        return simulate(network, scenario, reference.times, progress).motion.positions;
    }
    EquilibriumOptions<Dim, double> how;
    how.time = reference.times.front();
    how.max_iterations = 100;
    auto rest = equilibrium(network, scenario, how);
    if (rest.status != Status::converged) {
        how.start = reference.positions.front();
        rest = equilibrium(network, scenario, how);
    }
    (void)go_on(progress, "balance", 1);
    return rest.status == Status::converged ? std::vector{rest.positions} : std::vector<Points<Dim, double>>{};
}

} // namespace

template <int Dim>
CoarseFromFine<Dim>::CoarseFromFine(const FineMesh& fine, const FitOptions& options, Discretisation<Dim>& network)
    : m_fine(fine), m_network_positions(network.network.rest_positions), m_body(body_of<Dim>(fine.mesh, options)) {
    try {
        network.network.mass = restrict_masses(fine.at_fine, m_body.masses);
    } catch (const InvalidArgument&) {
        throw InvalidArgument("--reference-nodes",
                              "a mesh so fine that every node of the network takes a share of its mass",
                              text(m_body.n_nodes(), " nodes beside ", m_network_positions.cols()));
    }
    require(holds_network(clamped_nodes<Dim>(sides_to_clamp(options), m_body.rest_positions)), "--clamp",
            "sides so deep (y-min:0.1) that they hold the network as they hold the reference",
            "too few of its nodes within");
    std::visit(
        [&]<int MeshDim, CellType Cell>(const Mesh<MeshDim, double, Cell>& mesh) {
            if constexpr (MeshDim == Dim && Cell::dimension == Dim) {
                m_surface = boundary_surface(mesh, fine.at_fine);
                m_surface_nodes = boundary_nodes(mesh);
            }
        },
        fine.mesh);
}

template <int Dim>
bool CoarseFromFine<Dim>::holds_network(const std::vector<int>& clamped) const {
    return holds_rigidly(m_network_positions, targets_of(m_fine.at_network, clamped, clamped_share));
}

template <int Dim>
ReferenceCases<Dim> CoarseFromFine<Dim>::carried_to_network(ReferenceCases<Dim> recorded) {
    m_held_out.clear();
    for (auto* set : {&recorded.training, &recorded.held_out}) {
        CaseSet<Dim> carried;
        for (auto& motion : set->motions) {
            auto at_network = transfer(motion, m_fine.at_network, m_fine.at_fine, m_network_positions, clamped_share);
            carried.scenarios.push_back(from_rest<Dim>(at_network));
            carried.motions.push_back(std::move(at_network));
            if (set == &recorded.held_out) {
                m_held_out.push_back(std::move(motion));
            }
        }
        *set = std::move(carried);
    }
    recorded.description["nodes"] = m_body.n_nodes();
    return recorded;
}

template <int Dim>
io::Json CoarseFromFine<Dim>::errors_at_fine_nodes(const SpringNetwork<Dim, double>& network,
                                                   const CaseSet<Dim>& held_out, const Execution& execution) const {
    Stage stage("score fine nodes");
    const std::size_t n = m_held_out.size();
    std::vector<Motion<Dim, double>> by_network(n);
    std::vector<Motion<Dim, double>> by_reference(n);
    std::vector<Motion<Dim, double>> fine(n);
    execution.for_chunks(static_cast<Index>(n), 1, [&](Index, Index begin, Index) {
        const auto c = static_cast<std::size_t>(begin);
        const auto& reference = held_out.motions[c];
        const auto carried = [&](const std::vector<Points<Dim, double>>& frames) {
            Motion<Dim, double> motion;
            motion.rest_positions = m_body.rest_positions;
            for (const auto& positions : frames) {
                motion.positions.push_back(
                    carry<Dim, double>(m_fine.at_fine, m_body.rest_positions, m_network_positions, positions));
            }
            return motion;
        };
        by_network[c] = carried(positions_under<Dim>(network, held_out.scenarios[c], reference, stage.callback(c, n)));
        by_reference[c] = carried(reference.positions);
        fine[c] = m_held_out[c];
        fine[c].clamped.clear(); // of all nodes: the network may move those, too
    });
    auto judged = motion_error(by_network, fine);
    if (interrupted()) {
        judged.error = std::numeric_limits<double>::infinity();
    }
    io::Json cases = io::Json::object();
    for (std::size_t c = 0; c < n; ++c) {
        cases[fine[c].name] = judged.case_errors[c];
    }
    return {{"nodes", m_body.n_nodes()},
            {"error", judged.error},
            {"error_of_carrying", motion_error(by_reference, fine).error},
            {"cases", cases}};
}

template <int Dim>
Motion<Dim, double> CoarseFromFine<Dim>::shown_at_surface() const {
    const auto& recorded = m_held_out.front();
    Motion<Dim, double> motion;
    motion.name = recorded.name;
    motion.rest_positions = m_surface.rest_positions;
    motion.times = recorded.times;
    for (std::size_t p = 0; p < m_surface_nodes.size(); ++p) {
        if (std::binary_search(recorded.clamped.begin(), recorded.clamped.end(), m_surface_nodes[p])) {
            motion.clamped.push_back(static_cast<int>(p));
        }
    }
    const auto pick = [&](const std::vector<Points<Dim, double>>& frames, std::vector<Points<Dim, double>>& picked) {
        for (const auto& frame : frames) {
            picked.push_back(frame(Eigen::all, m_surface_nodes));
        }
    };
    pick(recorded.positions, motion.positions);
    pick(recorded.velocities, motion.velocities);
    pick(recorded.accelerations, motion.accelerations);
    pick(recorded.external_forces, motion.external_forces);
    return motion;
}

template class CoarseFromFine<2>;
template class CoarseFromFine<3>;

} // namespace program
