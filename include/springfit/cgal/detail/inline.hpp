// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The specifier of bodies in `cgal/detail/` that are no templates: inline where headers alone are used, and plain
/// where the library springfit::compiled_cgal holds them (it and its users are compiled with SPRINGFIT_COMPILED_CGAL).
#ifdef SPRINGFIT_COMPILED_CGAL
#define SPRINGFIT_CGAL_INLINE
#else
#define SPRINGFIT_CGAL_INLINE inline
#endif
