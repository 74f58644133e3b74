// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>

#include <springfit/core/error.hpp>

namespace springfit::cgal::detail {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Polygons over shared points, as a file holds them: in any orientation, perhaps with points given twice.
struct PolygonSoup {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> polygons;
};

inline std::string lower_case(std::string word) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    return word;
}

inline std::string lower_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

/// Throws FileError unless the path names a file that can be opened and holds something.
inline void require_readable(const std::filesystem::path& path) {
    const std::string name = path.string();
    if (!std::filesystem::exists(path)) {
        throw FileError(name, "no such file");
    }
    if (std::filesystem::is_directory(path)) {
        throw FileError(name, "is a folder, not a file");
    }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        throw FileError(name, "cannot be opened for reading");
    }
    if (stream.peek() == std::ifstream::traits_type::eof()) {
        throw FileError(name, "is empty");
    }
}

/// True for `nan`, `-inf`, `Infinity`, `nan(...)` and the like, which number readers stop at without a word.
inline bool is_not_finite_word(const std::string& word) {
    const std::string bare = lower_case(word.substr(word.find_first_not_of("+-") == 1 ? 1 : 0));
    return bare == "nan" || bare == "inf" || bare == "infinity" || bare.rfind("nan(", 0) == 0 ||
           bare.find(".#in") != std::string::npos || bare.find(".#qn") != std::string::npos;
}

/// Throws FileError with the line of the first coordinate in a text file that is not a finite number.
inline void require_finite_text(const std::filesystem::path& path, const std::string& extension) {
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
        if (number == 1 && extension == ".stl" && word != "solid") {
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
    require_finite_text(path, extension);
    PolygonSoup soup;
    if (!CGAL::IO::read_polygon_soup(name, soup.points, soup.polygons)) {
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
        throw FileError(name, text("empty surface: ", soup.points.size(), " vertices, ", soup.polygons.size(), " faces"));
    }
    return soup;
}

} // namespace springfit::cgal::detail
