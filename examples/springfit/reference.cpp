// SPDX-License-Identifier: BSD-3-Clause
#include "fem_reference.hpp"

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

} // namespace

template <>
std::unique_ptr<FemReference<2>> make_fem_reference<2>(const AnyMesh& mesh, const FitOptions& options) {
    if (const auto* triangles = std::get_if<Mesh<2, double, Tri3>>(&mesh)) {
        const std::string element = element_for(options, "triangle", {"tri3", "tri6"});
        return element == "tri3" ? reference_tri3(*triangles, options) : reference_tri6(*triangles, options);
    }
    (void)element_for(options, "quadrilateral", {"quad4"});
    return reference_quad4(std::get<Mesh<2, double, Quad4>>(mesh), options);
}

template <>
std::unique_ptr<FemReference<3>> make_fem_reference<3>(const AnyMesh& mesh, const FitOptions& options) {
    if (const auto* tets = std::get_if<Mesh<3, double, Tet4>>(&mesh)) {
        const std::string element = element_for(options, "tetrahedron", {"tet4-mean-dilatation", "tet4", "tet10"});
        if (element == "tet10") {
            return reference_tet10(*tets, options);
        }
        return reference_tet4(*tets, options, element == "tet4" ? fem::Dilatation::pointwise : fem::Dilatation::mean);
    }
    require(!std::holds_alternative<Mesh<3, double, Tri3>>(mesh), "INPUT",
            "a solid (a membrane needs a recorded --reference)", "triangles in space");
    (void)element_for(options, "hexahedron", {"hex8"});
    return reference_hex8(std::get<Mesh<3, double, Hex8>>(mesh), options);
}

} // namespace program
