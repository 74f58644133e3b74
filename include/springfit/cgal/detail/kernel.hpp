// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace springfit::cgal::detail {

/// Points in double, with exact answers to which side of what they lie on.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

} // namespace springfit::cgal::detail
