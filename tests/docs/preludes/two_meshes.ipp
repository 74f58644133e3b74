// A motion of a fine mesh, and a coarser one.
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/motion/record.hpp>
#include <springfit/motion/transfer.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/simulate/symplectic_euler.hpp>
using namespace springfit;
const auto fine = tetrahedron_grid<double>({4, 4, 4}, {0.2, 0.2, 0.2});
const auto coarse = tetrahedron_grid<double>({2, 2, 2}, {0.2, 0.2, 0.2});
auto springs = springs_along_edges(fine, {.density = 1000.});
springs.stiffness.setConstant(100.);
Scenario<3, double> sag;
sag.clamps = {{side_nodes(fine.nodes, {.axis = 0}), {}}};
sag.gravity = {{{0., 0., -1.}, {}}};
const auto recorded = record(springs, sag, {.dt = 0.01, .frames = 5}).motion;
const auto& fine_masses = springs.mass;
