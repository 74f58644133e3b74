// SPDX-License-Identifier: BSD-3-Clause
// Clamp sets and load cases, recorded.

namespace springfit {

SPRINGFIT_INSTANTIATION ClampSets clamp_sets(const Specimen<2, double>&, const ClampSetOptions&);
SPRINGFIT_INSTANTIATION ClampSets clamp_sets(const Specimen<3, double>&, const ClampSetOptions&);
SPRINGFIT_INSTANTIATION bool holds_rigidly<2, double>(const Points<2, double>&, const std::vector<int>&, double);
SPRINGFIT_INSTANTIATION bool holds_rigidly<3, double>(const Points<3, double>&, const std::vector<int>&, double);
SPRINGFIT_INSTANTIATION std::vector<LoadCase<2, double>> random_load_cases(const Specimen<2, double>&,
                                                                           const LoadCaseOptions&);
SPRINGFIT_INSTANTIATION std::vector<LoadCase<3, double>> random_load_cases(const Specimen<3, double>&,
                                                                           const LoadCaseOptions&);
SPRINGFIT_INSTANTIATION RecordedCases<2, double> record_equilibria(const CaseRecorder<2, double>&,
                                                                   const Specimen<2, double>&,
                                                                   std::vector<LoadCase<2, double>>,
                                                                   const RecordEquilibriaOptions<2, double>&);
SPRINGFIT_INSTANTIATION RecordedCases<2, double> record_motions(const CaseRecorder<2, double>&,
                                                                std::vector<LoadCase<2, double>>, double,
                                                                const RecordOptions<double>&, const Execution&);
SPRINGFIT_INSTANTIATION RecordedCases<3, double> record_equilibria(const CaseRecorder<3, double>&,
                                                                   const Specimen<3, double>&,
                                                                   std::vector<LoadCase<3, double>>,
                                                                   const RecordEquilibriaOptions<3, double>&);
SPRINGFIT_INSTANTIATION RecordedCases<3, double> record_motions(const CaseRecorder<3, double>&,
                                                                std::vector<LoadCase<3, double>>, double,
                                                                const RecordOptions<double>&, const Execution&);
SPRINGFIT_INSTANTIATION RecordedCases<2, double>
record_cases(const CaseRecorder<2, double>&, const Specimen<2, double>&, const RecordCasesOptions<2, double>&);
SPRINGFIT_INSTANTIATION RecordedCases<3, double>
record_cases(const CaseRecorder<3, double>&, const Specimen<3, double>&, const RecordCasesOptions<3, double>&);

} // namespace springfit
