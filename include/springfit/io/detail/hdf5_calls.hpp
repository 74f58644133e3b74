// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>

#include <springfit/io/hdf5.hpp>

namespace springfit::io::hdf5 {

namespace detail {

/// While it lives, HDF5 prints no errors; afterwards it does what it did before.
class Quiet {
public:
    Quiet() {
        H5Eget_auto2(H5E_DEFAULT, &m_print, &m_data);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
    ~Quiet() { H5Eset_auto2(H5E_DEFAULT, m_print, m_data); }

private:
    H5E_auto2_t m_print = nullptr;
    void* m_data = nullptr;
};

/// HDF5's message on the last error: the system's reason where there is one.
[[nodiscard]] inline std::string last_error() {
    std::string innermost;
    const auto visit = [](unsigned depth, const H5E_error2_t* error, void* result) -> herr_t {
        if (depth == 0 && error->desc != nullptr) {
            *static_cast<std::string*>(result) = error->desc;
        }
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &innermost);
    constexpr std::string_view mark = "error message = '";
    if (const auto begin = innermost.find(mark); begin != std::string::npos) {
        const auto reason = innermost.substr(begin + mark.size());
        return reason.substr(0, reason.find('\''));
    }
    return innermost.empty() ? "HDF5 gives no reason" : innermost;
}

template <class T>
[[nodiscard]] hid_t memory_type() {
    if constexpr (std::is_same_v<T, double>) {
        return H5T_NATIVE_DOUBLE;
    } else if constexpr (std::is_same_v<T, float>) {
        return H5T_NATIVE_FLOAT;
    } else {
        static_assert(std::is_same_v<T, int>, "arrays of double, float and int");
        return H5T_NATIVE_INT;
    }
}

/// Floating-point numbers are stored as float64, whole numbers as int32, in the byte order of x86 and Arm.
template <class T>
[[nodiscard]] hid_t file_type() {
    return std::is_floating_point_v<T> ? H5T_IEEE_F64LE : H5T_STD_I32LE;
}

[[nodiscard]] inline Handle simple_space(const Shape& shape, const Shape& maximum) {
    return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), maximum.data()), H5Sclose};
}

/// Refuses what cannot be read as numbers of type T.
template <class T>
void check_type(const File& file, const std::string& dataset, const Handle& handle) {
    const Handle type(H5Dget_type(handle.get()), H5Tclose);
    const H5T_class_t found = H5Tget_class(type.get());
    const bool accepted = found == H5T_INTEGER || (std::is_floating_point_v<T> && found == H5T_FLOAT);
    if (!accepted) {
        file.refuse(dataset, std::is_floating_point_v<T> ? "expected numbers" : "expected whole numbers");
    }
}

[[nodiscard]] inline Shape shape_of(const Handle& dataset) {
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    Shape shape(static_cast<std::size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
    return shape;
}

} // namespace detail

inline std::string to_text(const Shape& shape) {
    std::string result = "[";
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
        result += text(axis > 0 ? " x " : "", shape[axis]);
    }
    return result + "]";
}

inline bool Handle::close() noexcept {
    if (!is_open()) {
        return true;
    }
    const detail::Quiet quiet;
    return m_close(std::exchange(m_id, -1)) >= 0;
}

} // namespace springfit::io::hdf5
