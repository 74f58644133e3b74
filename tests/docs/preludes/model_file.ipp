// The page's model.json, as the page before leaves it: a small box that is held at the lowest y.
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/closed_form/cauchy_split.hpp>
#include <springfit/io/model_json.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/simulate/stable_step.hpp>
{
    using namespace springfit;
    const auto mesh = tetrahedron_grid<double>({2, 4, 2}, {0.1, 0.2, 0.1});
    io::Model<3, double> model{.network = springs_along_edges(mesh, {.volume = true, .density = 1000.})};
    apply(cauchy_split(mesh, model.network.springs, {.young = 5e4, .poisson = 0.3}), model.network);
    model.network.damping = stiffness_proportional_damping(model.network, 1e-3);
    model.fixed = side_nodes(mesh.nodes, {.axis = 1});
    model.stable_time_step = stable_step(model.network, model.fixed);
    io::write_model("model.json", model);
}
