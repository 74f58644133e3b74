// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <springfit/io/json.hpp>
#include <springfit/motion/surface.hpp>
#include <springfit/network/spring_network.hpp>

namespace springfit::io {

/// A calibrated mass-spring model as `model.json` holds it. Field by field: docs/files.md.
template <int Dim, std::floating_point ScalarType>
    requires SpatialDimension<Dim>
struct Model {
    static constexpr int dimension = Dim;
    using Scalar = ScalarType;

    SpringNetwork<Dim, Scalar> network;
    /// The part of data in each spring's stiffness, in [0, 1], below 1/2 less than the prior's [n_springs]; empty: not
    /// known.
    Values<Scalar> data_share{};
    std::vector<int> fixed;      ///< nodes that were clamped, ascending, each once
    Scalar stable_time_step = 0; ///< the largest step that explicit integration is sure to stand, s, > 0
    std::optional<EmbeddedSurface<Dim, Scalar>> surface{}; ///< finer than the network, for display
    Json provenance = Json::object(); ///< how the model came about: program version, method, material, ...
};

/// The model as the text of `model.json`; numbers read back as the same double. Throws InvalidArgument naming what is
/// not finite, out of range or of the wrong size.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] std::string model_text(const Model<Dim, Scalar>& model);

/// Puts `model.json` under the name `path` into a group of files. Throws InvalidArgument (see above) or FileError.
template <int Dim, std::floating_point Scalar>
void write_model(OutputGroup& outputs, const std::filesystem::path& path, const Model<Dim, Scalar>& model) {
    outputs.write(path, model_text(model));
}

/// Writes one model, in full or not at all.
template <int Dim, std::floating_point Scalar>
void write_model(const std::filesystem::path& path, const Model<Dim, Scalar>& model) {
    write_file(path, model_text(model));
}

/// The dimension, 2 or 3, of a model that `read_json` returned; `file` is named in errors. Checks format, version and
/// units as well. Throws FileError.
[[nodiscard]] int model_dimension(const Json& json, const std::string& file);

/// The model that `read_json` returned, every value checked; `file` is named in errors. Throws FileError with the JSON
/// pointer of what is missing or wrong: `model.json: /springs/stiffness/3: expected a number, found null`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Model<Dim, Scalar> model_from_json(const Json& json, const std::string& file);

/// Reads a model of known dimension. For any dimension: `read_json`, `model_dimension`, `model_from_json`.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Model<Dim, Scalar> read_model(const std::filesystem::path& path) {
    return model_from_json<Dim, Scalar>(read_json(path), path.string());
}

} // namespace springfit::io

#include <springfit/io/detail/model_json_impl.hpp>
