// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

#include "peers.hpp"

namespace bench::peers {

namespace {

template <class T>
void write(std::ostream& out, const T* values, std::int64_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * std::int64_t{sizeof(T)}));
}

} // namespace

Solution scipy(const ScaledProblem& problem) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("springfit-bench-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::int64_t n = problem.linear.size();
    const std::int64_t entries = problem.hessian.nonZeros();
    {
        std::ofstream out(folder / "problem.bin", std::ios::binary);
        write(out, &n, 1);
        write(out, &entries, 1);
        write(out, problem.hessian.outerIndexPtr(), n + 1);
        write(out, problem.hessian.innerIndexPtr(), entries);
        write(out, problem.hessian.valuePtr(), entries);
        for (const auto* values : {&problem.linear, &problem.lower, &problem.upper}) {
            write(out, values->data(), n);
        }
    }
    std::ostringstream command;
    command << SPRINGFIT_BENCH_PYTHON " " SPRINGFIT_BENCH_SCIPY_SCRIPT " " << folder.string() << ' '
            << problem.tolerance;
    const bool done = std::system(command.str().c_str()) == 0;
    Solution solution;
    springfit::Values<double> x(n);
    std::ifstream in(folder / "solution.bin", std::ios::binary);
    in.read(reinterpret_cast<char*>(&solution.seconds), sizeof(double));
    in.read(reinterpret_cast<char*>(x.data()), static_cast<std::streamsize>(n * std::int64_t{sizeof(double)}));
    const bool has_read = in.good();
    fs::remove_all(folder);
    if (!done || !has_read) {
        throw std::runtime_error("the script did not return a solution");
    }
    solution.theta = problem.theta(x);
    return solution;
}

} // namespace bench::peers
