// SPDX-License-Identifier: BSD-3-Clause
// The finite element model that `--element` and `--material` name.

#include <springfit/cases/fem_recorder.hpp>
#include <springfit/fem/material.hpp>
#include <springfit/mesh/structured.hpp>

#include "body.hpp"

namespace program {

using namespace springfit;

namespace {

/// The element asked for, or the cell's own default. Throws InvalidArgument unless it is one of `choices`.
std::string element_for(const FitOptions& options, std::string_view cell,
                        std::initializer_list<std::string_view> choices) {
    const std::string element = options.element.value_or(std::string(*choices.begin()));
    std::string list;
    for (std::string_view choice : choices) {
        list += (list.empty() ? "" : ", ") + std::string(choice);
    }
    require(std::find(choices.begin(), choices.end(), element) != choices.end(), "--element",
            text("one of ", list, " for ", cell, " cells"), element);
    return element;
}

/// The model of a mesh for the material that is asked for by name.
template <int Dim, CellType Cell>
FemReference<Dim> of_material(const Mesh<Dim, double, Cell>& mesh, const FitOptions& options, std::string element,
                              fem::Dilatation dilatation = reference_dilatation<Cell>) {
    fem::ModelOptions<double> model;
    model.thickness = options.thickness.value_or(1);
    model.dilatation = dilatation;
    const auto with = [&]<class Material>(const Material& material) -> FemReference<Dim> {
        return {std::make_unique<FemRecorder<Dim, double>>(fem_recorder(mesh, material, options.density, model)),
                std::move(element)};
    };
    const std::string name = options.material.value_or(default_material);
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

} // namespace

template <>
FemReference<2> make_fem_reference<2>(const AnyMesh& mesh, const FitOptions& options) {
    if (const auto* triangles = std::get_if<Mesh<2, double, Tri3>>(&mesh)) {
        const std::string element = element_for(options, "triangle", {"tri3", "tri6"});
        return element == "tri3" ? of_material(*triangles, options, element)
                                 : of_material(quadratic(*triangles), options, element);
    }
    return of_material(std::get<Mesh<2, double, Quad4>>(mesh), options,
                       element_for(options, "quadrilateral", {"quad4"}));
}

template <>
FemReference<3> make_fem_reference<3>(const AnyMesh& mesh, const FitOptions& options) {
    if (const auto* tets = std::get_if<Mesh<3, double, Tet4>>(&mesh)) {
        const std::string element = element_for(options, "tetrahedron", {"tet4-mean-dilatation", "tet4", "tet10"});
        return element == "tet10"  ? of_material(quadratic(*tets), options, element)
               : element == "tet4" ? of_material(*tets, options, element, fem::Dilatation::pointwise)
                                   : of_material(*tets, options, element, fem::Dilatation::mean);
    }
    require(!std::holds_alternative<Mesh<3, double, Tri3>>(mesh), "INPUT",
            "a solid (a membrane needs a recorded --reference)", "triangles in space");
    return of_material(std::get<Mesh<3, double, Hex8>>(mesh), options, element_for(options, "hexahedron", {"hex8"}));
}

} // namespace program
