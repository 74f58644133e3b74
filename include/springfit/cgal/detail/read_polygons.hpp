// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>

#include <springfit/cgal/detail/kernel.hpp>
#include <springfit/cgal/detail/text_file.hpp>

namespace springfit::cgal::detail {

/// Polygons over shared points, as a file holds them: in any orientation, perhaps with points given twice.
struct PolygonSoup {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
};

/// Throws FileError for a corner in a binary STL file that is not finite; false where the file is text. (A binary file
/// holds 84 bytes, the last four the number of faces, and 50 bytes for each.)
inline bool require_finite_binary_stl(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::uint32_t n_faces = 0;
    stream.seekg(80);
    stream.read(reinterpret_cast<char*>(&n_faces), sizeof n_faces);
    if (!stream || std::filesystem::file_size(path) != 84 + 50 * std::uintmax_t{n_faces}) {
        return false;
    }
    std::array<float, 12> face; // its normal, then its corners
    for (std::uint32_t f = 0; f < n_faces; ++f) {
        stream.read(reinterpret_cast<char*>(face.data()), sizeof face);
        stream.ignore(2);
        if (!std::all_of(face.begin() + 3, face.end(), [](float x) { return std::isfinite(x); })) {
            throw FileError(path.string(), text("a corner of face ", f, " is not finite"));
        }
    }
    return true;
}

/// Throws FileError for a coordinate that is not a finite number, with its line where the file is text. (Coordinates in
/// binary OFF and PLY files are looked at once they are read.)
inline void require_finite(const std::filesystem::path& path, const std::string& extension) {
    if (extension == ".stl" && require_finite_binary_stl(path)) {
        return;
    }
    std::ifstream stream(path, std::ios::binary);
    std::string line;
    bool in_ply_header = extension == ".ply";
    for (long number = 1; std::getline(stream, line); ++number) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (number == 1 && extension == ".off" && line.find("BINARY") != std::string::npos) {
            return;
        }
        if (in_ply_header) {
            std::string encoding;
            if (word == "format" && words >> encoding && encoding != "ascii") {
                return;
            }
            in_ply_header = word != "end_header";
            continue;
        }
        if ((extension == ".obj" && word != "v") || (extension == ".stl" && word != "vertex")) {
            continue;
        }
        do {
            if (!word.empty() && word.front() == '#') {
                break;
            }
            if (is_not_finite_word(word)) {
                throw FileError(path.string(), number, "a coordinate is not finite: " + word);
            }
        } while (words >> word);
    }
}

/// Reads a surface file with CGAL. Throws FileError for what cannot be read, and for a surface without points or faces.
inline PolygonSoup read_polygons(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::string extension = lower_extension(path);
    if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply") {
        throw FileError(name, "unknown kind of surface file '" + extension + "'; .off, .obj, .stl and .ply are read");
    }
    require_readable(path);
    require_finite(path, extension);
    PolygonSoup soup;
    const auto read = [&] { // one by one: CGAL's reader of them all compiles those of other formats too
        if (extension == ".off") {
            return CGAL::IO::read_OFF(name, soup.points, soup.polygons);
        }
        if (extension == ".obj") {
            return CGAL::IO::read_OBJ(name, soup.points, soup.polygons);
        }
        return extension == ".stl" ? CGAL::IO::read_STL(name, soup.points, soup.polygons)
                                   : CGAL::IO::read_PLY(name, soup.points, soup.polygons);
    };
    const bool complete = read();
    if (!complete && !(extension == ".obj" && soup.polygons.empty())) { // an OBJ file without faces is whole, but empty
        throw FileError(name, "cannot be read as " + extension.substr(1) + " surface: broken or cut short");
    }
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        const auto& p = soup.points[i];
        if (!(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()))) {
            throw FileError(name, text("vertex ", i, " at (", p, ") is not finite"));
        }
    }
    for (std::size_t f = 0; f < soup.polygons.size(); ++f) {
        for (std::size_t i : soup.polygons[f]) {
            if (i >= soup.points.size()) {
                throw FileError(name, text("face ", f, " names vertex ", i, ", there are ", soup.points.size()));
            }
        }
    }
    if (soup.points.empty() || soup.polygons.empty()) {
        throw FileError(name,
                        text("empty surface: ", soup.points.size(), " vertices, ", soup.polygons.size(), " faces"));
    }
    return soup;
}

} // namespace springfit::cgal::detail
