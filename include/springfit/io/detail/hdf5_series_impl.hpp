// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <springfit/io/hdf5.hpp>

namespace springfit::io::hdf5 {

inline Series::Series(const File& file, std::string dataset, Shape row)
    : m_file(file.name()), m_name(std::move(dataset)), m_row(std::move(row)) {
    const detail::Quiet quiet;
    hsize_t row_bytes = sizeof(double);
    for (const hsize_t size : m_row) {
        row_bytes *= std::max<hsize_t>(size, 1);
    }
    constexpr hsize_t chunk_bytes = 65536; // of small rows there are several in a chunk
    Shape chunk{std::max<hsize_t>(1, chunk_bytes / row_bytes)};
    Shape shape{0};
    Shape maximum{H5S_UNLIMITED};
    for (const hsize_t size : m_row) {
        chunk.push_back(std::max<hsize_t>(size, 1));
        shape.push_back(size);
        maximum.push_back(size);
    }
    const Handle space = detail::simple_space(shape, maximum);
    const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data());
    const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    H5Pset_chunk_cache(access.get(), 1, chunk_bytes, H5D_CHUNK_CACHE_W0_DEFAULT); // one chunk
    m_dataset = file.create_dataset(m_name, H5T_IEEE_F64LE, space.get(), properties.get(), access.get());
}

template <class T>
void Series::append(const T* values) {
    const detail::Quiet quiet;
    Shape shape{m_rows + 1};
    Shape start{m_rows};
    Shape count{1};
    for (const hsize_t size : m_row) {
        shape.push_back(size);
        start.push_back(0);
        count.push_back(size);
    }
    bool written = H5Dset_extent(m_dataset.get(), shape.data()) >= 0;
    if (written) {
        const Handle in_file(H5Dget_space(m_dataset.get()), H5Sclose);
        const Handle in_memory = detail::simple_space(count, count);
        written =
            H5Sselect_hyperslab(in_file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) >= 0 &&
            H5Dwrite(m_dataset.get(), detail::memory_type<T>(), in_memory.get(), in_file.get(), H5P_DEFAULT, values) >=
                0;
    }
    if (!written) {
        throw FileError(m_file, text(m_name, ": cannot be written: ", detail::last_error()));
    }
    ++m_rows;
}

inline void Series::close() {
    const detail::Quiet quiet;
    if (!m_dataset.close()) {
        throw FileError(m_file, text(m_name, ": cannot be written: ", detail::last_error()));
    }
}

} // namespace springfit::io::hdf5
