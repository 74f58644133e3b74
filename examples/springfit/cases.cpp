// SPDX-License-Identifier: BSD-3-Clause
#include "cases.hpp"

#include <cstdio>
#include <numbers>

#include <springfit/cases/clamp_sets.hpp>
#include <springfit/cases/load_cases.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/step/stable_step.hpp>

#include "commands.hpp"
#include "terminal.hpp"

namespace program {

using namespace springfit;

namespace {

/// What a case is called in the report.
template <int Dim>
io::Json names_of(const CaseSet<Dim>& set) {
    io::Json names = io::Json::array();
    for (const auto& motion : set.motions) {
        names.push_back(motion.name);
    }
    return names;
}

/// beta, s, that takes a quarter of the explicit step of the closed form's springs: with zeta = beta omega / 2 at the
/// highest frequency omega = 2 / h, the step shrinks by sqrt(1 + zeta^2) - zeta, which is 0.744 at zeta = 0.3.
template <int Dim>
double light_damping(const Discretisation<Dim>& body) {
    auto network = body.network;
    apply(body.closed_forms.front().form, network);
    return 0.3 * stable_step(network);
}

} // namespace

std::vector<std::string> sides_to_clamp(const FitOptions& options) {
    return options.clamps.empty() ? std::vector<std::string>{"y-min"} : options.clamps;
}

template <int Dim>
std::vector<int> clamped_nodes(const std::vector<std::string>& clamps, const Points<Dim, double>& rest_positions) {
    std::vector<int> nodes;
    for (const std::string& clamp : clamps) {
        const std::string side = clamp.substr(0, clamp.find(':'));
        const int axis = side.empty() ? -1 : side[0] - 'x';
        const bool is_side = axis >= 0 && axis < Dim && (side.substr(1) == "-min" || side.substr(1) == "-max");
        require(is_side, "--clamp", Dim == 2 ? "x-min, x-max, y-min or y-max" : "x-min, x-max, y-min, ... or z-max",
                clamp);
        double part = 0.05;
        if (side.size() < clamp.size()) {
            const std::string number = clamp.substr(side.size() + 1);
            std::size_t used = 0;
            try {
                part = std::stod(number, &used);
            } catch (const std::exception&) {
                used = 0;
            }
            require(used == number.size() && !number.empty() && part >= 0 && part < 1, "--clamp",
                    "a part of the extent in [0, 1) after the colon", clamp);
        }
        const std::vector<int> held = side_nodes(rest_positions, {axis, side.substr(2) == "max"}, part);
        nodes.insert(nodes.end(), held.begin(), held.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    require(static_cast<Index>(nodes.size()) < rest_positions.cols(), "--clamp", "nodes left to move", "none");
    return nodes;
}

namespace {

/// Equilibria under several clamps, from which matching of motion learns, and others that judge it.
template <int Dim>
void add_statics(const FemReference<Dim>& reference, const Specimen<Dim, double>& body, const FitOptions& options,
                 const Execution& execution, const std::function<bool(const std::vector<int>&)>& holds,
                 ReferenceCases<Dim>& result) {
    auto split = random_load_cases(body, {.training = options.static_cases.value_or(60),
                                          .clamps = 3,
                                          .held_out_loads = 6,
                                          .held_out_kinds = 5,
                                          .held_out_clamp = 0,
                                          .seed = options.seed + 1000}); // other loads than those in time
    std::size_t n_left_out = 0;
    for (auto* set : {&split.training, &split.held_out_loads, &split.held_out_kinds}) {
        n_left_out += std::erase_if(
            *set, [&](const auto& scenario) { return !holds(springfit::clamped_nodes(scenario, body.n_nodes())); });
    }
    if (n_left_out > 0) {
        result.warnings.push_back(text(n_left_out,
                                       " equilibria are left out: their clamps hold the reference, but too few "
                                       "nodes of the network; more --nodes may help"));
    }
    // Half of the training is at small strain, which is quick to record and to match and tells as much of most springs.
    std::vector<Scenario<Dim, double>> small;
    std::vector<Scenario<Dim, double>> large;
    for (std::size_t c = 0; c < split.training.size(); ++c) {
        (c % 2 == 1 ? small : large).push_back(std::move(split.training[c]));
    }
    auto judged = std::move(split.held_out_loads);
    judged.insert(judged.end(), split.held_out_kinds.begin(), split.held_out_kinds.end());
    const double strain = options.strain.value_or(0.05);
    const auto add = [&](std::vector<Scenario<Dim, double>> scenarios, double wanted, CaseSet<Dim>& set) {
        if (scenarios.empty()) {
            return;
        }
        Stage stage("record statics");
        auto recordings =
            reference.record_statics(scenarios, wanted, {.execution = execution, .progress = stage.callback()});
        for (std::size_t c = 0; c < recordings.size(); ++c) {
            auto& [motion, status] = recordings[c];
            motion.name = "static " + scenarios[c].name;
            result.interrupted = result.interrupted || status == Status::interrupted;
            if (status == Status::converged) {
                set.scenarios.push_back(std::move(scenarios[c]));
                set.motions.push_back(std::move(motion));
            } else if (status != Status::interrupted) {
                result.warnings.push_back(text("static load case ", scenarios[c].name,
                                               ": the reference found no equilibrium; a smaller --strain may help"));
            }
        }
    };
    add(std::move(judged), strain, result.held_out);
    add(std::move(large), strain, result.training);
    add(std::move(small), strain / 50, result.training);
}

} // namespace

template <int Dim>
ReferenceCases<Dim> record_cases(const FemReference<Dim>& reference, Specimen<Dim, double> body,
                                 const Discretisation<Dim>& network, const FitOptions& options,
                                 const Execution& execution,
                                 const std::function<bool(const std::vector<int>&)>& holds) {
    const double deformation = options.deformation.value_or(0.05);
    require(deformation > 0 && deformation < 1, "--deformation", "a part of the body's size in (0, 1)", deformation);

    const auto& rest = body.rest_positions;
    const double size = (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm();
    const auto clamps = sides_to_clamp(options);
    const std::vector<int> held = clamped_nodes<Dim>(clamps, rest);
    body.clamps = {{held, {}}};
    std::erase_if(body.surface, [&](int node) { // a load on held nodes moves nothing
        return std::binary_search(held.begin(), held.end(), node);
    });
    const int n_held_out = options.held_out_cases.value_or(3);
    require(n_held_out >= 1, "--held-out-cases", "at least one load case", n_held_out);
    const auto split = random_load_cases(body, {.training = options.training_cases.value_or(6),
                                                .clamps = 1,
                                                .held_out_loads = 1,
                                                .held_out_kinds = n_held_out - 1,
                                                .held_out_clamp = 0,
                                                .seed = options.seed});
    struct {
        std::vector<Scenario<Dim, double>> training, held_out;
    } cases{split.training, split.held_out_loads};
    cases.held_out.insert(cases.held_out.end(), split.held_out_kinds.begin(), split.held_out_kinds.end());

    // Every case is scaled to the same largest displacement; the slowest answer sets the time.
    std::vector<Scenario<Dim, double>> all = cases.training;
    all.insert(all.end(), cases.held_out.begin(), cases.held_out.end());
    const auto responses = reference.respond(all);
    double slowest = std::numeric_limits<double>::infinity();
    for (const auto& response : responses) {
        slowest = std::min(slowest, response.frequency);
    }
    const double period = 2 * std::numbers::pi / slowest;
    const double duration = 1.25 * period;
    const auto amplitude = ramp_and_release(0.3 * duration, 0.6 * duration);
    std::size_t next = 0;
    for (auto* set : {&cases.training, &cases.held_out}) {
        for (auto& scenario : *set) {
            scale_loads(scenario, deformation * size / responses[next++].largest_displacement);
            set_amplitude(scenario, amplitude);
        }
    }

    ReferenceCases<Dim> result;
    result.stiffness_damping = options.damping_ratio ? 2 * *options.damping_ratio / slowest : light_damping(network);
    RecordOptions<double> how;
    how.frames = options.frames.value_or(32);
    require(how.frames >= 3, "--frames", "at least 3", how.frames);
    how.dt = duration / (how.frames - 1);

    // Cases are independent of each other; what a Ctrl-C leaves unfinished is left out.
    all = cases.held_out;
    all.insert(all.end(), cases.training.begin(), cases.training.end());
    std::vector<Recording<Dim, double>> recordings(all.size());
    {
        Stage stage("record " + reference.element());
        std::vector<RecordOptions<double>> each(all.size(), how);
        for (std::size_t c = 0; c < all.size(); ++c) {
            each[c].progress = stage.callback(c, all.size());
        }
        execution.for_chunks(static_cast<Index>(all.size()), 1, [&](Index, Index begin, Index) {
            const auto c = static_cast<std::size_t>(begin);
            recordings[c] = reference.record(all[c], result.stiffness_damping, each[c]);
        });
    }
    for (std::size_t c = 0; c < all.size(); ++c) {
        auto& [motion, status] = recordings[c];
        if (status == Status::interrupted) {
            result.interrupted = true;
            continue;
        }
        if (status != Status::converged) {
            result.warnings.push_back(text("load case ", all[c].name, ": the reference ended as ", to_string(status),
                                           " after ", motion.n_frames(), " of ", how.frames,
                                           " frames; a smaller --deformation may help"));
        }
        if (motion.n_frames() >= 3) {
            auto& set = c < cases.held_out.size() ? result.held_out : result.training;
            set.scenarios.push_back(all[c]);
            set.motions.push_back(std::move(motion));
        }
    }
    if (options.method == "auto" || options.method == "trajectory") {
        add_statics<Dim>(reference, body, options, execution, holds, result);
    }
    if (result.held_out.motions.empty() || result.training.motions.empty()) {
        if (result.interrupted) {
            throw Interrupted();
        }
        throw InvalidArgument("reference", "at least one recorded training and held-out case", "none that converged");
    }
    result.description = {{"kind", "fem"},
                          {"element", reference.element()},
                          {"material", options.material.value_or("neo-hookean")},
                          {"training_cases", names_of(result.training)},
                          {"held_out_cases", names_of(result.held_out)},
                          {"frames", how.frames},
                          {"frame_time_step", how.dt},
                          {"period", period},
                          {"stiffness_damping", result.stiffness_damping},
                          {"deformation", deformation},
                          {"clamps", clamps}};
    return result;
}

template <int Dim>
ReferenceCases<Dim> split_recorded(std::vector<Motion<Dim, double>> motions, const Discretisation<Dim>& body,
                                   const FitOptions& options) {
    ReferenceCases<Dim> result;
    for (auto& motion : motions) {
        require(motion.n_nodes() == body.network.n_nodes(), text("reference ", motion.name),
                text(body.network.n_nodes(), " nodes, as in the mesh"), motion.n_nodes());
        require(motion.n_frames() >= 4, text("reference ", motion.name), "at least 4 frames", motion.n_frames());
        if (!options.clamps.empty()) {
            motion.clamped = clamped_nodes<Dim>(options.clamps, body.network.rest_positions);
        }
    }
    const auto keep = [](CaseSet<Dim>& set, Motion<Dim, double> motion) {
        set.scenarios.push_back(replay(motion));
        set.motions.push_back(std::move(motion));
    };
    if (motions.size() == 1) {
        const Index split = 2 * motions.front().n_frames() / 3;
        keep(result.training, excerpt(motions.front(), 0, split));
        keep(result.held_out, excerpt(motions.front(), split, motions.front().n_frames()));
    } else {
        const std::size_t n_held_out = std::max<std::size_t>(1, motions.size() / 4);
        for (std::size_t m = 0; m < motions.size(); ++m) {
            keep(m + n_held_out < motions.size() ? result.training : result.held_out, std::move(motions[m]));
        }
    }
    result.description = {{"kind", "recorded"},
                          {"split", motions.size() == 1 ? "time: first two thirds, last third" : "motions"},
                          {"training_cases", names_of(result.training)},
                          {"held_out_cases", names_of(result.held_out)}};
    return result;
}

template std::vector<int> clamped_nodes<2>(const std::vector<std::string>&, const Points<2, double>&);
template std::vector<int> clamped_nodes<3>(const std::vector<std::string>&, const Points<3, double>&);
template ReferenceCases<2> record_cases<2>(const FemReference<2>&, Specimen<2, double>, const Discretisation<2>&,
                                           const FitOptions&, const Execution&,
                                           const std::function<bool(const std::vector<int>&)>&);
template ReferenceCases<3> record_cases<3>(const FemReference<3>&, Specimen<3, double>, const Discretisation<3>&,
                                           const FitOptions&, const Execution&,
                                           const std::function<bool(const std::vector<int>&)>&);
template ReferenceCases<2> split_recorded<2>(std::vector<Motion<2, double>>, const Discretisation<2>&,
                                             const FitOptions&);
template ReferenceCases<3> split_recorded<3>(std::vector<Motion<3, double>>, const Discretisation<3>&,
                                             const FitOptions&);

} // namespace program
