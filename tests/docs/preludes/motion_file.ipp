// The page's motion.h5: a hidden body that swings after its release.
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/cases/load_cases.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/io/motion_file.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/simulate/symplectic_euler.hpp>
{
    using namespace springfit;
    const auto mesh = tetrahedron_grid<double>({2, 4, 2}, {0.1, 0.2, 0.1});
    auto hidden = springs_along_edges(mesh, {.density = 1000.});
    hidden.stiffness = 1.3 * van_gelder(mesh, hidden.springs, {.young = 5e4, .poisson = 0.3}).stiffness;
    Scenario<3, double> swing;
    swing.clamps.push_back({side_nodes(mesh.nodes, {.axis = 1}), {}});
    swing.gravity.push_back({{2., -1., 0.5}, ramp_and_release(0.02, 0.05)});
    io::OutputGroup files;
    io::write_motion(files, "motion.h5", record(hidden, swing, {.dt = 0.002, .frames = 90}).motion,
                     io::motion_topology(mesh, hidden.springs));
    files.commit();
}
