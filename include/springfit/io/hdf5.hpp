// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <springfit/io/atomic_file.hpp>
#include <springfit/io/detail/hdf5_calls.hpp>

/// A thin layer over HDF5's C interface: files and arrays of doubles, floats and ints that are closed on every way out.
/// Every error is a FileError that names file and dataset; HDF5 itself prints nothing.
namespace springfit::io::hdf5 {

/// An open file. Reading converts between number types (a number beyond the range of the wanted type becomes the end of
/// that range); text where numbers are expected is refused.
class File {
public:
    /// A new file, in memory until `close` writes it to `path`; errors name `shown`, the file that it is to become.
    ///
    /// HDF5 1.10 does not write to the disk by itself, since it cannot stand a write that fails: it tries again when
    /// the program ends, and crashes there.
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

    /// Writes a created file to the disk, after all series in it were closed. Throws FileError where that fails.
    void close();

    [[noreturn]] void refuse(const std::string& dataset, std::string_view problem) const;

private:
    friend class Series;
    File(Handle file, std::filesystem::path created, std::string name)
        : m_file(std::move(file)), m_created(std::move(created)), m_name(std::move(name)) {}
    /// Refuses the dataset where there is a problem.
    void accept(const std::string& dataset, const std::string& problem) const;
    [[nodiscard]] Handle open_dataset(const std::string& dataset) const;
    [[nodiscard]] Handle create_dataset(const std::string& dataset, hid_t type, hid_t space, hid_t properties,
                                        hid_t access) const;

    Handle m_file;
    std::filesystem::path m_created; ///< where `close` writes it to; empty: the file was opened
    std::string m_name;
};

/// A float64 array that grows along its slowest axis, row by row, while a motion is under way.
class Series {
public:
    /// `row` is the shape of one row; empty for one number.
    Series(const File& file, std::string dataset, Shape row);

    template <class T>
    void append(const T* values);
    void close();
    [[nodiscard]] const std::string& dataset() const noexcept { return m_name; }

private:
    std::string m_file;
    std::string m_name;
    Shape m_row;
    hsize_t m_rows = 0;
    Handle m_dataset;
};

} // namespace springfit::io::hdf5

#include <springfit/io/detail/hdf5_impl.hpp>
#include <springfit/io/detail/hdf5_series_impl.hpp>
