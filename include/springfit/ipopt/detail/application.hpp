// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <variant>

#include <IpIpoptApplication.hpp>

#include <springfit/core/error.hpp>
#include <springfit/core/status.hpp>

namespace springfit::ipopt::detail {

using Option = std::variant<std::string, double, int>;

inline void set_option(Ipopt::IpoptApplication& application, const std::string& name, const Option& value) {
    Ipopt::OptionsList& list = *application.Options();
    bool accepted = false;
    if (const auto* word = std::get_if<std::string>(&value)) {
        accepted = list.SetStringValue(name, *word);
    } else if (const auto* number = std::get_if<double>(&value)) {
        accepted = list.SetNumericValue(name, *number);
    } else {
        accepted = list.SetIntegerValue(name, std::get<int>(value));
    }
    require(accepted, text("ipopt option ", name), "an option and value that Ipopt knows",
            std::visit([](const auto& v) { return text(v); }, value));
}

/// Options that every fit has: `own`, and what an engine sets besides in `settings`; the caller's `ipopt` wins over
/// both.
template <class Options>
Ipopt::SmartPtr<Ipopt::IpoptApplication> make_application(const Options& own,
                                                          const std::map<std::string, Option>& settings) {
    require(own.tolerance > 0 && own.tolerance < 1, "tolerance", "a value in (0, 1)", own.tolerance);
    require(own.max_iterations >= 0, "max_iterations", "a number not below 0", own.max_iterations);
    require(own.print_level >= 0 && own.print_level <= 12, "print_level", "a number from 0 to 12", own.print_level);
    // Ipopt writes to its own streams from the first option on, so that the console is made only where it is asked for.
    Ipopt::SmartPtr<Ipopt::IpoptApplication> application =
        new Ipopt::IpoptApplication(/*create_console_out*/ own.print_level > 0);
    application->RethrowNonIpoptException(true);
    std::map<std::string, Option> all{
        {"tol", own.tolerance},           {"dual_inf_tol", own.tolerance},  {"compl_inf_tol", own.tolerance},
        {"max_iter", own.max_iterations}, {"print_level", own.print_level}, {"sb", own.print_level > 0 ? "no" : "yes"},
        {"nlp_scaling_method", "none"},   {"bound_relax_factor", 0.},
    };
    for (const auto* more : {&settings, &own.ipopt}) {
        for (const auto& [name, value] : *more) {
            all[name] = value;
        }
    }
    for (const auto& [name, value] : all) {
        set_option(*application, name, value);
    }
    const Ipopt::ApplicationReturnStatus status = application->Initialize(std::string()); // no file of options
    require(status == Ipopt::Solve_Succeeded, "ipopt options", "options that fit together", static_cast<int>(status));
    return application;
}

inline Status status_of(Ipopt::ApplicationReturnStatus status) {
    switch (status) {
    case Ipopt::Solve_Succeeded: return Status::converged;
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Search_Direction_Becomes_Too_Small:
    case Ipopt::Restoration_Failed: return Status::stalled;
    case Ipopt::User_Requested_Stop: return Status::interrupted;
    case Ipopt::Maximum_Iterations_Exceeded:
    case Ipopt::Maximum_CpuTime_Exceeded: return Status::iteration_limit;
    case Ipopt::Diverging_Iterates:
    case Ipopt::Invalid_Number_Detected: return Status::diverged;
    default: return Status::failed;
    }
}

} // namespace springfit::ipopt::detail
