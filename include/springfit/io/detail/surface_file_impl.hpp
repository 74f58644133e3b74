// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/io/detail/obj.hpp>
#include <springfit/io/detail/off.hpp>
#include <springfit/io/detail/ply.hpp>
#include <springfit/io/detail/stl.hpp>
#include <springfit/io/surface_file.hpp>

namespace springfit::io {

inline SurfaceFile read_surface_file(const std::filesystem::path& path) {
    const std::string name = path.string();
    const std::string ending = detail::lower_extension(path);
    if (ending != ".off" && ending != ".obj" && ending != ".stl" && ending != ".ply") {
        throw FileError(name, "unknown kind of surface file '" + ending + "'; .off, .obj, .stl and .ply are read");
    }
    std::string content = detail::read_text(path);
    if (content.empty()) {
        throw FileError(name, "is empty");
    }
    if (ending == ".stl") {
        const bool is_binary = detail::is_binary_stl(content);
        const std::size_t size = content.size();
        detail::TextScanner scanner(name, std::move(content));
        return is_binary ? detail::read_binary_stl(scanner, size) : detail::read_text_stl(scanner);
    }
    if (ending == ".ply") {
        detail::TextScanner scanner(name, std::move(content));
        return detail::PlyReader(scanner).read();
    }
    detail::TextScanner scanner(name, std::move(content),
                                {.comment = '#', .continuation = ending == ".obj" ? '\\' : '\0'});
    return ending == ".off" ? detail::read_off(scanner) : detail::read_obj(scanner);
}

} // namespace springfit::io
