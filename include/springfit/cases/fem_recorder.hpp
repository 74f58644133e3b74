// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <springfit/cases/case_recorder.hpp>
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/motion/transfer.hpp>

namespace springfit {

namespace detail {

/// An elastic body that several steppers and solvers share; a model of Reference and StaticReference.
template <int Dim, std::floating_point ScalarType>
struct SharedBody {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;
    std::shared_ptr<const fem::ElasticBody<Dim, Scalar>> body;
};

template <int Dim, std::floating_point Scalar>
fem::Dynamics<Dim, Scalar> make_stepper(const SharedBody<Dim, Scalar>& shared) {
    return fem::Dynamics<Dim, Scalar>(shared.body);
}

template <int Dim, std::floating_point Scalar>
fem::Statics<Dim, Scalar> make_static_solver(const SharedBody<Dim, Scalar>& shared) {
    return fem::Statics<Dim, Scalar>(shared.body);
}

} // namespace detail

/// A finite element body at its vertices: load cases and recordings know no others, whatever nodes lie on its edges.
///
/// Loads on a node in the middle of an edge are handed to the edge's ends; it is clamped where both of them are.
template <int Dim, std::floating_point Scalar>
class FemRecorder final : public CaseRecorder<Dim, Scalar> {
public:
    using Base = CaseRecorder<Dim, Scalar>;
    using Body = std::shared_ptr<const fem::ElasticBody<Dim, Scalar>>;

    /// `make_body(beta)` makes the body with that stiffness damping; its vertices come first, at `vertices`
    /// `[Dim x n]`. `between` are the interpolations between the two, empty where there are no other nodes.
    FemRecorder(const Points<Dim, Scalar>& vertices, std::function<Body(Scalar beta)> make_body,
                std::optional<CornerInterpolations<Scalar>> between)
        : m_vertices(vertices), m_make_body(std::move(make_body)), m_between(std::move(between)),
          m_body{m_make_body(Scalar(0))} {}

    [[nodiscard]] bool is_linear() const override { return m_body.body->kind().is_linear; }
    [[nodiscard]] bool finds_equilibria() const override { return true; }
    [[nodiscard]] bool takes_damping() const override { return true; }
    [[nodiscard]] Scalar stiffness_damping() const override { return 0; }

    [[nodiscard]] std::vector<Points<Dim, Scalar>>
    linear_responses(const typename Base::Scenarios& scenarios,
                     const StaticRecordOptions<Scalar>& options) const override {
        auto responses = springfit::linear_responses(m_body, at_all_nodes(scenarios), options);
        for (auto& response : responses) {
            response = response.leftCols(std::min(response.cols(), m_vertices.cols())).eval();
        }
        return responses;
    }

    [[nodiscard]] Recording<Dim, Scalar> record(const Scenario<Dim, Scalar>& scenario, Scalar beta,
                                                const RecordOptions<Scalar>& options) const override {
        const detail::SharedBody<Dim, Scalar> damped{m_make_body(beta)};
        return at_vertices(springfit::record(damped, at_all_nodes(scenario), options));
    }

    [[nodiscard]] typename Base::Recordings record_statics(const typename Base::Scenarios& scenarios,
                                                           const StaticRecordOptions<Scalar>& options) const override {
        auto recordings = springfit::record_statics(m_body, at_all_nodes(scenarios), options);
        for (auto& recording : recordings) {
            recording = at_vertices(std::move(recording));
        }
        return recordings;
    }

private:
    [[nodiscard]] Scenario<Dim, Scalar> at_all_nodes(Scenario<Dim, Scalar> scenario) const {
        if (m_between) {
            for (auto& clamp : scenario.clamps) {
                clamp.nodes = targets_of(m_between->at_nodes, clamp.nodes);
            }
        }
        return scenario;
    }

    [[nodiscard]] typename Base::Scenarios at_all_nodes(const typename Base::Scenarios& scenarios) const {
        typename Base::Scenarios result;
        for (const auto& scenario : scenarios) {
            result.push_back(at_all_nodes(scenario));
        }
        return result;
    }

    [[nodiscard]] Recording<Dim, Scalar> at_vertices(Recording<Dim, Scalar> recording) const {
        if (m_between && recording.motion.n_frames() > 0) {
            recording.motion = transfer(recording.motion, m_between->at_corners, m_between->at_nodes, m_vertices);
        }
        return recording;
    }

    Points<Dim, Scalar> m_vertices;
    std::function<Body(Scalar)> m_make_body;
    std::optional<CornerInterpolations<Scalar>> m_between; ///< between vertices and all nodes
    detail::SharedBody<Dim, Scalar> m_body;                ///< without damping
};

/// The dilatation with which a cell is a reference for any Poisson's ratio below 1/2: linear solids lock without a
/// mean.
template <CellType Cell>
inline constexpr fem::Dilatation reference_dilatation =
    Cell::dimension == 3 && Cell::n_nodes == Cell::n_corners ? fem::Dilatation::mean : fem::Dilatation::pointwise;

/// Records the finite element model of a mesh, its material and density rho, kg/m^3, with the damping that it is told;
/// `Model` refuses what it cannot use, at once. The vertices of a quadratic mesh come first, as `quadratic(mesh)` has
/// them.
template <int Dim, std::floating_point Scalar, CellType Cell, fem::Material Mat>
[[nodiscard]] FemRecorder<Dim, Scalar> fem_recorder(const Mesh<Dim, Scalar, Cell>& mesh, const Mat& material,
                                                    double density, const fem::ModelOptions<Scalar>& options = {}) {
    std::optional<CornerInterpolations<Scalar>> between;
    Points<Dim, Scalar> vertices = mesh.nodes;
    if constexpr (Cell::n_nodes > Cell::n_corners) {
        const std::vector<int> corners = corner_nodes(mesh);
        require(corners.back() + 1 == static_cast<int>(corners.size()), "mesh", "vertices before all other nodes",
                text("vertex ", corners.back(), " as one of ", corners.size()));
        between = corner_interpolations(mesh);
        vertices = mesh.nodes.leftCols(static_cast<Index>(corners.size()));
    }
    const auto make_body = [=](Scalar beta) {
        auto damped = options;
        damped.stiffness_damping = beta;
        return std::make_shared<const fem::Model<Dim, Scalar, Cell, Mat>>(mesh, material, density, damped);
    };
    return {vertices, make_body, std::move(between)};
}

} // namespace springfit
