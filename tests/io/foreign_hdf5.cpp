// SPDX-License-Identifier: BSD-3-Clause
// Motions that other programs wrote, or that somebody broke: written here by HDF5's own interface.
#include "files.hpp"

#include <chrono>
#include <functional>

#include <sys/wait.h>

#include <springfit/io/motion_file.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/mesh/topology.hpp>

#include "analytic_motion.hpp"

using namespace springfit;
using namespace springfit::io;
using springfit::test::analytic_motion;
using springfit::test::content;
using springfit::test::file_error;
using springfit::test::FileSizeLimit;
using springfit::test::put;
using springfit::test::ScratchFolder;

namespace {

using hdf5::Handle;
using hdf5::Shape;

/// How a dataset lies in its file.
struct Layout {
    Shape chunk{};                       ///< empty: in one piece
    int deflate = 0;                     ///< level of compression; 0: none
    bool grows = false;                  ///< along its first axis, so that a chunk may be larger than the array
    bool is_written = true;              ///< false: its size is in the file, but not its numbers
    std::function<void(hid_t)> change{}; ///< of the properties
};

/// A file of HDF5's own making, of a square of 4 nodes in 3 frames, whose datasets can be put in otherwise.
class ForeignFile {
public:
    explicit ForeignFile(const std::filesystem::path& path)
        : m_path(path), m_file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {
        REQUIRE(m_file.is_open());
    }

    template <class T>
    void put(const std::string& name, const std::vector<T>& values, const Shape& shape, const Layout& layout = {}) {
        Shape maximum = shape;
        if (layout.grows) {
            maximum[0] = H5S_UNLIMITED;
        }
        const Handle space =
            shape.empty() ? Handle(H5Screate(H5S_SCALAR), H5Sclose) : hdf5::detail::simple_space(shape, maximum);
        const hid_t type = hdf5::detail::memory_type<T>();
        const Handle dataset = create(name, type, space.get(), layout);
        if (layout.is_written) {
            REQUIRE(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
        }
    }

    void put_null(const std::string& name) {
        const Handle space(H5Screate(H5S_NULL), H5Sclose);
        (void)create(name, H5T_NATIVE_INT, space.get(), {});
    }

    void link(const std::string& name, const std::string& other_file, const std::string& object) {
        m_taken.push_back(name);
        REQUIRE(H5Lcreate_external(other_file.c_str(), object.c_str(), m_file.get(), name.c_str(), links().get(),
                                   H5P_DEFAULT) >= 0);
    }

    /// Puts in what a motion needs and the test did not.
    void complete() {
        const auto unless_taken = [&](const char* name, const std::vector<double>& values, const Shape& shape) {
            if (std::find(m_taken.begin(), m_taken.end(), name) == m_taken.end()) {
                put(name, values, shape);
            }
        };
        unless_taken("/mesh/points", {0, 0, 1, 0, 0, 1, 1, 1}, {4, 2});
        unless_taken("/time", {0, 0.5, 1}, {3});
        unless_taken("/reference/displacement", std::vector<double>(24, 0.5), {3, 4, 2});
        REQUIRE(m_file.close());
    }

    /// The error of reading it, without its name; empty where it is read.
    [[nodiscard]] std::string error() {
        complete();
        const std::string message = file_error([&] { (void)read_motion<2, double>(m_path); });
        const std::string name = m_path.string() + ": ";
        return message == "no FileError" ? "" : message.starts_with(name) ? message.substr(name.size()) : message;
    }

private:
    [[nodiscard]] static Handle links() {
        Handle properties(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
        H5Pset_create_intermediate_group(properties.get(), 1);
        return properties;
    }

    [[nodiscard]] Handle create(const std::string& name, hid_t type, hid_t space, const Layout& layout) {
        m_taken.push_back(name);
        const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        if (!layout.chunk.empty()) {
            H5Pset_chunk(properties.get(), static_cast<int>(layout.chunk.size()), layout.chunk.data());
        }
        if (layout.deflate > 0) {
            H5Pset_deflate(properties.get(), static_cast<unsigned>(layout.deflate));
        }
        if (layout.change) {
            layout.change(properties.get());
        }
        Handle dataset(
            H5Dcreate2(m_file.get(), name.c_str(), type, space, links().get(), properties.get(), H5P_DEFAULT),
            H5Dclose);
        REQUIRE(dataset.is_open());
        return dataset;
    }

    std::filesystem::path m_path;
    Handle m_file;
    std::vector<std::string> m_taken;
};

/// The error of a file into which `change` puts something.
template <class Change>
std::string error_with(const Change& change) {
    const ScratchFolder folder;
    ForeignFile file(folder / "other.h5");
    change(file);
    return file.error();
}

} // namespace

TEST_CASE("clamped nodes are one number, a list, or a list in two dimensions") {
    const auto clamped = [](const std::vector<int>& nodes, const Shape& shape) {
        const ScratchFolder folder;
        ForeignFile file(folder / "other.h5");
        file.put("/mesh/clamped", nodes, shape);
        file.complete();
        return read_motion<2, double>(folder / "other.h5").motion.clamped;
    };
    CHECK(clamped({3}, {}) == std::vector<int>{3});
    CHECK(clamped({3, 0}, {2}) == std::vector<int>{0, 3});
    CHECK(clamped({3, 0}, {2, 1}) == std::vector<int>{0, 3});
    CHECK(clamped({3, 0}, {1, 2}) == std::vector<int>{0, 3});
    CHECK(clamped({}, {0}).empty());
    CHECK(error_with([](auto& file) { file.put_null("/mesh/clamped"); }) ==
          "/mesh/clamped: holds nothing, not even a size (a null dataspace)");
    CHECK(error_with([](auto& file) { file.put("/mesh/clamped", std::vector<int>{0, 1}, {1, 2, 1}); }) ==
          "/mesh/clamped: expected a list of node numbers, found [1 x 2 x 1]");
    CHECK(error_with([](auto& file) { file.put("/time", std::vector<double>{0}, {}); }) ==
          "/time: expected [frames], at least one, found []");
    CHECK(error_with([](auto& file) {
              file.put("/mesh/points", std::vector<double>{0}, {});
          }).starts_with("/mesh/points: expected [nodes x 2] or [nodes x 3]"));
    CHECK(error_with([](auto& file) {
              file.put("/springs", std::vector<int>{0}, {});
          }).starts_with("/springs: expected [springs x 2]"));
}

TEST_CASE("node numbers beyond an int are refused as they are") {
    CHECK(error_with([](auto& file) { file.put("/mesh/clamped", std::vector<long long>{4294967297}, {1}); }) ==
          "/mesh/clamped: expected node numbers in [0, 4), found 4294967297 in row 0");
    CHECK(error_with([](auto& file) { file.put("/mesh/clamped", std::vector<long long>{-4294967295}, {1}); }) ==
          "/mesh/clamped: expected node numbers in [0, 4), found -4294967295 in row 0");
}

TEST_CASE("an array is believed as far as its numbers are in the file") {
    const auto unwritten = [](const char* name, const Shape& shape, Layout layout = {}) {
        return error_with([&](auto& file) {
            layout.is_written = false;
            file.put(name, std::vector<double>(), shape, layout);
        });
    };
    CHECK(unwritten("/mesh/points", {500000000, 2}) ==
          "/mesh/points: promises [500000000 x 2] of 8 bytes each, but only 0 bytes are stored");
    CHECK(unwritten("/time", {1900000000}) ==
          "/time: promises [1900000000] of 8 bytes each, but only 0 bytes are stored");
    CHECK(unwritten("/time", {hsize_t(1) << 59}).starts_with("/time: promises [576460752303423488] of 8 bytes"));
    CHECK(unwritten("/reference/displacement", {3, 4, 2}, {.chunk = {3, 4, 2}})
              .starts_with("/reference/displacement: promises [3 x 4 x 2]"));
    // Compressed: a hundred times as much as the whole file, or 16 MiB.
    const auto compressed = unwritten("/mesh/points", {500000000, 2}, {.chunk = {1000, 2}, .deflate = 9});
    CHECK(compressed.starts_with("/mesh/points: promises [500000000 x 2] of 8 bytes each, but the file has "));
    CHECK(compressed.ends_with(" bytes, and a compressed array may be 100 times as large"));
    CHECK(unwritten("/mesh/points", {4, 2}, {.chunk = {100000000, 2}, .deflate = 9, .grows = true})
              .starts_with("/mesh/points: promises chunks of [100000000 x 2] of 8 bytes each, but the file has "));
}

TEST_CASE("arrays in chunks are read, compressed ones too, however small the file is") {
    std::vector<double> displacement(24);
    for (std::size_t i = 0; i < displacement.size(); ++i) {
        displacement[i] = static_cast<double>(i);
    }
    for (const Shape& chunk : {Shape{1, 1, 1}, Shape{2, 3, 1}, Shape{3, 4, 2}, Shape{20000, 4, 2}}) {
        for (const int deflate : {0, 9}) {
            CAPTURE(chunk[0]);
            CAPTURE(deflate);
            const ScratchFolder folder;
            ForeignFile file(folder / "other.h5");
            file.put("/reference/displacement", displacement, {3, 4, 2},
                     {.chunk = chunk, .deflate = deflate, .grows = true});
            file.complete();
            const auto motion = read_motion<2, double>(folder / "other.h5").motion;
            REQUIRE(motion.n_frames() == 3);
            for (int t = 0; t < 3; ++t) {
                const Points<2, double> moved = motion.positions[static_cast<std::size_t>(t)] - motion.rest_positions;
                CHECK((moved - Eigen::Map<const Points<2, double>>(displacement.data() + 8 * t, 2, 4)).isZero(1e-14));
            }
        }
    }
    // Zeros compress to a thousandth.
    CHECK(error_with([](auto& file) {
              file.put("/reference/force", std::vector<double>(24, 0.), {3, 4, 2}, {.chunk = {3, 4, 2}, .deflate = 9});
          }) == "");
}

TEST_CASE("a frame of a compressed recording in one chunk does not cost the whole chunk") {
    const ScratchFolder folder;
    ForeignFile file(folder / "other.h5");
    constexpr hsize_t frames = 4000;
    constexpr hsize_t nodes = 300;
    std::vector<double> displacement(frames * nodes * 2);
    for (std::size_t i = 0; i < displacement.size(); ++i) {
        displacement[i] = std::sin(static_cast<double>(i));
    }
    std::vector<double> times(frames);
    for (std::size_t t = 0; t < frames; ++t) {
        times[t] = static_cast<double>(t);
    }
    file.put("/mesh/points", std::vector<double>(nodes * 2, 0.), {nodes, 2});
    file.put("/time", times, {frames});
    file.put("/reference/displacement", displacement, {frames, nodes, 2}, {.chunk = {frames, nodes, 2}, .deflate = 1});
    file.complete();
    const auto start = std::chrono::steady_clock::now();
    CHECK(read_motion<2, double>(folder / "other.h5").motion.n_frames() == 4000);
    // Some .3 s; with each frame for itself 4000 times .2 s.
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(60));
}

TEST_CASE("numbers that are in other files are read only from the same folder or below") {
    CHECK(error_with([](auto& file) {
              file.put("/mesh/points", std::vector<double>(8, 0.), {4, 2},
                       {.is_written = false,
                        .change = [](hid_t p) { H5Pset_external(p, "/etc/passwd", 0, H5F_UNLIMITED); }});
          }) == "/mesh/points: its numbers are in another file (external storage), which is not read; store them here");
    CHECK(error_with([](auto& file) {
              file.put("/mesh/points", std::vector<double>(8, 0.), {4, 2},
                       {.is_written = false, .change = [](hid_t p) {
                            const Handle space = hdf5::detail::simple_space({4, 2}, {4, 2});
                            H5Pset_virtual(p, space.get(), "/tmp/other.h5", "/points", space.get());
                        }});
          }) == "/mesh/points: is a view of other datasets (virtual), which is not read; store its numbers here");

    const ScratchFolder folder;
    std::filesystem::create_directories(folder / "a/b");
    for (const char* name : {"outside.h5", "a/beside.h5", "a/b/below.h5"}) {
        ForeignFile(folder / name).complete();
    }
    const auto error_of_link = [&](const std::string& link, const std::string& name, const std::string& object) {
        ForeignFile file(folder / "a/links.h5");
        file.link(link, name, object);
        return file.error();
    };
    CHECK(error_of_link("/mesh/points", "beside.h5", "/mesh/points").empty());
    CHECK(error_of_link("/mesh/points", "b/below.h5", "/mesh/points").empty());
    CHECK(error_of_link("/mesh/points", "beside.h5", "/none").starts_with("/mesh/points: cannot be read: "));
    CHECK(error_of_link("/mesh/points", "lost.h5", "/mesh/points") ==
          "/mesh/points: links to lost.h5, which is not there");
    for (const std::string& name :
         {std::string("../outside.h5"), std::string("b/../../outside.h5"), (folder / "a/beside.h5").string()}) {
        CHECK(error_of_link("/mesh/points", name, "/mesh/points") ==
              "/mesh/points: links to " + name + "; links are followed to files in the same folder or below it only");
        CHECK(error_of_link("/mesh/clamped", name, "/mesh/points").starts_with("/mesh/clamped: links to " + name));
    }
    // A group may be the link as well, and the file that is linked to may link on.
    ForeignFile group(folder / "a/group.h5");
    group.link("/reference", "../outside.h5", "/reference");
    CHECK(file_error([&] {
              (void)read_motion<2, double>(folder / "a/group.h5");
          }).starts_with((folder / "a/group.h5").string()));
    ForeignFile on(folder / "a/on.h5");
    on.link("/mesh/points", "../outside.h5", "/mesh/points");
    on.complete();
    CHECK(error_of_link("/mesh/points", "on.h5", "/mesh/points").starts_with("/mesh/points: links to ../outside.h5"));
}

TEST_CASE("an XDMF file leads to files in its folder or below it alone, in linear time") {
    const ScratchFolder folder;
    std::filesystem::create_directories(folder / "a/b");
    ForeignFile(folder / "outside.h5").complete();
    ForeignFile(folder / "a/b/below.h5").complete();
    const auto error = [&](const std::string& xdmf) {
        put(folder / "a/run.xdmf", xdmf);
        const std::string message = file_error([&] { (void)read_motion<2, double>(folder / "a/run.xdmf"); });
        const std::string name = (folder / "a/run.xdmf").string() + ": ";
        return message.starts_with(name) ? message.substr(name.size()) : message;
    };
    const auto naming = [](const std::string& name) { return "<Xdmf><A> " + name + ":/mesh/points</A></Xdmf>"; };
    CHECK(error(naming("b/below.h5")) == "no FileError");
    for (const std::string& name : {std::string("../outside.h5"), (folder / "a/b/below.h5").string()}) {
        CHECK(error(naming(name)) == "points to " + name + "; only files in the same folder or below it are read");
    }
    const std::string many(300000, '<');
    std::string names;
    for (int i = 0; i < 20000; ++i) {
        names += "<A>file" + std::to_string(i) + ".h5:/mesh/points</A>";
    }
    const auto start = std::chrono::steady_clock::now();
    CHECK(error(many) == "is neither an HDF5 nor an XDMF file");
    CHECK(error("<Xdmf>" + many) == "points to no HDF5 file");
    CHECK(error("<Xdmf>" + std::string(300000, '>')) == "points to no HDF5 file");
    const std::string listed = error("<Xdmf>" + names);
    CHECK(listed.starts_with("points to 20000 HDF5 files: file0.h5, "));
    CHECK(listed.size() < 300);
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10)); // some .05 s
}

TEST_CASE("a motion that reads is one that scans") {
    const ScratchFolder folder;
    ForeignFile(folder / "good.h5").complete();
    CHECK_NOTHROW(scan_motion(folder / "good.h5"));
    ForeignFile file(folder / "other.h5");
    file.put("/reference/force", std::vector<double>(), {1000000000}, {.is_written = false});
    file.complete();
    CHECK(file_error([&] {
              scan_motion(folder / "other.h5");
          }).starts_with((folder / "other.h5").string() + ": /reference/force: promises [1000000000]"));
}

TEST_CASE("times so close together that there is no velocity, and recordings without a number, are refused") {
    CHECK(error_with([](auto& file) {
              file.put("/time", std::vector<double>{0, 1e-320, 1}, {3});
          }).starts_with("/time: expected times so far apart that velocities"));
    CHECK(error_with([](auto& file) {
              file.put("/reference/displacement", std::vector<double>(24, std::nan("")), {3, 4, 2});
          }) == "/reference/displacement: expected a node that was seen, found no number in any frame");
}

TEST_CASE("the same motion makes the same bytes") {
    const auto mesh = triangle_grid<double>({3, 2}, {1., 0.5});
    const auto motion = analytic_motion(mesh.nodes, 20);
    std::string first;
    for (int run = 0; run < 2; ++run) {
        const ScratchFolder folder;
        OutputGroup outputs;
        write_motion<2, double>(outputs, folder / "motion.h5", motion, motion_topology(mesh, edges(mesh)),
                                &motion.positions);
        outputs.commit();
        const std::string bytes = content(folder / "motion.h5");
        CHECK((run == 0 || bytes == first));
        first = bytes;
        ::sleep(run == 0 ? 2 : 0); // times in a file would be in seconds
    }
}

TEST_CASE("a write that fails is an error, and nothing worse when the program ends") {
    const auto mesh = tetrahedron_grid<double>({8, 8, 8}, {1., 1., 1.});
    const auto motion = analytic_motion(mesh.nodes, 12); // 1 MB
    const auto topology = motion_topology(mesh, edges(mesh));
    for (const rlim_t bytes : {0, 10, 3000, 30000, 200000, 600000}) {
        CAPTURE(bytes);
        const ScratchFolder folder;
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            const std::string message = file_error([&] {
                const FileSizeLimit limit(bytes);
                OutputGroup outputs;
                write_motion(outputs, folder / "motion.h5", motion, topology);
                outputs.commit();
            });
            const bool is_good = message.ends_with("motion.h5: cannot be written: File too large");
            const bool is_closed = H5close() >= 0; // as at the end of the program
            ::_exit(is_good && is_closed && folder.names().empty() ? 42 : 1);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        CHECK(WIFEXITED(status));
        CHECK(WEXITSTATUS(status) == 42);
    }
}
