// refused: constraints not satisfied|constraint failure
#include <springfit/fem/model.hpp>

using namespace springfit;

struct Jelly {};

void wrong(const Mesh<3, double, Tet4>& mesh) {
    const fem::Model<3, double, Tet4, Jelly> model(mesh, {}, 1000.);
}
