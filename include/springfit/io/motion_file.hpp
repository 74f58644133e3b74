// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/io/atomic_file.hpp>
#include <springfit/io/cell_kind.hpp>
#include <springfit/io/hdf5.hpp>
#include <springfit/mesh/mesh.hpp>
#include <springfit/motion/motion.hpp>
#include <springfit/motion/surface.hpp>

namespace springfit::io {

/// The connections between the nodes of a motion: the cells of a mesh, springs, or both.
struct MotionTopology {
    std::optional<CellKind> kind; ///< of the cells; a linear one; none where there are no cells
    Eigen::MatrixXi cells;        ///< corners [corners per cell x n_cells]
    NodePairs springs;            ///< [2 x n_springs]
};

/// The corners of a mesh's cells, and springs.
template <int Dim, std::floating_point Scalar, CellType Cell>
[[nodiscard]] MotionTopology motion_topology(const Mesh<Dim, Scalar, Cell>& mesh, const NodePairs& springs) {
    return {cell_kind<LinearCell<Cell>>(), mesh.cells.template topRows<Cell::n_corners>(), springs};
}

/// The triangles of a carried surface; in the plane its segments, in the place of springs.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] MotionTopology motion_topology(const EmbeddedSurface<Dim, Scalar>& surface) {
    if constexpr (Dim == 2) {
        return {.kind = {}, .cells = {}, .springs = surface.cells};
    } else {
        return {.kind = CellKind::triangle, .cells = surface.cells, .springs = {}};
    }
}

/// One frame to write. What is left null has no array in the file; all frames of a file give the same arrays.
template <int Dim, std::floating_point Scalar>
struct MotionFrame {
    Scalar time = 0;                                              ///< s, above that of the frame before
    const Points<Dim, Scalar>* reference_positions = nullptr;     ///< [Dim x n_nodes], m
    const Points<Dim, Scalar>* reference_velocities = nullptr;    ///< m/s
    const Points<Dim, Scalar>* reference_accelerations = nullptr; ///< m/s^2
    const Points<Dim, Scalar>* reference_forces = nullptr;        ///< external forces, N
    const Points<Dim, Scalar>* fitted_positions = nullptr;        ///< of the spring model under the same scenario, m
};

/// Writes `motion.h5` and `motion.xdmf` frame by frame, as a simulation goes on. One pair of files holds one load case.
/// Field by field: docs/files.md.
///
///     OutputGroup outputs;
///     MotionWriter<3, double> writer(outputs, folder / "motion.h5", body, motion_topology(mesh, network.springs));
///     for (...) writer.append({.time = t, .fitted_positions = &state.positions});
///     writer.finish();
///     outputs.commit();
template <int Dim, std::floating_point Scalar>
class MotionWriter {
public:
    /// Of `body`, the name, rest positions and clamped nodes are used. The XDMF file lies beside `h5`, under its name.
    /// Throws InvalidArgument for node numbers out of range, FileError where the files cannot be written.
    MotionWriter(OutputGroup& outputs, const std::filesystem::path& h5, const Motion<Dim, Scalar>& body,
                 const MotionTopology& topology);

    /// Throws InvalidArgument for a frame of other size, arrays or time than it must have, or with a value that is not
    /// finite; FileError where it cannot be written.
    void append(const MotionFrame<Dim, Scalar>& frame);

    /// Completes both files in the group. Throws InvalidArgument where there is no frame.
    void finish();

private:
    void start_columns(const MotionFrame<Dim, Scalar>& frame);

    OutputGroup& m_outputs;
    std::filesystem::path m_h5;
    Points<Dim, Scalar> m_rest_positions;
    std::optional<CellKind> m_kind;
    Index m_n_cells = 0;
    Index m_n_springs = 0;
    hdf5::File m_file;
    std::vector<hdf5::Series> m_columns; ///< of the arrays that the first frame gave, then the time
    std::vector<double> m_times;
};

/// Writes a whole motion, and where there is one the motion of the spring model in the same frames.
template <int Dim, std::floating_point Scalar>
void write_motion(OutputGroup& outputs, const std::filesystem::path& h5, const Motion<Dim, Scalar>& reference,
                  const MotionTopology& topology, const std::vector<Points<Dim, Scalar>>* fitted_positions = nullptr);

/// A motion that was read, with what it did not hold.
template <int Dim, std::floating_point Scalar>
struct RecordedMotion {
    Motion<Dim, Scalar> motion; ///< complete: every array has every frame
    MotionTopology topology;
    /// Of "velocity" and "acceleration", those that the file lacks and that were differenced in time.
    std::vector<std::string> differenced;
    bool forces_recorded = false;  ///< false: the file has no forces, and they were taken as zero
    bool clamped_recorded = false; ///< false: the file does not say which nodes are clamped, and none is taken to be
};

/// The dimension, 2 or 3, of the motion in a `.h5` or `.xdmf` file. Throws FileError.
[[nodiscard]] int read_motion_dimension(const std::filesystem::path& path);

/// Reads every array and text that `read_motion` may read, and keeps nothing: a trial for a process of its own, since
/// HDF5 crashes, or does not come to an end, on some damaged files. Throws FileError.
void scan_motion(const std::filesystem::path& path);

/// Reads a motion from its HDF5 file or from the XDMF file that points to it, written by this or any other program in
/// the layout of docs/files.md. Missing velocities and accelerations are differenced (`differences.hpp`).
/// Throws FileError naming the array that is missing, has the wrong shape, or holds what no motion can.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] RecordedMotion<Dim, Scalar> read_motion(const std::filesystem::path& path);

} // namespace springfit::io

#include <springfit/io/detail/motion_reader.hpp>
#include <springfit/io/detail/motion_writer.hpp>
