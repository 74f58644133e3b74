// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Everything that needs Eigen alone. Meshing (`cgal/`), Ipopt (`ipopt/`), files (`io/`) and threads
/// (`parallel/`) are included one by one.

#include <springfit/body/implicit_body.hpp>
#include <springfit/body/spring_batch.hpp>
#include <springfit/body/spring_body.hpp>
#include <springfit/calibrate/calibrate.hpp>
#include <springfit/cases/load_cases.hpp>
#include <springfit/cases/noise.hpp>
#include <springfit/cases/strain.hpp>
#include <springfit/closed_form/all.hpp>
#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/closed_form/delingette.hpp>
#include <springfit/core/version.hpp>
#include <springfit/fem/dynamics.hpp>
#include <springfit/fem/loads.hpp>
#include <springfit/fem/statics.hpp>
#include <springfit/fit/acceleration/dominant_term.hpp>
#include <springfit/fit/acceleration/exact.hpp>
#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/fit/trajectory/gauss_newton.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/record_static.hpp>
#include <springfit/motion/replay.hpp>
#include <springfit/motion/surface.hpp>
#include <springfit/motion/transfer.hpp>
#include <springfit/motion/user_reference.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/network/forces.hpp>
#include <springfit/score/embedded_error.hpp>
#include <springfit/score/frequency.hpp>
#include <springfit/score/motion_error.hpp>
#include <springfit/simulate/biquadratic_euler.hpp>
#include <springfit/simulate/equilibrium.hpp>
#include <springfit/simulate/implicit_euler.hpp>
#include <springfit/simulate/projective_euler.hpp>
#include <springfit/simulate/static_solver.hpp>
#include <springfit/simulate/symplectic_euler.hpp>
#include <springfit/solve/block_matrix.hpp>
#include <springfit/solve/newton.hpp>
