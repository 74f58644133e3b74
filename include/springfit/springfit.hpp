// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Everything that needs Eigen alone. Meshing (`cgal/`), the exact fit (`ipopt/`), files (`io/`) and threads
/// (`parallel/`) are included one by one.

#include <springfit/core/version.hpp>
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/loads.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/motion/user_reference.hpp>
#include <springfit/network/spring_network.hpp>
#include <springfit/solve/clique_matrix.hpp>
#include <springfit/solve/newton.hpp>
