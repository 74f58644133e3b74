// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <springfit/io/atomic_file.hpp>
#include <springfit/io/detail/hdf5_calls.hpp>

/// A thin layer over HDF5's C interface: files and arrays of doubles, floats and ints that are closed on every way out.
/// Every error is a FileError that names file and dataset; HDF5 itself prints nothing.
namespace springfit::io::hdf5 {

/// Room on the disk for a file that is being written.
///
/// HDF5 1.10 cannot stand a failed write: it keeps what it could not write, tries again when the program ends, and
/// crashes there. So room is made, or found missing, before HDF5 writes; and a file that a write failed in, or that is
/// not to be completed, is led to nowhere before HDF5 closes it (`abandon`).
class ReservedSpace {
public:
    ReservedSpace(const std::filesystem::path& path, std::string shown);
    /// Makes room for `bytes` more than HDF5 has given out so far in the file of `object`. Throws FileError on a full
    /// disk.
    void make(hid_t object, hsize_t bytes);
    /// Gives back what was not used of a file that HDF5 has flushed.
    void trim(hsize_t size);
    /// Whatever HDF5 writes to the file of `object` from now on goes nowhere, and cannot fail.
    void abandon(hid_t object) noexcept;

private:
    io::detail::Descriptor m_descriptor;
    std::string m_name;
    hsize_t m_size = 0;
    bool m_abandoned = false;
};

/// An open file. Reading converts between number types (a number beyond the range of the wanted type becomes the end of
/// that range); text where numbers are expected is refused.
class File {
public:
    File(File&&) noexcept = default;
    File& operator=(File&&) noexcept = default;
    ~File();

    /// Truncates the file `path`; errors name `shown`, the file that it is to become.
    [[nodiscard]] static File create(const std::filesystem::path& path, std::string shown);
    [[nodiscard]] static File open(const std::filesystem::path& path);
    /// True where the file exists and is of this format.
    [[nodiscard]] static bool is_hdf5(const std::filesystem::path& path);

    [[nodiscard]] const std::string& name() const noexcept { return m_name; }
    [[nodiscard]] bool has(const std::string& dataset) const;
    /// Empty for a single number. What a file was read for can be allocated by it: a shape that promises more than the
    /// file holds is refused, as are numbers that are in another file and links to other files, but for those in the
    /// same folder or below it.
    [[nodiscard]] Shape shape(const std::string& dataset) const;

    /// Writes a whole array.
    template <class T>
    void write(const std::string& dataset, const T* values, const Shape& shape);

    /// Reads a whole array, which must have this shape.
    template <class T>
    void read(const std::string& dataset, T* values, const Shape& expected) const;

    /// Reads an array of this shape and calls `take(row, values)` for each entry of its slowest axis, in order, with a
    /// `const T*`. In memory is no more of it than its chunks ask for.
    template <class T, class Take>
    void read_rows(const std::string& dataset, const Shape& expected, const Take& take) const;

    /// Makes `view` show one row `[n x m]` of a dataset `[rows x n x m]` in this file, without a copy, with columns of
    /// zeros added up to `columns`.
    void write_view(const std::string& view, const std::string& dataset, hsize_t row, hsize_t columns);

    void write_attribute(const std::string& object, const std::string& attribute, const std::string& value);
    /// A text attribute, where there is one.
    [[nodiscard]] std::optional<std::string> attribute(const std::string& object, const std::string& attribute) const;

    /// Completes a created file, after all series in it were closed. Throws where that fails.
    void close();

    [[noreturn]] void refuse(const std::string& dataset, std::string_view problem) const;

private:
    friend class Series;
    File(Handle file, std::shared_ptr<ReservedSpace> room, std::string name)
        : m_file(std::move(file)), m_reserved(std::move(room)), m_name(std::move(name)) {}
    void make_room(hsize_t bytes) const { m_reserved->make(m_file.get(), bytes); }
    [[nodiscard]] Handle open_dataset(const std::string& dataset) const;
    [[nodiscard]] Handle create_dataset(const std::string& dataset, hid_t type, hid_t space, hid_t properties,
                                        hid_t access) const;

    Handle m_file;
    std::shared_ptr<ReservedSpace> m_reserved; ///< of a created file
    std::string m_name;
};

/// A float64 array that grows along its slowest axis, row by row, while a motion is under way.
class Series {
public:
    /// `row` is the shape of one row; empty for one number.
    Series(const File& file, std::string dataset, Shape row);
    Series(Series&&) noexcept = default;
    Series& operator=(Series&&) noexcept = default;
    ~Series();

    template <class T>
    void append(const T* values);
    void close();
    [[nodiscard]] const std::string& dataset() const noexcept { return m_name; }

private:
    std::string m_file;
    std::shared_ptr<ReservedSpace> m_reserved;
    hsize_t m_row_bytes = sizeof(double);
    std::string m_name;
    Shape m_row;
    hsize_t m_rows = 0;
    Handle m_dataset;
};

} // namespace springfit::io::hdf5

#include <springfit/io/detail/hdf5_impl.hpp>
#include <springfit/io/detail/hdf5_series_impl.hpp>
