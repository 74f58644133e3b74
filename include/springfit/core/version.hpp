// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The one place that holds the version; CMake reads it from here.
#define SPRINGFIT_VERSION_MAJOR 0
#define SPRINGFIT_VERSION_MINOR 1
#define SPRINGFIT_VERSION_PATCH 0
#define SPRINGFIT_VERSION_STRING "0.1.0"
