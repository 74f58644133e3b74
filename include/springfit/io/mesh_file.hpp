// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <springfit/io/mesh_data.hpp>

namespace springfit::io {

/// Reads a mesh; the name's ending tells the format.
///
/// | ending         | format                                                                                         |
/// |----------------|------------------------------------------------------------------------------------------------|
/// | .msh           | Gmsh 1, 2.0 to 2.2 and 4.1, text and binary                                                    |
/// | .mesh          | MEDIT, text                                                                                    |
/// | .vtk           | VTK legacy, unstructured grid, text and binary                                                 |
/// | .node and .ele | TetGen (3D) and Triangle (2D), numbered from 0 or 1; either file may be named; corners only    |
///
/// Node numbers need not be contiguous or sorted; points, lines and faces beside solid cells are left out, with a note.
/// Cells that are all numbered the other way round (a convention, not a fault) are turned, with a note. Throws
/// FileError naming file and line.
[[nodiscard]] MeshFile read_mesh(const std::filesystem::path& path);

} // namespace springfit::io

#include <springfit/io/detail/mesh_file_impl.hpp>
