// SPDX-License-Identifier: BSD-3-Clause
// What several fits' tests instantiate of fit_data.hpp.

namespace springfit::test {

SPRINGFIT_INSTANTIATION SpringNetwork<2, float> network_at_rest<2, float>(const Points<2, float>&, const NodePairs&);
SPRINGFIT_INSTANTIATION std::vector<Body<2, float>> bodies<2, float>();
SPRINGFIT_INSTANTIATION void randomise(SpringNetwork<2, float>&, bool, Random&);
SPRINGFIT_INSTANTIATION Points<2, float> accelerations(const SpringNetwork<2, float>&, const Points<2, float>&,
                                                       const Points<2, float>&, const Points<2, float>&);
SPRINGFIT_INSTANTIATION Motion<2, float> random_motion(const SpringNetwork<2, float>&, const std::vector<int>&, int,
                                                       Random&, double);
SPRINGFIT_INSTANTIATION SpringNetwork<3, float> network_at_rest<3, float>(const Points<3, float>&, const NodePairs&);
SPRINGFIT_INSTANTIATION std::vector<Body<3, float>> bodies<3, float>();
SPRINGFIT_INSTANTIATION void randomise(SpringNetwork<3, float>&, bool, Random&);
SPRINGFIT_INSTANTIATION Points<3, float> accelerations(const SpringNetwork<3, float>&, const Points<3, float>&,
                                                       const Points<3, float>&, const Points<3, float>&);
SPRINGFIT_INSTANTIATION Motion<3, float> random_motion(const SpringNetwork<3, float>&, const std::vector<int>&, int,
                                                       Random&, double);
SPRINGFIT_INSTANTIATION SpringNetwork<2, double> network_at_rest<2, double>(const Points<2, double>&, const NodePairs&);
SPRINGFIT_INSTANTIATION std::vector<Body<2, double>> bodies<2, double>();
SPRINGFIT_INSTANTIATION void randomise(SpringNetwork<2, double>&, bool, Random&);
SPRINGFIT_INSTANTIATION Points<2, double> accelerations(const SpringNetwork<2, double>&, const Points<2, double>&,
                                                        const Points<2, double>&, const Points<2, double>&);
SPRINGFIT_INSTANTIATION Motion<2, double> random_motion(const SpringNetwork<2, double>&, const std::vector<int>&, int,
                                                        Random&, double);
SPRINGFIT_INSTANTIATION SpringNetwork<3, double> network_at_rest<3, double>(const Points<3, double>&, const NodePairs&);
SPRINGFIT_INSTANTIATION std::vector<Body<3, double>> bodies<3, double>();
SPRINGFIT_INSTANTIATION void randomise(SpringNetwork<3, double>&, bool, Random&);
SPRINGFIT_INSTANTIATION Points<3, double> accelerations(const SpringNetwork<3, double>&, const Points<3, double>&,
                                                        const Points<3, double>&, const Points<3, double>&);
SPRINGFIT_INSTANTIATION Motion<3, double> random_motion(const SpringNetwork<3, double>&, const std::vector<int>&, int,
                                                        Random&, double);
SPRINGFIT_INSTANTIATION DenseMatrix<double> simplex_stiffness(const Mesh<2, double, Tri3>&, double, double);
SPRINGFIT_INSTANTIATION Motion<2, double> linear_motion(const SpringNetwork<2, double>&, const DenseMatrix<double>&,
                                                        const std::vector<Points<2, double>>&);
SPRINGFIT_INSTANTIATION std::vector<Points<2, double>> smooth_fields<2>(const Points<2, double>&, int, double, double,
                                                                        Random&);
SPRINGFIT_INSTANTIATION Motion<2, double> vibration(const SpringNetwork<2, double>&, const DenseMatrix<double>&, int,
                                                    double, Random&);
SPRINGFIT_INSTANTIATION DenseMatrix<double> simplex_stiffness(const Mesh<3, double, Tet4>&, double, double);
SPRINGFIT_INSTANTIATION Motion<3, double> linear_motion(const SpringNetwork<3, double>&, const DenseMatrix<double>&,
                                                        const std::vector<Points<3, double>>&);
SPRINGFIT_INSTANTIATION std::vector<Points<3, double>> smooth_fields<3>(const Points<3, double>&, int, double, double,
                                                                        Random&);
SPRINGFIT_INSTANTIATION Motion<3, double> vibration(const SpringNetwork<3, double>&, const DenseMatrix<double>&, int,
                                                    double, Random&);

} // namespace springfit::test
