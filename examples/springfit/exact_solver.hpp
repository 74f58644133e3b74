// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <springfit/calibrate/options.hpp>

namespace program {

/// The solver that `--exact-solver` names. Throws InvalidArgument for Ipopt in a program that was built without it.
[[nodiscard]] springfit::ExactSolver exact_solver(const std::string& name);

} // namespace program
