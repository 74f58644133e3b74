// Springs with values, and what is done to them.
#include <springfit/springfit.hpp>
using namespace springfit;
const auto mesh = tetrahedron_grid<double>({2, 3, 2}, {0.2, 0.3, 0.2});
auto network = springs_along_edges(mesh, {.density = 1000.});
network.stiffness = van_gelder(mesh, network.springs, {.young = 5e4, .poisson = 0.25}).stiffness;
const auto clamped = side_nodes(mesh.nodes, {.axis = 1});
const Points<3, double> weight = Vector<3, double>{0., 0., -9.81} * network.mass.transpose();
const double h = 1. / 60;
