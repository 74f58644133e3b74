// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/calibrate.hpp>
#include <springfit/io/model_json.hpp>
#include <springfit/io/report_json.hpp>

namespace springfit::io {

/// Facts for the files of a calibration that it does not know itself.
struct CalibrationSource {
    std::string input;            ///< the file that the body is from
    Json material;                ///< its constants
    Json reference;               ///< how the reference was made; `describe(cases)` is added
    unsigned seed = 1;            ///< of everything random
    Json detail = Json::object(); ///< more for the report
};

/// The names and times of recorded cases.
template <int Dim>
[[nodiscard]] Json describe(const RecordedCases<Dim, double>& cases) {
    const auto names_of = [](const CaseSet<Dim, double>& set) {
        Json names = Json::array();
        for (const auto& motion : set.motions) {
            names.push_back(motion.name);
        }
        return names;
    };
    Json json{{"training_cases", names_of(cases.training)},
              {"held_out_cases", names_of(cases.held_out)},
              {"stiffness_damping", cases.stiffness_damping}};
    for (const auto& [name, value] : {std::pair{"period", cases.period}, std::pair{"strain", cases.strain},
                                      std::pair{"deformation", cases.deformation}}) {
        if (value > 0) {
            json[name] = value;
        }
    }
    const auto& first = cases.held_out.motions.front();
    json["frames"] = first.n_frames();
    if (first.n_frames() > 1) {
        json["frame_time_step"] = first.times[1] - first.times[0];
    }
    return json;
}

[[nodiscard]] inline Json describe(const AccelerationReport& fit) {
    return {{"status", to_string(fit.status)},
            {"objective_start", fit.objective_start},
            {"objective", fit.objective},
            {"iterations", fit.iterations},
            {"kkt_residual", fit.kkt_residual},
            {"at_lower_bound", fit.at_lower.size()},
            {"at_upper_bound", fit.at_upper.size()},
            {"not_identified", fit.not_identified.size()},
            {"without_unknown", fit.without_unknown.size()}};
}

[[nodiscard]] inline Json describe(const TrajectoryReport& fit) {
    return {{"status", to_string(fit.status)},
            {"objective_start", fit.objective_start},
            {"objective", fit.objective},
            {"misfit_start", fit.misfit_start},
            {"misfit", fit.misfit},
            {"iterations", fit.iterations},
            {"evaluations", fit.evaluations},
            {"stepped_back", fit.rejected},
            {"set_by_data", fit.n_set_by_data()},
            {"set_by_prior", fit.theta.size() - fit.n_set_by_data()}};
}

[[nodiscard]] inline Json describe(const Warning& warning) {
    Json values = Json::object();
    for (const auto& [name, value] : warning.values) {
        values[name] = value;
    }
    return {{"code", to_string(warning.code)},
            {"about", warning.about},
            {"message", warning.message},
            {"advice", warning.advice},
            {"values", values}};
}

namespace detail {

template <int Dim>
Json reference_of(const Calibration<Dim>& calibration, const CalibrationSource& source) {
    Json reference = source.reference.is_null() ? Json::object() : source.reference;
    reference.update(describe(calibration.cases));
    return reference;
}

} // namespace detail

/// The chosen network as a model, held where the first held-out case holds it.
template <int Dim>
[[nodiscard]] Model<Dim, double> model_of(const Calibration<Dim>& calibration, const CalibrationSource& source) {
    const Candidate<Dim>& best = calibration.best();
    Model<Dim, double> model;
    model.network = best.network;
    model.data_share = best.data_share;
    model.fixed = calibration.cases.held_out.motions.front().clamped;
    model.stable_time_step = calibration.stable_step;
    model.provenance = {{"springfit", SPRINGFIT_VERSION_STRING},
                        {"method", best.name},
                        {"input", source.input},
                        {"material", source.material},
                        {"seed", source.seed},
                        {"reference", detail::reference_of(calibration, source)}};
    return model;
}

/// All that was found, as a report; the seconds of its stages are those of the calibration.
template <int Dim>
[[nodiscard]] Report report_of(const Calibration<Dim>& calibration, const CalibrationSource& source) {
    const Candidate<Dim>& best = calibration.best();
    Report report;
    report.verdict = to_string(calibration.verdict);
    report.status = calibration.status;
    report.method = best.name;
    report.nodes = best.network.n_nodes();
    report.springs = best.network.n_springs();
    report.stage_seconds = calibration.seconds;
    report.held_out.error = best.held_out.error;
    report.training.error = best.training.error;
    report.held_out.noise = best.held_out.noise;
    report.training.noise = best.training.noise;
    Json fits = Json::object();
    for (const auto& candidate : calibration.candidates) {
        report.held_out.baselines.emplace_back(candidate.name, candidate.held_out.error);
        report.training.baselines.emplace_back(candidate.name, candidate.training.error);
        Json& fit = fits[candidate.name];
        fit = candidate.acceleration ? describe(*candidate.acceleration)
              : candidate.trajectory ? describe(*candidate.trajectory)
                                     : Json::object();
        fit["relative_stiffness"] = candidate.relative_stiffness;
        fit["seconds"] = candidate.seconds;
        if (candidate.steps_per_frame > 0) {
            fit["steps_per_frame"] = candidate.steps_per_frame;
            fit["time_step_error"] = candidate.step_error;
        }
        if (!candidate.caveat.empty()) {
            fit["caveat"] = candidate.caveat;
        }
        Json errors = Json::object();
        Json failed = Json::object();
        for (std::size_t s = 0; s < candidate.held_out.cases.size(); ++s) {
            const std::string& name = calibration.cases.held_out.motions[candidate.held_out.cases[s]].name;
            const Status status = candidate.held_out.statuses[s];
            if (status == Status::converged) {
                errors[name] = candidate.held_out.errors[s];
            } else if (status != Status::interrupted) {
                failed[name] = to_string(status);
            }
        }
        fit["held_out_cases"] = std::move(errors);
        if (!failed.empty()) {
            fit["failed_cases"] = std::move(failed);
        }
    }
    Json parts = Json::object();
    for (const auto& [part, error] : calibration.parts) {
        parts[std::string(part)] = error;
    }
    Json warnings = Json::array();
    for (const Warning& warning : calibration.warnings) {
        report.warnings.push_back(to_string(warning));
        warnings.push_back(describe(warning));
    }
    report.detail = source.detail;
    report.detail["chosen_by"] = to_string(calibration.choice.rule);
    report.detail["fits"] = std::move(fits);
    report.detail["reference"] = detail::reference_of(calibration, source);
    report.detail["seed"] = source.seed;
    report.detail["period"] = calibration.period;
    report.detail["damping_ratio"] = calibration.damping_ratio;
    report.detail["held_out_parts"] = std::move(parts);
    report.detail["warnings"] = std::move(warnings);
    return report;
}

} // namespace springfit::io
