// SPDX-License-Identifier: BSD-3-Clause
#include "files.hpp"

#include "tolerance.hpp"
#include <springfit/io/motion_file.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/mesh/topology.hpp>

#include "analytic_motion.hpp"

using namespace springfit;
using namespace springfit::io;
using springfit::test::analytic_motion;
using springfit::test::file_error;
using springfit::test::FileSizeLimit;
using springfit::test::put;
using springfit::test::relative_difference;
using springfit::test::rounding;
using springfit::test::ScratchFolder;

namespace {

template <int Dim, class Scalar>
auto grid() {
    if constexpr (Dim == 2) {
        return triangle_grid<Scalar>({3, 2}, {Scalar(1), Scalar(0.5)});
    } else {
        return tetrahedron_grid<Scalar>({2, 2, 1}, {Scalar(1), Scalar(0.5), Scalar(2)});
    }
}

template <int Dim, class Scalar>
void write_to(const ScratchFolder& folder, const Motion<Dim, Scalar>& motion, const MotionTopology& topology) {
    OutputGroup outputs;
    write_motion<Dim, Scalar>(outputs, folder / "motion.h5", motion, topology, &motion.positions);
    outputs.commit();
}

/// A file that holds what the layout asks for and no more, changed by `change` before it is closed.
template <class Change>
std::string refusal(const Change& change) {
    const ScratchFolder folder;
    const std::string path = folder / "other.h5";
    {
        auto file = hdf5::File::create(path, path);
        std::vector<double> zeros(64, 0.0);
        const std::vector<double> times{0, 0.5, 1};
        const std::vector<double> points{0, 0, 1, 0, 0, 1, 1, 1};
        const std::vector<int> cells{0, 1, 2, 1, 3, 2};
        struct Parts {
            hdf5::File& file;
            bool points = true, cells = true, time = true, displacement = true;
        } parts{file};
        change(parts);
        if (parts.points) {
            file.write("/mesh/points", points.data(), {4, 2});
        }
        if (parts.cells) {
            file.write("/mesh/cells", cells.data(), {2, 3});
        }
        if (parts.time) {
            file.write("/time", times.data(), {3});
        }
        if (parts.displacement) {
            file.write("/reference/displacement", zeros.data(), {3, 4, 2});
        }
        file.close();
    }
    const std::string message = file_error([&] { (void)read_motion<2, double>(path); });
    return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : message;
}

} // namespace

TEST_CASE_TEMPLATE("a motion reads back, through either file", T, SPRINGFIT_TEST_SPACES) {
    using Scalar = typename T::Scalar;
    constexpr int Dim = T::dimension;
    const ScratchFolder folder;
    const auto mesh = grid<Dim, Scalar>();
    const auto motion = analytic_motion(mesh.nodes, 7);
    const MotionTopology topology = motion_topology(mesh, edges(mesh));
    write_to(folder, motion, topology);
    CHECK(folder.names() == std::vector<std::string>{"motion.h5", "motion.xdmf"});

    for (const char* file : {"motion.h5", "motion.xdmf"}) {
        CHECK(read_motion_dimension(folder / file) == Dim);
        const auto read = read_motion<Dim, Scalar>(folder / file);
        CHECK(read.motion.name == motion.name);
        CHECK(read.motion.rest_positions == motion.rest_positions);
        CHECK(read.motion.clamped == motion.clamped);
        CHECK(read.motion.times == motion.times);
        CHECK(read.topology.kind == topology.kind);
        CHECK(read.topology.cells == topology.cells);
        CHECK(read.topology.springs == topology.springs);
        CHECK(read.differenced.empty());
        CHECK(read.forces_recorded);
        CHECK(read.clamped_recorded);
        CHECK_NOTHROW(validate(read.motion));
        for (std::size_t t = 0; t < motion.times.size(); ++t) {
            // Stored as displacement: one rounding on the way there, one on the way back.
            CHECK(relative_difference(read.motion.positions[t], motion.positions[t]) < rounding<Scalar>(2));
            CHECK(read.motion.velocities[t] == motion.velocities[t]);
            CHECK(read.motion.accelerations[t] == motion.accelerations[t]);
            CHECK(read.motion.external_forces[t] == motion.external_forces[t]);
        }
    }
    CHECK_THROWS_AS((void)(read_motion<5 - Dim, Scalar>(folder / "motion.h5")), FileError);
}

TEST_CASE("a long motion is written frame by frame, with a network alone") {
    const ScratchFolder folder;
    const auto mesh = grid<3, double>();
    Motion<3, double> body;
    body.name = "springs only";
    body.rest_positions = mesh.nodes;
    OutputGroup outputs;
    MotionWriter<3, double> writer(outputs, folder / "motion.h5", body, {std::nullopt, {}, edges(mesh)});
    const int n_frames = 5000; // more than one chunk of every array
    for (int t = 0; t < n_frames; ++t) {
        const Points<3, double> positions = mesh.nodes.array() + t;
        writer.append({.time = 0.25 * t, .fitted_positions = &positions});
    }
    writer.finish();
    CHECK(folder.names().size() == 2);
    outputs.commit();
    CHECK(folder.names() == std::vector<std::string>{"motion.h5", "motion.xdmf"});

    const auto file = hdf5::File::open(folder / "motion.h5");
    CHECK(file.shape("/time") == hdf5::Shape{5000});
    CHECK(file.shape("/fitted/displacement") == hdf5::Shape{5000, 18, 3});
    CHECK_FALSE(file.has("/mesh/cells"));
    CHECK_FALSE(file.has("/reference/displacement"));
    std::size_t n_rows = 0;
    double largest = 0;
    file.read_rows<double>("/fitted/displacement", {5000, 18, 3}, [&](std::size_t t, const double* values) {
        const Eigen::Map<const Points<3, double>> displacement(values, 3, 18);
        largest = std::max(largest, (displacement.array() - double(t)).abs().maxCoeff() / std::max(double(t), 1.0));
        n_rows += t == n_rows ? 1 : 0;
    });
    CHECK(n_rows == 5000);
    CHECK(largest <= rounding<double>(2));
    CHECK(file_error([&] { (void)read_motion<3, double>(folder / "motion.h5"); }) ==
          (folder / "motion.h5").string() + ": /reference/displacement: is missing");
}

TEST_CASE("cells keep their kind where the number of corners does not tell it") {
    const ScratchFolder folder;
    // A membrane of quads in space has as many corners per cell as tetrahedra.
    const auto flat = quad_grid<double>({2, 2}, {1., 1.});
    Mesh<3, double, Quad4> membrane;
    membrane.nodes = Points<3, double>::Zero(3, flat.n_nodes());
    membrane.nodes.topRows<2>() = flat.nodes;
    membrane.cells = flat.cells;
    write_to(folder, analytic_motion(membrane.nodes, 2), motion_topology(membrane, edges(membrane)));
    CHECK(read_motion<3, double>(folder / "motion.h5").topology.kind == CellKind::quadrilateral);

    // Quadratic cells are written by their corners; the nodes on their edges stay points.
    const auto mesh = quadratic(grid<3, double>());
    const auto topology = motion_topology(mesh, edges(mesh));
    CHECK(topology.kind == CellKind::tetrahedron);
    CHECK(topology.cells.rows() == 4);
    write_to(folder, analytic_motion(mesh.nodes, 2), topology);
    CHECK(read_motion<3, double>(folder / "motion.h5").motion.n_nodes() == mesh.n_nodes());
}

TEST_CASE_TEMPLATE("the surface that a network carries is a motion of triangles, in the plane of segments", T,
                   SPRINGFIT_TEST_SPACES) {
    using Scalar = typename T::Scalar;
    constexpr int Dim = T::dimension;
    const ScratchFolder folder;
    const auto mesh = grid<Dim, Scalar>();
    Interpolation<Scalar> itself;
    itself.weights.resize(mesh.n_nodes(), mesh.n_nodes());
    itself.weights.setIdentity();
    const auto surface = boundary_surface(mesh, itself);
    const auto motion = analytic_motion(surface.rest_positions, 3);
    write_to(folder, motion, motion_topology(surface));
    const auto read = read_motion<Dim, Scalar>(folder / "motion.xdmf");
    CHECK(read.motion.rest_positions == surface.rest_positions);
    CHECK(read.topology.kind.has_value() == (Dim == 3));
    if constexpr (Dim == 3) {
        CHECK(read.topology.kind == CellKind::triangle);
        CHECK(read.topology.cells == surface.cells);
    } else {
        CHECK(read.topology.springs == surface.cells);
    }
}

TEST_CASE("a file of another program needs points, time and displacement only") {
    const ScratchFolder folder;
    const std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::vector<double> times{0, 0.1, 0.3, 0.4, 0.7, 0.8};
    std::vector<double> displacement;
    for (double t : times) {
        for (int i = 0; i < 12; ++i) {
            displacement.push_back(0.1 * i * t * t - 2 * t); // differences are exact for it
        }
    }
    std::filesystem::create_directory(folder / "data & more");
    auto file = hdf5::File::create(folder / "data & more/run 1.h5", "run 1.h5");
    file.write("/mesh/points", points.data(), {4, 3});
    file.write("/mesh/cells", std::vector<int>{0, 1, 2, 3}.data(), {1, 4});
    file.write("/time", times.data(), {6});
    file.write("/reference/displacement", displacement.data(), {6, 4, 3});
    file.close();
    const auto xdmf = [](const char* topology) {
        return text("<?xml version='1.0'?><Xdmf Version='2.0'><Domain><Grid><Topology TopologyType=\"", topology,
                    "\"><DataItem Format='HDF'>\n   data &amp; more/run 1.h5:/mesh/cells\n </DataItem></Topology>"
                    "<DataItem>\ndata &amp; more/run 1.h5:/reference/displacement</DataItem></Grid></Domain></Xdmf>");
    };
    put(folder / "run.xdmf", xdmf("Tetrahedron"));
    const auto read = read_motion<3, double>(folder / "run.xdmf");
    CHECK(read.topology.kind == CellKind::tetrahedron);
    CHECK(read.differenced == std::vector<std::string>{"velocity", "acceleration"});
    CHECK_FALSE(read.forces_recorded);
    CHECK_FALSE(read.clamped_recorded);
    CHECK(read.topology.springs.cols() == 0);
    for (std::size_t t = 0; t < times.size(); ++t) {
        for (Index i = 0; i < 12; ++i) {
            const double n = static_cast<double>(i);
            CHECK(std::abs(read.motion.velocities[t](i) - (0.2 * n * times[t] - 2)) < 1e-12);
            CHECK(std::abs(read.motion.accelerations[t](i) - 0.2 * n) < 1e-10);
        }
        CHECK(read.motion.external_forces[t].isZero(0));
    }
    CHECK_NOTHROW(validate(read.motion));

    put(folder / "run.xdmf", xdmf("Quadrilateral"));
    CHECK(read_motion<3, double>(folder / "run.xdmf").topology.kind == CellKind::quadrilateral);
    CHECK(read_motion<3, double>(folder / "data & more/run 1.h5").topology.kind == CellKind::tetrahedron);
}

TEST_CASE("what is missing or wrong in a motion is named by its dataset") {
    const double nan = std::nan("");
    CHECK(refusal([](auto&) {}) == "no FileError");
    CHECK(refusal([](auto& parts) { parts.cells = false; }) == "no FileError");
    CHECK(refusal([](auto& parts) { parts.points = false; }) == "/mesh/points: is missing");
    CHECK(refusal([](auto& parts) { parts.time = false; }) == "/time: is missing");
    CHECK(refusal([](auto& parts) { parts.displacement = false; }) == "/reference/displacement: is missing");
    const auto with = [](const char* dataset, const auto& values, const hdf5::Shape& shape) {
        return refusal([&](auto& parts) {
            const std::string name = dataset;
            parts.points = name != "/mesh/points";
            parts.cells = name != "/mesh/cells";
            parts.time = name != "/time";
            parts.displacement = name != "/reference/displacement";
            parts.file.write(name, values.data(), shape);
        });
    };
    const std::vector<double> zeros(64, 0.0);
    CHECK(with("/mesh/points", zeros, {4, 4}) == "/mesh/points: expected [nodes x 2] or [nodes x 3], found [4 x 4]");
    CHECK(with("/mesh/points", zeros, {4, 3}) == "/mesh/points: expected a body of dimension 2, found 3");
    CHECK(with("/mesh/points", std::vector<double>{0, 0, 1, nan, 0, 0, 0, 0}, {4, 2}) ==
          "/mesh/points: expected finite values, found one that is not at node 1");
    CHECK(with("/mesh/cells", std::vector<int>{0, 1, 4}, {1, 3}) ==
          "/mesh/cells: expected node numbers in [0, 4), found 4 in row 0");
    CHECK(with("/mesh/cells", std::vector<int>{0, 1}, {1, 2}) ==
          "/mesh/cells: no cell of dimension 2 or less has 2 corners");
    CHECK(with("/mesh/cells", std::vector<int>{0, 1, 2}, {3}) ==
          "/mesh/cells: expected [cells x corners per cell], found [3]");
    CHECK(with("/mesh/cells", std::vector<double>{0, 1, 2}, {1, 3}) == "/mesh/cells: expected whole numbers");
    CHECK(with("/springs", std::vector<int>{0, -1}, {1, 2}) ==
          "/springs: expected node numbers in [0, 4), found -1 in row 0");
    CHECK(with("/springs", std::vector<int>{0, 1, 2}, {1, 3}) == "/springs: expected [springs x 2], found [1 x 3]");
    CHECK(with("/mesh/clamped", std::vector<int>{9}, {1}) ==
          "/mesh/clamped: expected node numbers in [0, 4), found 9 in row 0");
    CHECK(with("/time", zeros, {0}) == "/time: expected [frames], at least one, found [0]");
    CHECK(with("/time", std::vector<double>{0, 2, 2}, {3}) ==
          "/time: expected increasing values, found 2 after 2 in frame 2");
    CHECK(with("/time", std::vector<double>{0, nan, 2}, {3}) == "/time: expected finite values, found nan in frame 1");
    CHECK(with("/reference/displacement", zeros, {3, 5, 2}) ==
          "/reference/displacement: expected [3 x 4 x 2], frames x nodes x dimension, found [3 x 5 x 2]");
    CHECK(with("/reference/velocity", zeros, {2, 4, 2}) ==
          "/reference/velocity: expected [3 x 4 x 2], frames x nodes x dimension, found [2 x 4 x 2]");
    std::vector<double> broken(24, 0.0);
    broken[13] = nan;
    CHECK(with("/reference/force", broken, {3, 4, 2}) ==
          "/reference/force: expected finite values, found one that is not at node 2 in frame 1");
}

TEST_CASE("files that hold no motion are refused") {
    const ScratchFolder folder;
    const auto message = [&](const char* name) {
        return file_error([&] { (void)read_motion<2, double>(folder / name); }).substr((folder / name).string().size());
    };
    CHECK(message("none.h5") == ": no such file");
    put(folder / "text.h5", "not a motion");
    CHECK(message("text.h5") == ": is neither an HDF5 nor an XDMF file");
    put(folder / "empty.xdmf", "<Xdmf><Domain/></Xdmf>");
    CHECK(message("empty.xdmf") == ": points to no HDF5 file");
    put(folder / "two.xdmf", "<Xdmf><A>a.h5:/mesh/points</A><A>b.h5:/mesh/cells</A></Xdmf>");
    CHECK(message("two.xdmf") == ": points to 2 HDF5 files: a.h5, b.h5");
    put(folder / "lost.xdmf", "<Xdmf><A>lost.h5:/mesh/points</A></Xdmf>");
    CHECK(file_error([&] { (void)read_motion<2, double>(folder / "lost.xdmf"); }) ==
          (folder / "lost.h5").string() + ": no such file");
}

TEST_CASE("frames that do not fit are refused and leave nothing") {
    const ScratchFolder folder;
    const auto mesh = grid<2, double>();
    const auto motion = analytic_motion(mesh.nodes, 3);
    const auto topology = motion_topology(mesh, edges(mesh));
    Points<2, double> broken = motion.positions[0];
    broken(1, 2) = std::nan("");
    const Points<2, double> small = motion.positions[0].leftCols(2);
    const auto refused = [&](const MotionFrame<2, double>& frame) -> std::string {
        OutputGroup outputs;
        MotionWriter<2, double> writer(outputs, folder / "motion.h5", motion, topology);
        writer.append({.time = 1, .reference_positions = &motion.positions[0]});
        try {
            writer.append(frame);
        } catch (const InvalidArgument& error) {
            return error.what();
        }
        return "accepted";
    };
    CHECK(refused({.time = 2, .reference_positions = &motion.positions[0]}) == "accepted");
    CHECK(refused({.time = 1, .reference_positions = &motion.positions[0]}) ==
          "time: expected finite, increasing values, found 1");
    CHECK(refused({.time = 2, .reference_positions = &broken}) ==
          "/reference/displacement: expected finite values, found a value that is not finite in frame 1");
    CHECK(refused({.time = 2, .reference_positions = &small}) ==
          "/reference/displacement: expected 12 nodes, found 2 in frame 1");
    CHECK(refused({.time = 2}) ==
          "/reference/displacement: expected the same arrays in all frames, found frame 1 without it");
    CHECK(refused({.time = 2, .reference_positions = &small, .fitted_positions = &small})
              .starts_with("/reference/displacement: "));
    CHECK(folder.names().empty());

    OutputGroup outputs;
    MotionWriter<2, double> writer(outputs, folder / "motion.h5", motion, topology);
    CHECK_THROWS_WITH_AS(writer.finish(), "motion: expected at least one frame, found none", InvalidArgument);
    CHECK_THROWS_AS(writer.append({.time = 0}), InvalidArgument);
    MotionTopology wrong = topology;
    wrong.springs(1, 0) = 12;
    CHECK_THROWS_WITH_AS((MotionWriter<2, double>(outputs, folder / "b.h5", motion, wrong)),
                         "springs: expected node numbers in [0, 12), found 12", InvalidArgument);
}

TEST_CASE("a motion for which there is no room is reported and leaves nothing") {
    const ScratchFolder folder;
    const auto mesh = grid<3, double>();
    const auto motion = analytic_motion(mesh.nodes, 800); // some 4 MB
    const std::string name = (folder / "motion.h5").string();
    for (const rlim_t bytes : {500, 1100000, 1500000, 2300000}) {
        CAPTURE(bytes);
        OutputGroup outputs;
        outputs.write(folder / "model.json", "{}");
        const FileSizeLimit limit(bytes);
        const std::string message =
            file_error([&] { write_motion(outputs, name, motion, motion_topology(mesh, edges(mesh))); });
        CHECK(message.starts_with(name + ": "));
        CHECK(message.ends_with(": File too large"));
        CHECK_FALSE(std::filesystem::exists(name));
    }
    CHECK(folder.names().empty());
}

TEST_CASE("differences in uneven time are of fourth order at every frame") {
    for (const int order : {1, 2}) {
        CAPTURE(order);
        const auto largest_error = [&](int n) {
            std::vector<double> times;
            std::vector<Points<2, double>> frames;
            for (int t = 0; t < n; ++t) {
                times.push_back((t + 0.3 * std::sin(2.0 * t)) / n);
                frames.push_back(Points<2, double>::Constant(2, 1, std::sin(5 * times.back())));
            }
            const auto derivative = differentiate<2, double>(times, frames, order);
            double largest = 0;
            for (int t = 0; t < n; ++t) {
                const auto at = static_cast<std::size_t>(t);
                const double exact = order == 1 ? 5 * std::cos(5 * times[at]) : -25 * std::sin(5 * times[at]);
                largest = std::max(largest, std::abs(derivative[at](0) - exact));
            }
            return largest;
        };
        const double rate = std::log2(largest_error(200) / largest_error(400));
        CHECK(rate > 3.7);
        CHECK(largest_error(400) < 1e-4);
    }
    // Few frames: as many as there are; none where a derivative has no meaning.
    const std::vector<Points<2, double>> two{Points<2, double>::Constant(2, 1, 1.),
                                             Points<2, double>::Constant(2, 1, 2.)};
    CHECK(std::abs(differentiate<2, double>({0., 0.5}, two, 1)[1](0) - 2) < 1e-14);
    CHECK(differentiate<2, double>({0., 0.5}, two, 2)[0].isZero(0));
    CHECK(differentiate<2, double>({0.}, {two[0]}, 1)[0].isZero(0));
}
