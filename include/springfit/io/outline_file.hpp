// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace springfit::io {

/// The boundary of a plane body as a file holds it.
struct OutlineFile {
    /// Point numbers of closed rings, none given twice: the outer one first, then its holes.
    using Area = std::vector<std::vector<int>>;

    std::string file;
    std::vector<std::array<double, 2>> points; ///< as in the file, finite and not beyond 1e100
    std::vector<std::array<int, 2>> segments;  ///< pairs of points
    std::vector<std::array<double, 2>> holes;  ///< .poly: a point in each hole
    std::vector<Area> areas;                   ///< .wkt: what lies in none of them is a hole
};

/// Reads an outline; the name's ending tells the format.
///
/// | ending | format                                                                          |
/// |--------|---------------------------------------------------------------------------------|
/// | .poly  | Triangle's: vertices, segments, a point in each hole; numbered from 0 or 1      |
/// | .wkt   | well-known text: any number of POLYGON and MULTIPOLYGON, over any number of lines |
///
/// Needs no library. Throws FileError, naming file and line, for what is missing, broken or cut short, for rings that
/// are open, for an outline without segments, and for coordinates that are not finite or beyond 1e100. O(bytes).
[[nodiscard]] OutlineFile read_outline_file(const std::filesystem::path& path);

} // namespace springfit::io

#include <springfit/io/detail/outline_file_impl.hpp>
