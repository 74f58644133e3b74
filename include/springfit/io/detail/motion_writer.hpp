// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include <springfit/io/detail/xdmf.hpp>
#include <springfit/io/motion_file.hpp>

namespace springfit::io {

namespace detail {

inline constexpr std::string_view motion_format = "springfit-motion";

template <class Matrix>
void check_node_numbers(const Matrix& numbers, Index n_nodes, std::string_view name) {
    for (Index i = 0; i < numbers.size(); ++i) {
        require(numbers.data()[i] >= 0 && numbers.data()[i] < n_nodes, name, text("node numbers in [0, ", n_nodes, ")"),
                numbers.data()[i]);
    }
}

/// The dataset of each array of a frame, and where the frame has it.
template <int Dim, std::floating_point Scalar>
struct MotionColumn {
    const char* dataset;
    const Points<Dim, Scalar>* MotionFrame<Dim, Scalar>::* values;
    bool is_position; ///< stored as displacement from rest
};

template <int Dim, std::floating_point Scalar>
inline constexpr std::array<MotionColumn<Dim, Scalar>, 5> motion_columns{
    {{"/reference/displacement", &MotionFrame<Dim, Scalar>::reference_positions, true},
     {"/reference/velocity", &MotionFrame<Dim, Scalar>::reference_velocities, false},
     {"/reference/acceleration", &MotionFrame<Dim, Scalar>::reference_accelerations, false},
     {"/reference/force", &MotionFrame<Dim, Scalar>::reference_forces, false},
     {"/fitted/displacement", &MotionFrame<Dim, Scalar>::fitted_positions, true}}};

} // namespace detail

template <int Dim, std::floating_point Scalar>
MotionWriter<Dim, Scalar>::MotionWriter(OutputGroup& outputs, const std::filesystem::path& h5,
                                        const Motion<Dim, Scalar>& body, const MotionTopology& topology)
    : m_outputs(outputs), m_h5(h5), m_rest_positions(body.rest_positions), m_kind(topology.kind),
      m_n_cells(topology.cells.cols()), m_n_springs(topology.springs.cols()),
      m_file(hdf5::File::create(outputs.add(h5), h5.string())) {
    const Index n_nodes = body.n_nodes();
    require(n_nodes > 0 && m_rest_positions.allFinite(), "rest_positions", "nodes at finite positions",
            n_nodes > 0 ? "a position that is not finite" : "no node");
    require(m_kind.has_value() == (m_n_cells > 0), "cells", "a kind of cell exactly where there are cells",
            text(m_n_cells, " cells"));
    detail::check_node_numbers(topology.cells, n_nodes, "cells");
    detail::check_node_numbers(topology.springs, n_nodes, "springs");
    detail::check_node_numbers(
        Eigen::Map<const Eigen::VectorXi>(body.clamped.data(), static_cast<Index>(body.clamped.size())), n_nodes,
        "clamped");

    m_file.write_attribute("/", "format", std::string(detail::motion_format));
    m_file.write_attribute("/", "version", "1");
    m_file.write_attribute("/", "units", "SI");
    m_file.write_attribute("/", "case", body.name);
    const auto size = [](Index n) { return static_cast<hsize_t>(n); };
    m_file.write("/mesh/points", m_rest_positions.data(), {size(n_nodes), size(Dim)});
    m_file.write("/mesh/clamped", body.clamped.data(), {body.clamped.size()});
    if (m_kind) {
        require(topology.cells.rows() == n_corners(*m_kind) && n_corners(*m_kind) == io::n_nodes(*m_kind), "cells",
                text(n_corners(*m_kind), " corners of a linear cell"), topology.cells.rows());
        m_file.write("/mesh/cells", topology.cells.data(), {size(m_n_cells), size(topology.cells.rows())});
        m_file.write_attribute("/mesh/cells", "kind", std::string(name(*m_kind)));
    }
    if (m_n_springs > 0) {
        m_file.write("/springs", topology.springs.data(), {size(m_n_springs), 2});
    }
}

template <int Dim, std::floating_point Scalar>
void MotionWriter<Dim, Scalar>::start_columns(const MotionFrame<Dim, Scalar>& frame) {
    const hdf5::Shape row{static_cast<hsize_t>(m_rest_positions.cols()), Dim};
    for (const auto& column : detail::motion_columns<Dim, Scalar>) {
        if (frame.*column.values != nullptr) {
            m_columns.emplace_back(m_file, column.dataset, row);
        }
    }
    require(!m_columns.empty(), "frame", "at least one array", "none");
    m_columns.emplace_back(m_file, "/time", hdf5::Shape{});
}

template <int Dim, std::floating_point Scalar>
void MotionWriter<Dim, Scalar>::append(const MotionFrame<Dim, Scalar>& frame) {
    const auto time = static_cast<double>(frame.time);
    require(std::isfinite(time) && (m_times.empty() || time > m_times.back()), "time", "finite, increasing values",
            time);
    if (m_times.empty()) {
        start_columns(frame);
    }
    auto series = m_columns.begin();
    for (const auto& column : detail::motion_columns<Dim, Scalar>) {
        const Points<Dim, Scalar>* values = frame.*column.values;
        const bool expected = series->dataset() == column.dataset;
        require((values != nullptr) == expected, column.dataset, "the same arrays in all frames",
                text("frame ", m_times.size(), expected ? " without it" : " with it"));
        if (values == nullptr) {
            continue;
        }
        require(values->cols() == m_rest_positions.cols(), column.dataset, text(m_rest_positions.cols(), " nodes"),
                text(values->cols(), " in frame ", m_times.size()));
        require(values->allFinite(), column.dataset, "finite values",
                text("a value that is not finite in frame ", m_times.size()));
        if (column.is_position) {
            const Points<Dim, Scalar> displacement = *values - m_rest_positions;
            series->append(displacement.data());
        } else {
            series->append(values->data());
        }
        ++series;
    }
    series->append(&time);
    m_times.push_back(time);
}

template <int Dim, std::floating_point Scalar>
void MotionWriter<Dim, Scalar>::finish() {
    require(!m_times.empty(), "motion", "at least one frame", "none");
    detail::XdmfMotion xdmf{
        m_h5.filename().string(), Dim, m_rest_positions.cols(), m_kind, m_n_cells, m_n_springs, m_times, {}};
    for (hdf5::Series& column : m_columns) {
        if (column.dataset() != "/time") {
            xdmf.vectors.push_back(column.dataset());
        }
        column.close();
    }
    for (const std::string& dataset : xdmf.vectors) {
        for (std::size_t t = 0; t < m_times.size(); ++t) {
            m_file.write_view(detail::frame_view(dataset, t), dataset, t, 3);
        }
    }
    m_file.close();
    auto path = m_h5;
    m_outputs.write(path.replace_extension(".xdmf"), detail::xdmf_text(xdmf));
}

template <int Dim, std::floating_point Scalar>
void write_motion(OutputGroup& outputs, const std::filesystem::path& h5, const Motion<Dim, Scalar>& reference,
                  const MotionTopology& topology, const std::vector<Points<Dim, Scalar>>* fitted_positions) {
    validate(reference);
    require(fitted_positions == nullptr || fitted_positions->size() == reference.times.size(), "fitted_positions",
            text(reference.times.size(), " frames"), fitted_positions == nullptr ? 0 : fitted_positions->size());
    MotionWriter<Dim, Scalar> writer(outputs, h5, reference, topology);
    for (std::size_t t = 0; t < reference.times.size(); ++t) {
        writer.append({reference.times[t], &reference.positions[t], &reference.velocities[t],
                       &reference.accelerations[t], &reference.external_forces[t],
                       fitted_positions == nullptr ? nullptr : &(*fitted_positions)[t]});
    }
    writer.finish();
}

} // namespace springfit::io
