// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/io/detail/gmsh.hpp>
#include <springfit/io/detail/mesh_formats.hpp>
#include <springfit/io/detail/vtk.hpp>
#include <springfit/io/mesh_file.hpp>

namespace springfit::io {

inline MeshFile read_mesh(const std::filesystem::path& path) {
    const std::string ending = detail::lower_extension(path);
    if (ending == ".node" || ending == ".ele") {
        return detail::read_tetgen(path);
    }
    if (ending != ".msh" && ending != ".mesh" && ending != ".vtk") {
        throw FileError(path.string(), "has no ending of a mesh: .msh, .mesh, .vtk, .node or .ele");
    }
    detail::TextScanner scanner(path.string(), detail::read_text(path), {.comment = ending == ".mesh" ? '#' : '\0'});
    if (ending == ".msh") {
        return detail::GmshReader(scanner).read();
    }
    return ending == ".mesh" ? detail::read_medit(scanner) : detail::VtkReader(scanner).read();
}

} // namespace springfit::io
