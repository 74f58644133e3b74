// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <fcntl.h>
#include <unistd.h>

#include <springfit/io/detail/atomic_file_impl.hpp>
#include <springfit/io/detail/hdf5_checks.hpp>
#include <springfit/io/hdf5.hpp>

namespace springfit::io::hdf5 {

inline File File::create(const std::filesystem::path& path, std::string shown) {
    const detail::Quiet quiet;
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    constexpr std::size_t growth = 1 << 20;
    H5Pset_fapl_core(access.get(), growth, false);
    Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose);
    if (!file.is_open()) {
        throw FileError(shown, text("cannot be created: ", detail::last_error()));
    }
    return {std::move(file), path, std::move(shown)};
}

inline File File::open(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        throw FileError(path.string(), "no such file");
    }
    if (!is_hdf5(path)) {
        throw FileError(path.string(), "is not an HDF5 file, or is damaged");
    }
    const detail::Quiet quiet;
    Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.is_open()) {
        throw FileError(path.string(), text("cannot be read: ", detail::last_error()));
    }
    return {std::move(file), {}, path.string()};
}

inline bool File::is_hdf5(const std::filesystem::path& path) {
    const detail::Quiet quiet;
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) && H5Fis_hdf5(path.c_str()) > 0;
}

inline bool File::has(const std::string& dataset) const {
    const detail::Quiet quiet;
    const detail::LinkGuard links;
    for (std::size_t end = 0; end != std::string::npos;) {
        end = dataset.find('/', end + 1);
        if (H5Lexists(m_file.get(), dataset.substr(0, end).c_str(), links.access()) <= 0) {
            if (!links.refusal().empty()) {
                refuse(dataset, links.refusal());
            }
            return false;
        }
    }
    return true;
}

inline Handle File::open_dataset(const std::string& dataset) const {
    if (!has(dataset)) {
        refuse(dataset, "is missing");
    }
    const detail::Quiet quiet;
    const detail::LinkGuard links;
    Handle handle(H5Dopen2(m_file.get(), dataset.c_str(), links.access()), H5Dclose);
    if (!handle.is_open()) {
        refuse(dataset, links.refusal().empty() ? text("cannot be read: ", detail::last_error()) : links.refusal());
    }
    if (m_created.empty()) { // not of this program's own making
        accept(dataset, detail::storage_problem(handle));
    }
    return handle;
}

inline Handle File::create_dataset(const std::string& dataset, hid_t type, hid_t space, hid_t properties,
                                   hid_t access) const {
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    H5Pset_obj_track_times(properties, false); // the same motion makes the same bytes
    Handle handle(H5Dcreate2(m_file.get(), dataset.c_str(), type, space, links.get(), properties, access), H5Dclose);
    if (!handle.is_open()) {
        refuse(dataset, text("cannot be written: ", detail::last_error()));
    }
    return handle;
}

inline Shape File::shape(const std::string& dataset) const {
    return detail::shape_of(open_dataset(dataset));
}

template <class T>
void File::write(const std::string& dataset, const T* values, const Shape& shape) {
    const detail::Quiet quiet;
    const Handle space = detail::simple_space(shape, shape);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    Handle handle = create_dataset(dataset, detail::file_type<T>(), space.get(), properties.get(), H5P_DEFAULT);
    const bool empty = std::find(shape.begin(), shape.end(), hsize_t(0)) != shape.end();
    if (!empty && H5Dwrite(handle.get(), detail::memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
        refuse(dataset, text("cannot be written: ", detail::last_error()));
    }
    if (!handle.close()) {
        refuse(dataset, text("cannot be written: ", detail::last_error()));
    }
}

template <class T>
void File::read(const std::string& dataset, T* values, const Shape& expected) const {
    const Handle handle = open_dataset(dataset);
    const detail::Quiet quiet;
    accept(dataset, detail::type_problem<T>(handle));
    if (const Shape found = detail::shape_of(handle); found != expected) {
        refuse(dataset, text("expected ", to_text(expected), ", found ", to_text(found)));
    }
    if (H5Dread(handle.get(), detail::memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
        refuse(dataset, text("cannot be read: ", detail::last_error()));
    }
}

template <class T, class Take>
void File::read_rows(const std::string& dataset, const Shape& expected, const Take& take) const {
    const Handle handle = open_dataset(dataset);
    const detail::Quiet quiet;
    accept(dataset, detail::type_problem<T>(handle));
    Shape shape = detail::shape_of(handle);
    if (shape != expected) {
        refuse(dataset, text("expected ", to_text(expected), ", found ", to_text(shape)));
    }
    if (shape.empty()) {
        shape.push_back(1); // a single number
    }
    hsize_t row_size = 1;
    for (std::size_t axis = 1; axis < shape.size(); ++axis) {
        row_size *= shape[axis];
    }
    // Each chunk is read once; of what is not in chunks so much that calls cost nothing.
    const Handle properties(H5Dget_create_plist(handle.get()), H5Pclose);
    const Shape chunk = detail::chunk_of(properties.get());
    const hsize_t at_once = chunk.empty() ? std::max<hsize_t>(1, 8192 / std::max<hsize_t>(1, row_size)) : chunk[0];
    const Handle in_file(H5Dget_space(handle.get()), H5Sclose);
    std::vector<T> values;
    Shape start(shape.size(), 0);
    Shape count = shape;
    for (; start[0] < shape[0] && row_size > 0; start[0] += count[0]) {
        count[0] = std::min(at_once, shape[0] - start[0]);
        values.resize(count[0] * row_size);
        const Handle in_memory = detail::simple_space(count, count);
        const bool selected = expected.empty() || H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(),
                                                                      nullptr, count.data(), nullptr) >= 0;
        if (!selected || H5Dread(handle.get(), detail::memory_type<T>(), in_memory.get(), in_file.get(), H5P_DEFAULT,
                                 values.data()) < 0) {
            refuse(dataset, text("cannot be read: ", detail::last_error()));
        }
        for (hsize_t row = 0; row < count[0]; ++row) {
            take(static_cast<std::size_t>(start[0] + row), values.data() + row * row_size);
        }
    }
}

inline void File::write_view(const std::string& view, const std::string& dataset, hsize_t row, hsize_t columns) {
    const detail::Quiet quiet;
    const Shape source_shape = shape(dataset);
    const Shape view_shape{source_shape[1], columns};
    const Shape start{row, 0, 0};
    const Shape count{1, source_shape[1], source_shape[2]};
    const Handle source = detail::simple_space(source_shape, source_shape);
    const Handle space = detail::simple_space(view_shape, view_shape);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data() + 1, nullptr, count.data() + 1, nullptr);
    if (H5Pset_virtual(properties.get(), space.get(), ".", dataset.c_str(), source.get()) < 0) {
        refuse(view, text("cannot be written: ", detail::last_error()));
    }
    const Handle whole = detail::simple_space(view_shape, view_shape);
    if (!create_dataset(view, H5T_IEEE_F64LE, whole.get(), properties.get(), H5P_DEFAULT).close()) {
        refuse(view, text("cannot be written: ", detail::last_error()));
    }
}

inline void File::write_attribute(const std::string& object, const std::string& attribute, const std::string& value) {
    const detail::Quiet quiet;
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), H5T_VARIABLE);
    H5Tset_cset(type.get(), H5T_CSET_UTF8);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    Handle handle(H5Acreate_by_name(m_file.get(), object.c_str(), attribute.c_str(), type.get(), space.get(),
                                    H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
    const char* content = value.c_str();
    if (!handle.is_open() || H5Awrite(handle.get(), type.get(), &content) < 0 || !handle.close()) {
        refuse(object, text("attribute ", attribute, " cannot be written: ", detail::last_error()));
    }
}

inline std::optional<std::string> File::attribute(const std::string& object, const std::string& attribute) const {
    const detail::Quiet quiet;
    const detail::LinkGuard links;
    if (H5Aexists_by_name(m_file.get(), object.c_str(), attribute.c_str(), links.access()) <= 0) {
        return std::nullopt;
    }
    const Handle handle(H5Aopen_by_name(m_file.get(), object.c_str(), attribute.c_str(), H5P_DEFAULT, links.access()),
                        H5Aclose);
    const Handle type(handle.is_open() ? H5Aget_type(handle.get()) : -1, H5Tclose);
    const Handle space(handle.is_open() ? H5Aget_space(handle.get()) : -1, H5Sclose);
    if (!type.is_open() || H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) {
        return std::nullopt;
    }
    if (H5Tis_variable_str(type.get()) > 0) {
        char* content = nullptr;
        if (H5Aread(handle.get(), type.get(), &content) < 0 || content == nullptr) {
            return std::nullopt;
        }
        std::string value = content;
        H5free_memory(content);
        return value;
    }
    constexpr std::size_t longest = 65536; // what an attribute can have in its object's header
    if (H5Tget_size(type.get()) > longest) {
        return std::nullopt;
    }
    std::string value(H5Tget_size(type.get()), '\0');
    if (H5Aread(handle.get(), type.get(), value.data()) < 0) {
        return std::nullopt;
    }
    return std::string(value.c_str());
}

inline void File::close() {
    const detail::Quiet quiet;
    const bool is_flushed = H5Fflush(m_file.get(), H5F_SCOPE_GLOBAL) >= 0;
    const ssize_t size = is_flushed ? H5Fget_file_image(m_file.get(), nullptr, 0) : -1;
    void* content = nullptr; // points to where the file is in memory
    if (size < 0 || H5Fget_vfd_handle(m_file.get(), H5P_DEFAULT, &content) < 0) {
        throw FileError(m_name, text("cannot be written: ", detail::last_error()));
    }
    io::detail::Descriptor disk(m_created, O_WRONLY | O_CREAT | O_TRUNC);
    if (!disk.is_open()) {
        throw FileError(m_name, text("cannot be created: ", io::detail::reason(errno)));
    }
    io::detail::write_all(disk, {*static_cast<const char**>(content), static_cast<std::size_t>(size)}, m_name);
    if (!disk.close()) {
        throw FileError(m_name, text("cannot be written: ", io::detail::reason(errno)));
    }
    if (!m_file.close()) {
        throw FileError(m_name, text("cannot be closed: ", detail::last_error()));
    }
}

inline void File::accept(const std::string& dataset, const std::string& problem) const {
    if (!problem.empty()) {
        refuse(dataset, problem);
    }
}

inline void File::refuse(const std::string& dataset, std::string_view problem) const {
    throw FileError(m_name, text(dataset, ": ", problem));
}

} // namespace springfit::io::hdf5
