// SPDX-License-Identifier: BSD-3-Clause
#include "files.hpp"

#include <cstring>
#include <limits>

#include "tolerance.hpp"
#include <springfit/io/model_json.hpp>
#include <springfit/io/report_json.hpp>

using namespace springfit;
using namespace springfit::io;
using springfit::test::content;
using springfit::test::file_error;
using springfit::test::put;
using springfit::test::ScratchFolder;

namespace {

/// Four nodes, three springs, values that decimal text does not hold exactly.
template <int Dim, class Scalar>
Model<Dim, Scalar> example() {
    Model<Dim, Scalar> model;
    auto& network = model.network;
    network.rest_positions.resize(Dim, 4);
    for (Index i = 0; i < network.rest_positions.size(); ++i) {
        network.rest_positions(i) = static_cast<Scalar>(std::sin(1.0 + static_cast<double>(i))) / 3;
    }
    network.springs.resize(2, 3);
    network.springs << 0, 1, 3, 1, 2, 0;
    network.stiffness.resize(3);
    network.stiffness << Scalar(0), Scalar(1) / 3, std::numeric_limits<Scalar>::max();
    network.rest_length.resize(3);
    network.rest_length << std::numeric_limits<Scalar>::denorm_min(), Scalar(0.1), Scalar(1e20);
    network.damping.resize(3);
    network.damping << Scalar(0), std::numeric_limits<Scalar>::min(), Scalar(2) / 7;
    network.mass.resize(4);
    network.mass << Scalar(1e-6), Scalar(0.1), Scalar(1) / 9, Scalar(1e6);
    model.fixed = {0, 2};
    model.stable_time_step = Scalar(1) / 1234;
    model.provenance = {{"springfit", "0.1.0"}, {"method", "exact"}, {"material", {{"young", 5e4}}}};
    return model;
}

/// The example with a cell, if need be turned so that its corners are in positive order.
template <int Dim, class Scalar>
Model<Dim, Scalar> example_with_cells() {
    auto model = example<Dim, Scalar>();
    auto& network = model.network;
    network.rest_positions(Dim - 1, 3) += 1; // in space the four lie in a plane
    network.cells.resize(Dim + 1, 2);
    for (int c = 0; c < 2; ++c) {
        SimplexCorners<Dim, Scalar> corners;
        for (int a = 0; a <= Dim; ++a) {
            network.cells(a, c) = (a + c) % 4;
            corners.col(a) = network.rest_positions.col(network.cells(a, c));
        }
        if (signed_volume<Dim, Scalar>(corners) < 0) {
            std::swap(network.cells(0, c), network.cells(1, c));
        }
    }
    network.rest_volume.resize(2);
    network.rest_volume << Scalar(1) / 3, std::numeric_limits<Scalar>::min();
    network.volume_stiffness.resize(2);
    network.volume_stiffness << Scalar(-1) / 7, Scalar(1e7) / 3;
    return model;
}

/// The example with two cells of a surface, of three points that its nodes carry.
template <int Dim, class Scalar>
Model<Dim, Scalar> example_with_surface() {
    auto model = example<Dim, Scalar>();
    auto& surface = model.surface.emplace();
    surface.rest_positions = model.network.rest_positions.leftCols(3) * (Scalar(1) / 7);
    surface.cells.resize(Dim, 2);
    for (int a = 0; a < Dim; ++a) {
        surface.cells.col(0)(a) = a;
        surface.cells.col(1)(a) = 2 - a;
    }
    surface.from_nodes.weights.resize(4, 3);
    surface.from_nodes.weights.insert(2, 0) = 1;
    surface.from_nodes.weights.insert(0, 1) = Scalar(1) / 3;
    surface.from_nodes.weights.insert(3, 1) = Scalar(2) / 3;
    surface.from_nodes.weights.insert(0, 2) = Scalar(-0.1);
    surface.from_nodes.weights.insert(1, 2) = Scalar(1.1);
    surface.from_nodes.weights.makeCompressed();
    return model;
}

/// The message with which a model is refused after `change`.
template <class Change>
std::string refusal(const Change& change, const Model<2, double>& model = example<2, double>()) {
    Json json = Json::parse(model_text(model));
    change(json);
    return file_error([&] { (void)model_from_json<2, double>(json, "model.json"); });
}

} // namespace

TEST_CASE_TEMPLATE("a model reads back bit for bit", T, SPRINGFIT_TEST_SPACES) {
    using Scalar = typename T::Scalar;
    const ScratchFolder folder;
    const auto model = example<T::dimension, Scalar>();
    write_model(folder / "model.json", model);
    CHECK(folder.names() == std::vector<std::string>{"model.json"});
    CHECK(model_dimension(read_json(folder / "model.json"), "model.json") == T::dimension);
    const auto read = read_model<T::dimension, Scalar>(folder / "model.json");
    CHECK(read.network.rest_positions == model.network.rest_positions);
    CHECK(read.network.springs == model.network.springs);
    CHECK(read.network.stiffness == model.network.stiffness);
    CHECK(read.network.rest_length == model.network.rest_length);
    CHECK(read.network.damping == model.network.damping);
    CHECK(read.network.mass == model.network.mass);
    CHECK(read.fixed == model.fixed);
    CHECK(read.stable_time_step == model.stable_time_step);
    CHECK(read.provenance == model.provenance);
    CHECK(model_text(read) == model_text(model));
}

TEST_CASE_TEMPLATE("cells read back bit for bit, and a model without them has none", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto model = example_with_cells<dim, Scalar>();
    const auto read = model_from_json<dim, Scalar>(Json::parse(model_text(model)), "model.json");
    CHECK(read.network.cells == model.network.cells);
    CHECK(read.network.rest_volume == model.network.rest_volume);
    CHECK(read.network.volume_stiffness == model.network.volume_stiffness);
    CHECK(read.network.stiffness == model.network.stiffness);
    CHECK(model_text(read) == model_text(model));

    const Json without = Json::parse(model_text(example<dim, Scalar>()));
    CHECK_FALSE(without.contains("cells"));
    const auto plain = model_from_json<dim, Scalar>(without, "model.json");
    CHECK(plain.network.n_cells() == 0);
    validate(plain.network);
}

TEST_CASE_TEMPLATE("a surface reads back bit for bit, and a model without one has none", T, SPRINGFIT_TEST_SPACES) {
    constexpr int dim = T::dimension;
    using Scalar = typename T::Scalar;
    const auto model = example_with_surface<dim, Scalar>();
    const auto read = model_from_json<dim, Scalar>(Json::parse(model_text(model)), "model.json");
    REQUIRE(read.surface.has_value());
    CHECK(read.surface->rest_positions == model.surface->rest_positions);
    CHECK(read.surface->cells == model.surface->cells);
    CHECK(DenseMatrix<Scalar>(read.surface->from_nodes.weights) ==
          DenseMatrix<Scalar>(model.surface->from_nodes.weights));
    CHECK(model_text(read) == model_text(model));
    CHECK(deform(*read.surface, read.network.rest_positions, read.network.rest_positions) ==
          model.surface->rest_positions);

    const Json without = Json::parse(model_text(example<dim, Scalar>()));
    CHECK_FALSE(without.contains("surface"));
    CHECK_FALSE(model_from_json<dim, Scalar>(without, "model.json").surface.has_value());

    auto broken = model;
    broken.surface->from_nodes.weights.coeffRef(0, 1) = 1;
    CHECK_THROWS_AS((void)model_text(broken), InvalidArgument);
}

TEST_CASE("what is missing or wrong in the surface of a model is named by its JSON pointer") {
    const auto model = example_with_surface<2, double>();
    const Json json = Json::parse(model_text(model));
    CHECK(json["surface"]["nodes"] == Json{{2}, {0, 3}, {0, 1}});
    CHECK(json["surface"]["cells"] == Json{{0, 1}, {2, 1}});
    for (const char* key : {"rest_position", "cells", "nodes", "weights"}) {
        CHECK(refusal([&](Json& j) { j["surface"].erase(key); }, model) ==
              std::string("model.json: /surface/") + key + ": is missing");
    }
    const auto replaced = [&](const char* pointer, const Json& value) {
        return refusal([&](Json& j) { j[Json::json_pointer(pointer)] = value; }, model);
    };
    CHECK(replaced("/surface", 1) == "model.json: /surface: expected an object, found 1");
    CHECK(replaced("/surface/rest_position/2", {1}) ==
          "model.json: /surface/rest_position/2: expected an array of 2, the coordinates, found an array of 1");
    CHECK(replaced("/surface/cells/1/0", 3) ==
          "model.json: /surface/cells/1/0: expected a whole number in [0, 3), found 3");
    CHECK(replaced("/surface/cells/1", {0, 1, 2}) ==
          "model.json: /surface/cells/1: expected an array of 2, the corners of the cell, found an array of 3");
    CHECK(replaced("/surface/nodes/1/0", 4) ==
          "model.json: /surface/nodes/1/0: expected a whole number in [0, 4), found 4");
    CHECK(replaced("/surface/nodes", {{2}}) ==
          "model.json: /surface/nodes: expected an array of 3, the nodes that carry each point, found an array of 1");
    CHECK(replaced("/surface/weights/1", {1}) ==
          "model.json: /surface/weights/1: expected an array of 2, one weight per node, found an array of 1");
    CHECK(replaced("/surface/weights/0/0", 0.5) ==
          "model.json: /surface/weights/0: expected weights that sum to 1, found a sum of 0.5");
    CHECK(replaced("/surface/weights/0/0", nullptr) ==
          "model.json: /surface/weights/0/0: expected a number, found null");
}

TEST_CASE("random doubles read back bit for bit") {
    std::uint64_t state = 12345;
    Model<2, double> model = example<2, double>();
    const Index n = 2000;
    model.network.springs = NodePairs::Zero(2, n);
    model.network.springs.row(1).setConstant(1);
    model.network.rest_length.setOnes(n);
    model.network.damping.setZero(n);
    model.network.stiffness.resize(n);
    for (Index e = 0; e < n; ++e) {
        double value = -1;
        while (!(value >= 0 && std::isfinite(value))) {
            state = state * 6364136223846793005ULL + 1442695040888963407ULL;
            std::memcpy(&value, &state, sizeof value);
        }
        model.network.stiffness(e) = value;
    }
    const auto read = model_from_json<2, double>(Json::parse(model_text(model)), "model.json");
    CHECK(std::memcmp(read.network.stiffness.data(), model.network.stiffness.data(), sizeof(double) * 2000) == 0);
}

TEST_CASE("the text of a model is the contract's") {
    Model<2, double> model;
    model.network = {Points<2, double>{{0, 1}, {0, 0.5}},
                     NodePairs{{0}, {1}},
                     Values<double>{{2.5}},
                     Values<double>{{1}},
                     Values<double>{{0}},
                     Values<double>{{1, 1}},
                     {},
                     {},
                     {}};
    model.fixed = {0};
    model.stable_time_step = 0.25;
    model.provenance["springfit"] = "0.1.0";
    CHECK(model_text(model) == R"({
  "format": "springfit-model",
  "version": 1,
  "dimension": 2,
  "units": "SI",
  "damping_law": "axial",
  "nodes": {
    "rest_position": [[0.0,0.0],[1.0,0.5]],
    "mass": [1.0,1.0],
    "fixed": [0]
  },
  "springs": {
    "nodes": [[0,1]],
    "stiffness": [2.5],
    "rest_length": [1.0],
    "damping": [0.0]
  },
  "stable_time_step": 0.25,
  "provenance": {
    "springfit": "0.1.0"
  }
}
)");
}

TEST_CASE("a model that JSON cannot hold is refused by name and nothing is written") {
    const ScratchFolder folder;
    auto model = example<3, double>();
    model.network.damping(1) = std::nan("");
    CHECK_THROWS_WITH_AS(write_model(folder / "model.json", model),
                         "damping: expected values not below 0, found nan at spring 1", InvalidArgument);
    model = example<3, double>();
    model.stable_time_step = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(write_model(folder / "model.json", model),
                         "stable_time_step: expected a positive time step, found inf", InvalidArgument);
    model = example<3, double>();
    model.provenance["material"]["young"] = std::nan("");
    CHECK_THROWS_WITH_AS(write_model(folder / "model.json", model),
                         "provenance: expected finite numbers, found a value that is not finite at /material/young",
                         InvalidArgument);
    model = example<3, double>();
    model.fixed = {2, 2};
    CHECK_THROWS_AS(write_model(folder / "model.json", model), InvalidArgument);
    CHECK(folder.names().empty());
}

TEST_CASE("what is missing or wrong in a model is named by its JSON pointer") {
    const auto erased = [](const char* parent, const char* key) {
        return refusal([&](Json& json) { json[Json::json_pointer(parent)].erase(key); });
    };
    for (const char* key : {"format", "version", "dimension", "units", "damping_law", "nodes", "springs",
                            "stable_time_step", "provenance"}) {
        CHECK(erased("", key) == std::string("model.json: /") + key + ": is missing");
    }
    for (const char* key : {"rest_position", "mass", "fixed"}) {
        CHECK(erased("/nodes", key) == std::string("model.json: /nodes/") + key + ": is missing");
    }
    for (const char* key : {"nodes", "stiffness", "rest_length", "damping"}) {
        CHECK(erased("/springs", key) == std::string("model.json: /springs/") + key + ": is missing");
    }
    const auto replaced = [](const char* pointer, const Json& value) {
        return refusal([&](Json& json) { json[Json::json_pointer(pointer)] = value; });
    };
    CHECK(replaced("/format", "other") == "model.json: /format: expected \"springfit-model\", found \"other\"");
    CHECK(replaced("/version", 2) == "model.json: /version: expected 1, found 2");
    CHECK(replaced("/dimension", 4) == "model.json: /dimension: expected 2 or 3, found 4");
    CHECK(replaced("/dimension", 3) == "model.json: /dimension: expected 2, found 3");
    CHECK(replaced("/nodes", 3) == "model.json: /nodes: expected an object, found 3");
    CHECK(replaced("/nodes/mass/1", nullptr) == "model.json: /nodes/mass/1: expected a number, found null");
    CHECK(replaced("/nodes/mass/1", 0) == "model.json: /nodes/mass/1: expected a positive number, found 0");
    CHECK(replaced("/nodes/mass", {1, 2}) ==
          "model.json: /nodes/mass: expected an array of 4, one number per node, found an array of 2");
    CHECK(replaced("/nodes/rest_position/3", {1, 2, 3}) ==
          "model.json: /nodes/rest_position/3: expected an array of 2, the coordinates, found an array of 3");
    CHECK(replaced("/nodes/fixed/1", 4) == "model.json: /nodes/fixed/1: expected a whole number in [0, 4), found 4");
    CHECK(replaced("/nodes/fixed/1", 0) == "model.json: /nodes/fixed/1: expected a node number above 0, found 0");
    CHECK(replaced("/springs/nodes/2/0", 1.5) ==
          "model.json: /springs/nodes/2/0: expected a whole number in [0, 4), found 1.5");
    CHECK(replaced("/springs/nodes/2/0", -1) ==
          "model.json: /springs/nodes/2/0: expected a whole number in [0, 4), found -1");
    CHECK(replaced("/springs/nodes/2", {1, 1}) ==
          "model.json: /springs/nodes/2: expected two different nodes, found [1,1]");
    CHECK(replaced("/springs/stiffness", {1}) ==
          "model.json: /springs/stiffness: expected an array of 3, one number per spring, found an array of 1");
    CHECK(replaced("/springs/stiffness/0", -2) ==
          "model.json: /springs/stiffness/0: expected a number not below 0, found -2");
    CHECK(replaced("/stable_time_step", "fast") == "model.json: /stable_time_step: expected a number, found \"fast\"");
    CHECK(replaced("", 1) == "model.json: /: expected an object, found 1");
}

TEST_CASE("what is missing or wrong in the cells of a model is named by its JSON pointer") {
    const auto model = example_with_cells<2, double>();
    for (const char* key : {"nodes", "rest_volume", "stiffness"}) {
        CHECK(refusal([&](Json& json) { json["cells"].erase(key); }, model) ==
              std::string("model.json: /cells/") + key + ": is missing");
    }
    const auto replaced = [&](const char* pointer, const Json& value) {
        return refusal([&](Json& json) { json[Json::json_pointer(pointer)] = value; }, model);
    };
    CHECK(replaced("/cells", nullptr) == "model.json: /cells: expected an object, found null");
    CHECK(replaced("/cells/nodes", 1) ==
          "model.json: /cells/nodes: expected an array, the corners of each cell, found 1");
    CHECK(replaced("/cells/nodes/1", {0, 1}) ==
          "model.json: /cells/nodes/1: expected an array of 3, the corners of the cell, found an array of 2");
    CHECK(replaced("/cells/nodes/1/2", 4) ==
          "model.json: /cells/nodes/1/2: expected a whole number in [0, 4), found 4");
    const std::string positive = "different corners in positive order around a positive volume at rest";
    CHECK(replaced("/cells/nodes/0", {1, 1, 2}) ==
          "model.json: /cells/nodes/0: expected " + positive + ", found [1,1,2]");
    const auto& cell = model.network.cells;
    CHECK(replaced("/cells/nodes/0", {cell(1, 0), cell(0, 0), cell(2, 0)}) ==
          text("model.json: /cells/nodes/0: expected ", positive, ", found [", cell(1, 0), ',', cell(0, 0), ',',
               cell(2, 0), ']'));
    CHECK(replaced("/cells/rest_volume/1", 0) ==
          "model.json: /cells/rest_volume/1: expected a positive number, found 0");
    CHECK(replaced("/cells/rest_volume", {1}) ==
          "model.json: /cells/rest_volume: expected an array of 2, one number per cell, found an array of 1");
    CHECK(replaced("/cells/stiffness/0", "soft") ==
          "model.json: /cells/stiffness/0: expected a number, found \"soft\"");
}

TEST_CASE("what a file of a stranger may do to a model") {
    CHECK(refusal([](Json& json) { json["nodes"] = {{"rest_position", Json::array()}, {"mass", Json::array()}}; }) ==
          "model.json: /nodes/rest_position: expected an array, one position per node, at least one, found an array "
          "of 0");
    CHECK(refusal([](Json& json) { json["springs"]["nodes"][1][1] = 4; }) ==
          "model.json: /springs/nodes/1/1: expected a whole number in [0, 4), found 4");
    CHECK(refusal([](Json& json) { json["springs"]["nodes"][1][0] = 1e300; }) ==
          "model.json: /springs/nodes/1/0: expected a whole number in [0, 4), found 1e+300");
    CHECK(refusal([](Json& json) { json["springs"]["nodes"][1][0] = 4294967297; }) ==
          "model.json: /springs/nodes/1/0: expected a whole number in [0, 4), found 4294967297");
    const std::string shortened = refusal([](Json& json) { json["units"] = std::string(1000000, 'x'); });
    CHECK(shortened.starts_with("model.json: /units: expected \"SI\", found \"xxxx"));
    CHECK(shortened.size() < 150);
}

TEST_CASE("JSON that is nested deep is refused with its line, however deep") {
    const ScratchFolder folder;
    const std::string name = (folder / "model.json").string();
    const auto nested = [](int depth) {
        return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
    };
    const auto message = [&](const std::string& content) {
        put(name, content);
        return file_error([&] { (void)read_json(name); });
    };
    CHECK(message(nested(100)) == "no FileError");
    CHECK(message("{\"a\":\n" + nested(100) + "}") == name + ":2: arrays and objects are nested more than 100 deep");
    CHECK(message("{\"provenance\":" + nested(1000000) + "}") ==
          name + ":1: arrays and objects are nested more than 100 deep");
    CHECK(message("\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\"") == "no FileError"); // a text
}

TEST_CASE("a file that is missing, no JSON or beyond the scalar is refused with its name and line") {
    const ScratchFolder folder;
    const std::string name = (folder / "model.json").string();
    const auto message = [&] { return file_error([&] { (void)read_model<2, float>(name); }); };
    CHECK(message() == name + ": no such file");
    put(name, "{\n  \"format\": NaN\n}\n");
    CHECK(message().starts_with(name + ":2: not JSON: syntax error"));
    put(name, "");
    CHECK(message().starts_with(name + ":1: not JSON: "));
    put(name, "{\"format\": 1e999}");
    CHECK(message().starts_with(name + ": not usable: "));
    std::string large = model_text(example<2, double>());
    put(name, large.replace(large.find("1000000.0"), 9, "1e200"));
    CHECK(message() == name + ": /nodes/mass/3: expected a positive number, found 1e+200");
    std::filesystem::remove(name);
    std::filesystem::create_directory(name);
    CHECK(message() == name + ": is a folder, not a file");
}

TEST_CASE("a report holds the contract's fields, and null for what is not finite") {
    const ScratchFolder folder;
    Report report;
    report.status = Status::converged;
    report.method = "van_gelder";
    report.nodes = 12;
    report.springs = 34;
    report.seconds = 1.5;
    report.stage_seconds = {{"mesh", 0.5}, {"fit", 1.0}};
    report.held_out = {0.25, 0, {{"van_gelder", 0.25}, {"exact", std::numeric_limits<double>::infinity()}}};
    report.training = {0.125, 0, {{"van_gelder", 0.125}, {"exact", 3.0}}};
    report.warnings = {"softer than the closed form"};
    report.detail = {{"seed", 7}, {"fit", {{"kkt", Json::array({1e-9, std::nan("")})}}}};

    OutputGroup outputs;
    write_report(outputs, folder / "report.json", report);
    outputs.commit();
    const Json json = read_json(folder / "report.json");
    CHECK(json.at("status") == "converged");
    CHECK(json.at("method") == "van_gelder");
    CHECK(json.at("nodes") == 12);
    CHECK(json.at("springs") == 34);
    CHECK(json.at("seconds") == Json{{"total", 1.5}, {"stages", {{"mesh", 0.5}, {"fit", 1.0}}}});
    CHECK(json.at("held_out").at("error") == 0.25);
    CHECK(json.at("held_out").at("baselines").at("exact").is_null());
    CHECK(json.at("training") == Json{{"error", 0.125}, {"baselines", {{"van_gelder", 0.125}, {"exact", 3.0}}}});
    CHECK(json.at("detail").at("seed") == 7);
    CHECK(json.at("detail").at("fit").at("kkt").at(1).is_null());
    CHECK(json.at("warnings") == Json::array({"softer than the closed form",
                                              "/held_out/baselines/exact is not finite (inf) and written as null",
                                              "/detail/fit/kkt/1 is not finite (nan) and written as null"}));
}
