// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What most tests include: core, and which of its templates springfit_checked holds, those that tests alone use too.

#include <doctest/doctest.h>

#include <springfit/compiled/compiled.hpp>

#include "biquadratic.ipp"
#include "biquadratic_steps.ipp"
#include "loads.ipp"
#include "loads_float.ipp"
#include "meshes.ipp"
#include "models.ipp"
#include "networks.ipp"
