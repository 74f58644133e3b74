// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/calibrate/candidate.hpp>
#include <springfit/calibrate/options.hpp>
#include <springfit/cases/case_set.hpp>

namespace springfit {

/// The result of `make_candidates`.
template <int Dim>
struct Candidates {
    std::vector<Candidate<Dim>> all; ///< the given networks first, in their order, then the fits; unscored
    std::vector<Warning> warnings;
    bool interrupted = false; ///< a fit was ended early by the callback, or left out
};

/// Every candidate that `options.method` asks for.
///
/// The first of `given` is the prior of acceleration fits. Matching of motion starts at the one that is nearest to the
/// training equilibria that move least, which hardly any network buckles under; it learns from all equilibria, or from
/// windows of the motions where there are none, and acceleration fits the other way round. `options` may have them
/// start at a network that is named, and learn from all cases. Throws InvalidArgument where nothing is given, for a
/// network without positive stiffness, for networks of other nodes than the cases, and for options out of range.
template <int Dim>
[[nodiscard]] Candidates<Dim> make_candidates(const std::vector<NamedNetwork<Dim>>& given,
                                              const RecordedCases<Dim, double>& cases,
                                              const CalibrateOptions& options = {});

} // namespace springfit

#include <springfit/calibrate/detail/candidates_impl.hpp>
