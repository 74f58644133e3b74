// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hdf5.h>

#include <springfit/core/error.hpp>

/// HDF5's own objects, errors, types and shapes, as `io/hdf5.hpp` uses them.
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

} // namespace detail

/// Numbers of entries along the axes, slowest first.
using Shape = std::vector<hsize_t>;

/// `[200 x 12 x 3]`
[[nodiscard]] inline std::string to_text(const Shape& shape) {
    std::string result = "[";
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
        result += text(axis > 0 ? " x " : "", shape[axis]);
    }
    return result + "]";
}

/// Any HDF5 object, with the function that closes it.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, Close closer) : m_id(id), m_close(closer) {}
    Handle(Handle&& other) noexcept : m_id(std::exchange(other.m_id, -1)), m_close(other.m_close) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(m_id, other.m_id);
        std::swap(m_close, other.m_close);
        return *this;
    }
    ~Handle() { (void)close(); }

    [[nodiscard]] bool is_open() const noexcept { return m_id >= 0; }
    [[nodiscard]] hid_t get() const noexcept { return m_id; }
    /// False where closing failed, as when what was still in memory could not be written.
    [[nodiscard]] bool close() noexcept {
        if (!is_open()) {
            return true;
        }
        const detail::Quiet quiet;
        return m_close(std::exchange(m_id, -1)) >= 0;
    }

private:
    hid_t m_id = -1;
    Close m_close = nullptr;
};

namespace detail {

template <class T>
[[nodiscard]] hid_t memory_type() {
    if constexpr (std::is_same_v<T, double>) {
        return H5T_NATIVE_DOUBLE;
    } else if constexpr (std::is_same_v<T, float>) {
        return H5T_NATIVE_FLOAT;
    } else {
        static_assert(std::is_same_v<T, int> || std::is_same_v<T, long long>,
                      "arrays of double, float, int, long long");
        return std::is_same_v<T, int> ? H5T_NATIVE_INT : H5T_NATIVE_LLONG;
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

[[nodiscard]] inline Shape shape_of(const Handle& dataset) {
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space.get());
    Shape shape(static_cast<std::size_t>(std::max(rank, 0)));
    H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
    return shape;
}

} // namespace detail

} // namespace springfit::io::hdf5
