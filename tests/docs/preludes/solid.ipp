// A solid and its finite element model.
#include <springfit/parallel/tbb.hpp>
#include <springfit/springfit.hpp>
using namespace springfit;
const auto mesh = tetrahedron_grid<double>({3, 4, 3}, {0.3, 0.4, 0.3});
const fem::Model model{mesh, fem::NeoHookean{.young = 5e4, .poisson = 0.3}, 1000.};
Scenario<3, double> scenario;
scenario.clamps = {{side_nodes(mesh.nodes, {.axis = 1}), {}}};
scenario.gravity = {{{0., 0., -1.}, {}}};
