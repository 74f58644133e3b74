// SPDX-License-Identifier: BSD-3-Clause
#include "exact_solver.hpp"

#ifdef SPRINGFIT_PROGRAM_HAS_IPOPT
#include <springfit/ipopt/exact.hpp>
#endif

namespace program {

using namespace springfit;

ExactSolver exact_solver(const std::string& name) {
    if (name == "native") {
        return {};
    }
#ifdef SPRINGFIT_PROGRAM_HAS_IPOPT
    return [](const AccelerationProblem& problem, const ExactOptions& options) {
        ipopt::ExactOptions how;
        how.initial = options.initial;
        how.progress = options.progress;
        return ipopt::exact(problem, how);
    };
#else
    throw InvalidArgument("--exact-solver",
                          "native: this program was built without Ipopt (Debian: coinor-libipopt-dev)", name);
#endif
}

} // namespace program
