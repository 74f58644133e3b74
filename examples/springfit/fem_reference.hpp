// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/cases/strain.hpp>
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/transfer.hpp>
#include <springfit/solve/symmetric_solver.hpp>

#include "reference.hpp"

namespace program {

/// The FEM reference of one kind of cell and material. `Cell` may have nodes on its edges; scenarios and recordings
/// know the vertices only, which have the same numbers.
template <int Dim, springfit::CellType Cell, class Material>
class FemReferenceOf final : public FemReference<Dim> {
public:
    using Scenario = typename FemReference<Dim>::Scenario;
    using CornerMesh = springfit::Mesh<Dim, double, springfit::LinearCell<Cell>>;

    FemReferenceOf(const CornerMesh& mesh, const Material& material, double density,
                   const springfit::fem::ModelOptions<double>& options, std::string element)
        : m_corner_mesh(mesh), m_mesh(to_cells(mesh)), m_material(material), m_density(density), m_options(options),
          m_element(std::move(element)) {
        (void)springfit::fem::Model(m_mesh, m_material, m_density, m_options); // refuses what cannot be used, early
    }

    [[nodiscard]] std::vector<LinearResponse> respond(const std::vector<Scenario>& scenarios) const override {
        using namespace springfit;
        const fem::LinearElastic linear{.young = m_material.young, .poisson = std::min(m_material.poisson, 0.3)};
        auto options = m_options;
        options.dilatation = fem::Dilatation::pointwise;
        const fem::Model model(m_corner_mesh, linear, m_density, options);
        const FreeNodes free(m_corner_mesh.n_nodes(),
                             springfit::clamped_nodes(scenarios.front(), m_corner_mesh.n_nodes()));
        SymmetricSolver<double> solver;
        const auto stiffness = model.stiffness(model.rest_positions(), free);
        require(solver.factorise(stiffness) && solver.shift() == 0, "--clamp",
                "sides that keep the body from moving as a whole: a deeper one (y-min:0.1; y-min alone, without the "
                "option, "
                "is 0.05 deep) or a finer mesh (--nodes) has more nodes",
                text("one that still can, with ", m_corner_mesh.n_nodes() - free.n_free(), " nodes held"));
        std::vector<LinearResponse> responses;
        for (const Scenario& scenario : scenarios) {
            const Points<Dim, double> forces = external_forces(scenario, model.masses(), 0.);
            const Values<double> load = free.gather(forces);
            const Values<double> displacement = solver.apply_factor(load);
            Points<Dim, double> u = Points<Dim, double>::Zero(Dim, m_corner_mesh.n_nodes());
            free.scatter(displacement, u);
            const double inertia = (u.colwise().squaredNorm() * model.masses())(0);
            responses.push_back({u.colwise().norm().maxCoeff(), std::sqrt(load.dot(displacement) / inertia)});
        }
        return responses;
    }

    [[nodiscard]] springfit::Recording<Dim, double> record(const Scenario& scenario, double beta,
                                                           const springfit::RecordOptions<double>& how) const override {
        auto options = m_options;
        options.stiffness_damping = beta;
        const springfit::fem::Model model(m_mesh, m_material, m_density, options);
        auto recording = springfit::record(model, with_edge_nodes(scenario), how);
        if constexpr (has_edge_nodes) { // what acts on a node in the middle of an edge acts on the edge's ends
            const auto [at_corners, at_nodes] = springfit::corner_interpolations(m_mesh);
            recording.motion = springfit::transfer(recording.motion, at_corners, at_nodes, m_corner_mesh.nodes);
        }
        return recording;
    }

    [[nodiscard]] std::vector<springfit::Recording<Dim, double>>
    record_statics(std::vector<Scenario>& scenarios, double strain,
                   const springfit::StaticRecordOptions<double>& how) const override {
        const springfit::fem::Model model(m_mesh, m_material, m_density, m_options);
        const auto at_all_nodes = [&](const std::vector<Scenario>& cases) {
            std::vector<Scenario> result;
            for (const Scenario& scenario : cases) {
                result.push_back(with_edge_nodes(scenario));
            }
            return result;
        };
        const auto respond = [&](const std::vector<Scenario>& cases) {
            auto quiet = how;
            quiet.progress = {};
            auto responses = springfit::linear_responses(model, at_all_nodes(cases), quiet);
            for (auto& response : responses) { // vertices come first
                response = response.leftCols(std::min(response.cols(), m_corner_mesh.n_nodes())).eval();
            }
            return responses;
        };
        (void)springfit::scale_to_strain(scenarios, springfit::edges(m_corner_mesh), m_corner_mesh.nodes, strain,
                                         respond);
        auto recordings = springfit::record_statics(model, at_all_nodes(scenarios), how);
        if constexpr (has_edge_nodes) {
            const auto [at_corners, at_nodes] = springfit::corner_interpolations(m_mesh);
            for (auto& recording : recordings) {
                if (recording.motion.n_frames() > 0) {
                    recording.motion = springfit::transfer(recording.motion, at_corners, at_nodes, m_corner_mesh.nodes);
                }
            }
        }
        return recordings;
    }

    [[nodiscard]] std::string element() const override { return m_element; }

private:
    static constexpr bool has_edge_nodes = Cell::n_nodes > Cell::n_corners;

    static auto to_cells(const CornerMesh& mesh) {
        if constexpr (has_edge_nodes) {
            return springfit::quadratic(mesh);
        } else {
            return mesh;
        }
    }

    /// A node in the middle of an edge is clamped where both ends of the edge are.
    [[nodiscard]] Scenario with_edge_nodes(Scenario scenario) const {
        if constexpr (has_edge_nodes) {
            for (auto& clamp : scenario.clamps) {
                std::vector<bool> held(static_cast<std::size_t>(m_mesh.n_nodes()), false);
                for (int node : clamp.nodes) {
                    held[static_cast<std::size_t>(node)] = true;
                }
                for (springfit::Index c = 0; c < m_mesh.n_cells(); ++c) {
                    for (std::size_t e = 0; e < Cell::edges.size(); ++e) {
                        const auto is_held = [&](int corner) {
                            return held[static_cast<std::size_t>(m_mesh.cells(corner, c))];
                        };
                        const int middle = m_mesh.cells(Cell::n_corners + static_cast<int>(e), c);
                        if (is_held(Cell::edges[e][0]) && is_held(Cell::edges[e][1]) &&
                            !held[static_cast<std::size_t>(middle)]) {
                            held[static_cast<std::size_t>(middle)] = true;
                            clamp.nodes.push_back(middle);
                        }
                    }
                }
            }
        }
        return scenario;
    }

    CornerMesh m_corner_mesh;
    springfit::Mesh<Dim, double, Cell> m_mesh;
    Material m_material;
    double m_density;
    springfit::fem::ModelOptions<double> m_options;
    std::string m_element;
};

/// The reference of one kind of cell for the material that is asked for by name.
template <int Dim, springfit::CellType Cell>
[[nodiscard]] std::unique_ptr<FemReference<Dim>>
make_for_material(const springfit::Mesh<Dim, double, springfit::LinearCell<Cell>>& mesh, const FitOptions& options,
                  springfit::fem::Dilatation dilatation, const std::string& element) {
    using namespace springfit;
    fem::ModelOptions<double> model;
    model.thickness = options.thickness.value_or(1);
    model.dilatation = dilatation;
    const auto with = [&]<class Material>(const Material& material) -> std::unique_ptr<FemReference<Dim>> {
        return std::make_unique<FemReferenceOf<Dim, Cell, Material>>(mesh, material, options.density, model, element);
    };
    const std::string name = options.material.value_or("neo-hookean");
    if (name == "linear") {
        return with(fem::LinearElastic{.young = options.young, .poisson = options.poisson});
    }
    if (name == "corotated") {
        return with(fem::Corotated{.young = options.young, .poisson = options.poisson});
    }
    if (name == "st-venant-kirchhoff") {
        return with(fem::StVenantKirchhoff{.young = options.young, .poisson = options.poisson});
    }
    require(name == "neo-hookean", "--material", "linear, corotated, st-venant-kirchhoff or neo-hookean", name);
    return with(fem::NeoHookean{.young = options.young, .poisson = options.poisson});
}

// One translation unit for each kind of cell: reference_<cell>.cpp.
std::unique_ptr<FemReference<2>> reference_tri3(const springfit::Mesh<2, double, springfit::Tri3>& mesh,
                                                const FitOptions& options);
std::unique_ptr<FemReference<2>> reference_tri6(const springfit::Mesh<2, double, springfit::Tri3>& mesh,
                                                const FitOptions& options);
std::unique_ptr<FemReference<2>> reference_quad4(const springfit::Mesh<2, double, springfit::Quad4>& mesh,
                                                 const FitOptions& options);
std::unique_ptr<FemReference<3>> reference_tet4(const springfit::Mesh<3, double, springfit::Tet4>& mesh,
                                                const FitOptions& options, springfit::fem::Dilatation dilatation);
std::unique_ptr<FemReference<3>> reference_tet10(const springfit::Mesh<3, double, springfit::Tet4>& mesh,
                                                 const FitOptions& options);
std::unique_ptr<FemReference<3>> reference_hex8(const springfit::Mesh<3, double, springfit::Hex8>& mesh,
                                                const FitOptions& options);

} // namespace program
