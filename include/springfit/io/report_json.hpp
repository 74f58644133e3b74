// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <springfit/core/status.hpp>
#include <springfit/core/types.hpp>
#include <springfit/core/version.hpp>
#include <springfit/io/json.hpp>

namespace springfit::io {

/// A name with its number: the seconds of a stage, the error of a method. In the order in which they are to be read.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// Motion errors sqrt(sum |x - x_ref|^2 / sum |x_ref - x_rest|^2) over the free nodes, frames and cases of a set.
struct MotionErrors {
    double error = std::numeric_limits<double>::quiet_NaN(); ///< of the model that was returned; NaN: the set is empty
    double noise = 0;                                        ///< the part that noise of recordings makes; 0: none
    NamedNumbers baselines;                                  ///< of every candidate, by method
};

/// The contents of `report.json`. Field by field: docs/files.md.
struct Report {
    std::string verdict; ///< what the returned model is worth
    Status status = Status::failed;
    std::string method; ///< of the model that was returned
    Index nodes = 0;
    Index springs = 0;
    double seconds = 0;         ///< in all, s
    NamedNumbers stage_seconds; ///< per stage, s
    MotionErrors held_out;      ///< on load cases that no fit has seen
    MotionErrors training;      ///< on those that were fitted to
    std::vector<std::string> warnings;
    Json detail = Json::object(); ///< what else the program tells: options, seed, active bounds, ...
};

namespace detail {

/// Turns every number that is not finite, which JSON cannot hold, into null, with a warning that names it.
inline void make_finite(Json& value, const std::string& pointer, std::vector<std::string>& warnings) {
    if (value.is_number_float() && !std::isfinite(value.get<double>())) {
        warnings.push_back(text(pointer, " is not finite (", value.get<double>(), ") and written as null"));
        value = nullptr;
    } else if (value.is_object()) {
        for (auto& [key, member] : value.items()) {
            make_finite(member, pointer + "/" + key, warnings);
        }
    } else if (value.is_array()) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            make_finite(value[i], text(pointer, '/', i), warnings);
        }
    }
}

[[nodiscard]] inline Json named_numbers_to_json(const NamedNumbers& numbers) {
    Json json = Json::object();
    for (const auto& [name, number] : numbers) {
        json[name] = number;
    }
    return json;
}

} // namespace detail

/// The report as JSON; an infinite or undefined number becomes null, with a warning that names it.
[[nodiscard]] inline Json report_json(const Report& report) {
    const auto errors = [](const MotionErrors& set) {
        Json json{{"error", set.error}, {"baselines", detail::named_numbers_to_json(set.baselines)}};
        if (set.noise > 0) { // error^2 = noise^2 + model^2
            json["noise"] = set.noise;
            json["model"] = std::sqrt(std::max(set.error * set.error - set.noise * set.noise, 0.));
        }
        return json;
    };
    Json json;
    json["format"] = "springfit-report";
    json["version"] = 1;
    json["springfit"] = SPRINGFIT_VERSION_STRING;
    json["verdict"] = report.verdict;
    json["status"] = to_string(report.status);
    json["method"] = report.method;
    json["nodes"] = report.nodes;
    json["springs"] = report.springs;
    json["seconds"] = {{"total", report.seconds}, {"stages", detail::named_numbers_to_json(report.stage_seconds)}};
    json["held_out"] = errors(report.held_out);
    json["training"] = errors(report.training);
    json["warnings"] = Json::array();
    json["detail"] = report.detail;
    auto warnings = report.warnings;
    detail::make_finite(json, "", warnings);
    json["warnings"] = warnings;
    return json;
}

/// Puts `report.json` under the name `path` into a group of files, the verdict first. Throws FileError.
inline void write_report(OutputGroup& outputs, const std::filesystem::path& path, const Report& report) {
    outputs.write(path, json_text(report_json(report), "verdict"));
}

} // namespace springfit::io
