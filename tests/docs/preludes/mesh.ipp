// A mesh, one of its nodes and a point within it.
#include <springfit/mesh/structured.hpp>
using namespace springfit;
const auto mesh = tetrahedron_grid<double>({3, 4, 3}, {0.3, 0.4, 0.3});
const int i = 7;
const Vector<3, double> point{0.1, 0.2, 0.15};
