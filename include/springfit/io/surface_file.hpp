// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace springfit::io {

/// A surface as a file holds it: polygons over points, in any orientation, perhaps with points given twice.
struct SurfaceFile {
    std::string file;
    std::vector<std::array<double, 3>> points; ///< as in the file, finite and not beyond 1e100
    std::vector<std::vector<int>> polygons;    ///< point numbers, three or more each, in the file's order
};

/// Reads a surface; the name's ending tells the format.
///
/// | ending | format                                                                                              |
/// |--------|-----------------------------------------------------------------------------------------------------|
/// | .off   | OFF with or without normals, colours and texture (STOFF, COFF, NOFF, ...), text and binary          |
/// | .obj   | Wavefront: `v` and `f`; all else is skipped                                                         |
/// | .stl   | text (one solid or several) and binary; each facet has points of its own                           |
/// | .ply   | text and binary, either byte order, numbers of any type; other elements and properties are skipped  |
///
/// Needs no library. Throws FileError, naming file and line (in binary parts the byte), for what is missing, broken or
/// cut short, for a surface without points or faces, and for coordinates that are not finite or beyond 1e100. A size
/// in a file is believed only as far as its bytes can hold it. O(bytes), in time and memory.
[[nodiscard]] SurfaceFile read_surface_file(const std::filesystem::path& path);

} // namespace springfit::io

#include <springfit/io/detail/surface_file_impl.hpp>
