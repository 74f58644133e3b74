// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <springfit/io/detail/xdmf.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/motion/differences.hpp>
#include <springfit/motion/gaps.hpp>

namespace springfit::io {

namespace detail {

/// The HDF5 file of a motion, with the kind of cell that an XDMF file named.
struct MotionSource {
    hdf5::File file;
    std::optional<CellKind> kind;
};

[[nodiscard]] inline MotionSource open_motion(const std::filesystem::path& path) {
    if (hdf5::File::is_hdf5(path)) {
        return {hdf5::File::open(path), std::nullopt};
    }
    const std::string content = read_text(path);
    if (content.find("<Xdmf") == std::string::npos) {
        throw FileError(path.string(), "is neither an HDF5 nor an XDMF file");
    }
    const XdmfTarget target = follow_xdmf(path, content);
    return {hdf5::File::open(target.h5), target.kind};
}

/// The shape of a dataset that must have `rank` axes and at least one entry along each.
[[nodiscard]] inline hdf5::Shape shape_of_rank(const hdf5::File& file, const std::string& dataset, std::size_t rank,
                                               std::string_view expected) {
    const hdf5::Shape shape = file.shape(dataset);
    const bool empty = std::find(shape.begin(), shape.end(), hsize_t(0)) != shape.end();
    if (shape.size() != rank || empty || *std::max_element(shape.begin(), shape.end()) > 2000000000) {
        file.refuse(dataset, text("expected ", expected, ", found ", hdf5::to_text(shape)));
    }
    return shape;
}

[[nodiscard]] inline int motion_dimension(const hdf5::File& file) {
    constexpr std::string_view expected = "[nodes x 2] or [nodes x 3]";
    const hdf5::Shape shape = shape_of_rank(file, "/mesh/points", 2, expected);
    if (shape[1] != 2 && shape[1] != 3) {
        file.refuse("/mesh/points", text("expected ", expected, ", found ", hdf5::to_text(shape)));
    }
    return static_cast<int>(shape[1]);
}

/// Whole numbers [rows x columns], each the number of a node: a column of the result for each row. Numbers along one
/// axis, or one number alone, are as many rows of one.
[[nodiscard]] inline Eigen::MatrixXi read_node_numbers(const hdf5::File& file, const std::string& dataset,
                                                       Index n_nodes) {
    const hdf5::Shape shape = file.shape(dataset);
    if (shape.size() > 2) {
        file.refuse(dataset, text("expected a list of node numbers, found ", hdf5::to_text(shape)));
    }
    const auto columns = static_cast<Index>(shape.size() > 1 ? shape[1] : 1);
    Eigen::MatrixXi numbers(columns, static_cast<Index>(shape.empty() ? 1 : shape[0]));
    file.read_rows<long long>(dataset, shape, [&](std::size_t row, const long long* values) {
        for (Index r = 0; r < columns; ++r) {
            if (!(values[r] >= 0 && values[r] < n_nodes)) {
                file.refuse(dataset,
                            text("expected node numbers in [0, ", n_nodes, "), found ", values[r], " in row ", row));
            }
            numbers(r, static_cast<Index>(row)) = static_cast<int>(values[r]);
        }
    });
    return numbers;
}

/// The kind of the cells: what the file says, else what the XDMF file says, else the solid cell with so many corners.
template <int Dim>
[[nodiscard]] CellKind kind_of_cells(const MotionSource& source, hsize_t corners) {
    const auto fits = [&](CellKind kind) {
        return dimension(kind) <= Dim && static_cast<hsize_t>(n_nodes(kind)) == corners;
    };
    if (const auto named = source.file.attribute("/mesh/cells", "kind")) {
        const auto kind = cell_kind_of_name(*named);
        if (!kind || !fits(*kind)) {
            source.file.refuse("/mesh/cells", text(corners, " corners per cell do not fit cells of kind \"", *named,
                                                   "\" in dimension ", Dim));
        }
        return *kind;
    }
    if (source.kind && fits(*source.kind)) {
        return *source.kind;
    }
    std::optional<CellKind> best;
    for (const CellKind kind : cell_kinds) {
        if (fits(kind) && n_nodes(kind) == n_corners(kind) && (!best || dimension(kind) > dimension(*best))) {
            best = kind;
        }
    }
    if (!best) {
        source.file.refuse("/mesh/cells", text("no cell of dimension ", Dim, " or less has ", corners, " corners"));
    }
    return *best;
}

template <int Dim>
[[nodiscard]] MotionTopology read_topology(const MotionSource& source, Index n_nodes) {
    MotionTopology topology;
    if (source.file.has("/mesh/cells")) {
        const auto shape = shape_of_rank(source.file, "/mesh/cells", 2, "[cells x corners per cell]");
        topology.kind = kind_of_cells<Dim>(source, shape[1]);
        topology.cells = read_node_numbers(source.file, "/mesh/cells", n_nodes);
    }
    topology.springs.resize(2, 0);
    if (source.file.has("/springs")) {
        const auto shape = shape_of_rank(source.file, "/springs", 2, "[springs x 2]");
        if (shape[1] != 2) {
            source.file.refuse("/springs", text("expected [springs x 2], found ", hdf5::to_text(shape)));
        }
        topology.springs = read_node_numbers(source.file, "/springs", n_nodes);
    }
    return topology;
}

template <std::floating_point Scalar>
[[nodiscard]] std::vector<Scalar> read_times(const hdf5::File& file) {
    const hdf5::Shape shape = shape_of_rank(file, "/time", 1, "[frames], at least one");
    std::vector<Scalar> times(shape[0]);
    file.read("/time", times.data(), shape);
    for (std::size_t t = 0; t < times.size(); ++t) {
        if (!std::isfinite(times[t])) {
            file.refuse("/time", text("expected finite values, found ", times[t], " in frame ", t));
        }
        if (t > 0 && !(times[t] > times[t - 1])) {
            file.refuse("/time",
                        text("expected increasing values, found ", times[t], " after ", times[t - 1], " in frame ", t));
        }
    }
    return times;
}

/// What a value that is not a number is: a mistake, or that of a node that was not seen.
enum class NotANumber { refused, unobserved };

template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::vector<Points<Dim, Scalar>> read_frames(const hdf5::File& file, const std::string& dataset,
                                                           std::size_t n_frames, Index n_nodes, NotANumber rule) {
    const hdf5::Shape expected{n_frames, static_cast<hsize_t>(n_nodes), Dim};
    if (const hdf5::Shape found = file.shape(dataset); found != expected) {
        file.refuse(dataset, text("expected ", hdf5::to_text(expected), ", frames x nodes x dimension, found ",
                                  hdf5::to_text(found)));
    }
    std::vector<Points<Dim, Scalar>> frames;
    file.read_rows<Scalar>(dataset, expected, [&](std::size_t t, const Scalar* values) {
        frames.emplace_back(Eigen::Map<const Points<Dim, Scalar>>(values, Dim, n_nodes));
        for (Index i = 0; i < n_nodes; ++i) {
            const auto node = frames.back().col(i).array();
            const bool is_good = rule == NotANumber::unobserved ? !node.isInf().any() : node.isFinite().all();
            if (!is_good) {
                file.refuse(dataset,
                            text("expected finite values, found one that is not at node ", i, " in frame ", t));
            }
        }
    });
    return frames;
}

} // namespace detail

inline int read_motion_dimension(const std::filesystem::path& path) {
    return detail::motion_dimension(detail::open_motion(path).file);
}

inline void scan_motion(const std::filesystem::path& path) {
    const hdf5::File file = detail::open_motion(path).file;
    (void)file.attribute("/", "case");
    for (const char* dataset :
         {"/mesh/points", "/mesh/cells", "/mesh/clamped", "/springs", "/time", "/reference/displacement",
          "/reference/velocity", "/reference/acceleration", "/reference/force"}) {
        if (file.has(dataset)) {
            (void)file.attribute(dataset, "kind");
            file.read_rows<double>(dataset, file.shape(dataset), [](std::size_t, const double*) {});
        }
    }
}

template <int Dim, std::floating_point Scalar>
RecordedMotion<Dim, Scalar> read_motion(const std::filesystem::path& path) {
    const detail::MotionSource source = detail::open_motion(path);
    const hdf5::File& file = source.file;
    if (const int dimension = detail::motion_dimension(file); dimension != Dim) {
        file.refuse("/mesh/points", text("expected a body of dimension ", Dim, ", found ", dimension));
    }
    RecordedMotion<Dim, Scalar> result;
    auto& motion = result.motion;
    motion.name = file.attribute("/", "case").value_or(path.stem().string());
    const hdf5::Shape points = file.shape("/mesh/points");
    const auto n_nodes = static_cast<Index>(points[0]);
    motion.rest_positions.resize(Dim, n_nodes);
    file.read("/mesh/points", motion.rest_positions.data(), points);
    for (Index i = 0; i < n_nodes; ++i) {
        if (!motion.rest_positions.col(i).allFinite()) {
            file.refuse("/mesh/points", text("expected finite values, found one that is not at node ", i));
        }
    }
    result.topology = detail::read_topology<Dim>(source, n_nodes);
    result.clamped_recorded = file.has("/mesh/clamped");
    if (result.clamped_recorded) {
        const Eigen::MatrixXi clamped = detail::read_node_numbers(file, "/mesh/clamped", n_nodes);
        motion.clamped.assign(clamped.data(), clamped.data() + clamped.size());
        std::sort(motion.clamped.begin(), motion.clamped.end());
        motion.clamped.erase(std::unique(motion.clamped.begin(), motion.clamped.end()), motion.clamped.end());
    }

    motion.times = detail::read_times<Scalar>(file);
    const auto read = [&](const char* dataset, detail::NotANumber rule = detail::NotANumber::refused) {
        return detail::read_frames<Dim, Scalar>(file, dataset, motion.times.size(), n_nodes, rule);
    };
    motion.positions = read("/reference/displacement", detail::NotANumber::unobserved);
    const bool is_seen = std::any_of(motion.positions.begin(), motion.positions.end(),
                                     [](const auto& frame) { return frame.array().isFinite().colwise().all().any(); });
    if (!is_seen) {
        file.refuse("/reference/displacement", "expected a node that was seen, found no number in any frame");
    }
    motion.unobserved = fill_gaps<Dim, Scalar>(motion.rest_positions, motion.times, motion.positions);
    const bool has_velocity = file.has("/reference/velocity");
    if (has_velocity) {
        motion.velocities = read("/reference/velocity");
    } else {
        motion.velocities = differentiate<Dim, Scalar>(motion.times, motion.positions, 1);
        result.differenced.emplace_back("velocity");
    }
    if (file.has("/reference/acceleration")) {
        motion.accelerations = read("/reference/acceleration");
    } else {
        motion.accelerations = has_velocity ? differentiate<Dim, Scalar>(motion.times, motion.velocities, 1)
                                            : differentiate<Dim, Scalar>(motion.times, motion.positions, 2);
        result.differenced.emplace_back("acceleration");
    }
    for (std::size_t t = 0; t < motion.times.size(); ++t) {
        if (!motion.velocities[t].allFinite() || !motion.accelerations[t].allFinite()) {
            file.refuse("/time",
                        text("expected times so far apart that velocities and accelerations are finite, found ",
                             motion.times[t], " in frame ", t));
        }
    }
    result.forces_recorded = file.has("/reference/force");
    motion.external_forces =
        result.forces_recorded
            ? read("/reference/force")
            : std::vector<Points<Dim, Scalar>>(motion.times.size(), Points<Dim, Scalar>::Zero(Dim, n_nodes));
    for (auto& positions : motion.positions) {
        positions += motion.rest_positions;
    }
    return result;
}

} // namespace springfit::io
