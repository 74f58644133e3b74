// refused: Mesh<3, float, springfit::Tet4>.*Mesh<3, double, springfit::Tet4>
#include <springfit/fem/model.hpp>

using namespace springfit;

void wrong(const Mesh<3, float, Tet4>& mesh) {
    const fem::Model<3, double, Tet4, fem::NeoHookean> model(mesh, {.young = 1e4, .poisson = 0.3}, 1000.);
}
