// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>

#include <springfit/io/detail/file_reference.hpp>
#include <springfit/io/detail/hdf5_calls.hpp>

/// What an HDF5 file of a stranger is asked before its sizes and links are believed.
namespace springfit::io::hdf5::detail {

/// Access to objects that follows links to other files only into the same folder or below.
class LinkGuard {
public:
    LinkGuard() : m_access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose) {
        H5Pset_elink_cb(m_access.get(), &LinkGuard::allow, &m_refusal);
    }
    LinkGuard(const LinkGuard&) = delete;
    LinkGuard& operator=(const LinkGuard&) = delete;

    [[nodiscard]] hid_t access() const noexcept { return m_access.get(); }
    /// Why a link was not followed; empty: none was refused.
    [[nodiscard]] const std::string& refusal() const noexcept { return m_refusal; }

private:
    /// HDF5 asks this before it follows a link to another file; below 0: it does not.
    static herr_t allow(const char* parent_file, const char*, const char* file, const char*, unsigned*, hid_t,
                        void* refusal) noexcept {
        const std::filesystem::path name(file);
        if (!io::detail::stays_below(name)) {
            *static_cast<std::string*>(refusal) =
                text("links to ", file, "; links are followed to files in the same folder or below it only");
            return -1;
        }
        std::error_code error;
        if (!std::filesystem::is_regular_file(std::filesystem::path(parent_file).parent_path() / name, error)) {
            *static_cast<std::string*>(refusal) = text("links to ", file, ", which is not there");
            return -1;
        }
        return 0;
    }

    Handle m_access;
    std::string m_refusal;
};

/// The product of sizes and `bytes`; none where it is beyond what a file can have.
[[nodiscard]] inline std::optional<hsize_t> total_bytes(const Shape& sizes, hsize_t bytes) {
    constexpr hsize_t most = std::numeric_limits<hsize_t>::max() / 2;
    hsize_t total = bytes;
    for (const hsize_t size : sizes) {
        if (size > 0 && total > most / size) {
            return std::nullopt;
        }
        total *= size;
    }
    return total;
}

/// The sizes of a dataset's chunks; empty where it is not in chunks.
[[nodiscard]] inline Shape chunk_of(hid_t properties) {
    if (H5Pget_layout(properties) != H5D_CHUNKED) {
        return {};
    }
    Shape chunk(H5S_MAX_RANK);
    const int rank = H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
    chunk.resize(static_cast<std::size_t>(std::max(rank, 0)));
    return chunk;
}

/// Bytes on the disk of the file that holds an object; 0 where that cannot be told.
[[nodiscard]] inline hsize_t size_of_file(const Handle& object) {
    const auto length = H5Fget_name(object.get(), nullptr, 0);
    std::string name(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
    H5Fget_name(object.get(), name.data(), name.size() + 1);
    std::error_code error;
    const auto size = std::filesystem::file_size(name, error);
    return error ? 0 : static_cast<hsize_t>(size);
}

/// Compressed arrays may be this many times as large as the whole file, or `small_array`.
inline constexpr hsize_t largest_compression = 100;
inline constexpr hsize_t small_array = 16 << 20;

/// Why a dataset is not to be read: its numbers are elsewhere, or it promises more than its file can hold. Empty where
/// it may be.
[[nodiscard]] inline std::string storage_problem(const Handle& handle) {
    const Handle space(H5Dget_space(handle.get()), H5Sclose);
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL) {
        return "holds nothing, not even a size (a null dataspace)";
    }
    const Handle properties(H5Dget_create_plist(handle.get()), H5Pclose);
    if (H5Pget_external_count(properties.get()) != 0) {
        return "its numbers are in another file (external storage), which is not read; store them here";
    }
    if (H5Pget_layout(properties.get()) == H5D_VIRTUAL) {
        return "is a view of other datasets (virtual), which is not read; store its numbers here";
    }
    const Handle type(H5Dget_type(handle.get()), H5Tclose);
    const hsize_t in_file = size_of_file(handle);
    const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(handle.get()), in_file);
    const bool is_filtered = H5Pget_nfilters(properties.get()) != 0;
    const hsize_t most = is_filtered ? std::max(small_array, largest_compression * in_file) : stored;
    const auto promise = [&](std::string_view what, const Shape& sizes) {
        return text("promises ", what, to_text(sizes), " of ", H5Tget_size(type.get()), " bytes each, but ",
                    is_filtered ? text("the file has ", in_file, " bytes, and a compressed array may be ",
                                       largest_compression, " times as large")
                                : text("only ", stored, " bytes are stored"));
    };
    const Shape shape = shape_of(handle);
    const auto needed = total_bytes(shape, H5Tget_size(type.get()));
    if (!needed || *needed > most) {
        return promise("", shape);
    }
    const Shape chunk = chunk_of(properties.get());
    const auto chunk_bytes = total_bytes(chunk, H5Tget_size(type.get()));
    if (!chunk.empty() && *needed > 0 && (!chunk_bytes || *chunk_bytes > most)) {
        return promise("chunks of ", chunk);
    }
    return {};
}

/// True for a type of numbers that has all of its bits within its bytes, as those of machines do.
[[nodiscard]] inline bool is_sound_number(hid_t type) {
    const std::size_t bits = 8 * H5Tget_size(type);
    const std::size_t precision = H5Tget_precision(type);
    const int offset = H5Tget_offset(type);
    if (bits > 128 || precision == 0 || offset < 0 || precision + static_cast<std::size_t>(offset) > bits) {
        return false;
    }
    if (H5Tget_class(type) != H5T_FLOAT) {
        return bits <= 64;
    }
    std::size_t sign = 0;
    std::size_t exponent = 0;
    std::size_t exponent_bits = 0;
    std::size_t mantissa = 0;
    std::size_t mantissa_bits = 0;
    return H5Tget_fields(type, &sign, &exponent, &exponent_bits, &mantissa, &mantissa_bits) >= 0 && sign < bits &&
           exponent_bits > 0 && exponent_bits < 32 && exponent + exponent_bits <= bits && mantissa_bits > 0 &&
           mantissa + mantissa_bits <= bits;
}

/// Why a dataset cannot be read as numbers of type T; empty where it can.
template <class T>
[[nodiscard]] std::string type_problem(const Handle& handle) {
    const Handle type(H5Dget_type(handle.get()), H5Tclose);
    const H5T_class_t found = H5Tget_class(type.get());
    const bool accepted = found == H5T_INTEGER || (std::is_floating_point_v<T> && found == H5T_FLOAT);
    if (!accepted || !is_sound_number(type.get())) {
        return std::is_floating_point_v<T> ? "expected numbers" : "expected whole numbers";
    }
    return {};
}

} // namespace springfit::io::hdf5::detail
