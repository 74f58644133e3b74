// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// All of core, and which of its templates `springfit::compiled` holds: with that library linked, include this in the
/// place of `<springfit/springfit.hpp>` (or as well), and they are not compiled again.
///
/// In the plane and in space, in double and float; each plane and solid element with each material, and the closed
/// forms, in double. Everything else is instantiated where it is used, as without it. The lists, one file per part, say
/// `extern template` here and `template` in the library's own units.

#include <springfit/springfit.hpp>

#define SPRINGFIT_INSTANTIATION extern template

#include <springfit/compiled/body.ipp>
#include <springfit/compiled/calibrate.ipp>
#include <springfit/compiled/cases.ipp>
#include <springfit/compiled/closed_form.ipp>
#include <springfit/compiled/fem_plane.ipp>
#include <springfit/compiled/fem_solid.ipp>
#include <springfit/compiled/fem_solvers.ipp>
#include <springfit/compiled/fit_acceleration.ipp>
#include <springfit/compiled/fit_float.ipp>
#include <springfit/compiled/fit_trajectory_2d.ipp>
#include <springfit/compiled/fit_trajectory_3d.ipp>
#include <springfit/compiled/network.ipp>
#include <springfit/compiled/score.ipp>
#include <springfit/compiled/simulate.ipp>
#include <springfit/compiled/simulate_float.ipp>
#include <springfit/compiled/solve.ipp>
#include <springfit/compiled/solve_float.ipp>
