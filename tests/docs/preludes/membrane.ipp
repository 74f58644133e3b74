// A cloth that hangs from two sides.
#include <springfit/springfit.hpp>
using namespace springfit;
const auto mesh = membrane(triangle_grid<double>({4, 4}, {0.4, 0.4}));
Scenario<3, double> scenario;
scenario.clamps = {{side_nodes(mesh.nodes, {.axis = 0}), {}},
                   {side_nodes(mesh.nodes, {.axis = 0, .at_max = true}), {}}};
scenario.gravity = {{{0., 0., -9.81}, {}}};
