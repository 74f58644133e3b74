// SPDX-License-Identifier: BSD-3-Clause
// Every body that steps, in the plane and in space, in both precisions: what a user's unit instantiates of vector
// types.
#include <springfit/springfit.hpp>

namespace {

using namespace springfit;

template <class Body, int Dim, class Scalar>
double move(const SpringNetwork<Dim, Scalar>& network) {
    Body body(network);
    Points<Dim, Scalar> positions, velocities;
    body.set_clamped({0});
    body.step(Scalar(1e-3));
    body.read(positions, velocities);
    return static_cast<double>((positions - network.rest_positions).norm());
}

template <int Dim, class Scalar, class Cell>
double move_all(const Mesh<Dim, Scalar, Cell>& mesh) {
    auto network = springs_along_edges(mesh, {.density = Scalar(1000)});
    network.stiffness.setConstant(Scalar(10));
    network.rest_length *= Scalar(0.9);
    add_volume_cells(network, mesh);
    network.volume_stiffness.setConstant(Scalar(10));
    SpringBatch<Dim, Scalar> batch(network, 3);
    batch.set_clamped({0});
    batch.step(Scalar(1e-3));
    Points<Dim, Scalar> positions, velocities;
    batch.read(1, positions, velocities);
    return move<SpringBody<Dim, Scalar>>(network) + move<ImplicitBody<Dim, Scalar>>(network) +
           static_cast<double>((positions - network.rest_positions).norm());
}

} // namespace

// CONSUMER_IN_DOUBLE and CONSUMER_IN_SPACE leave out kinds, since each takes long to compile.
int main() {
    double moved = move_all(tetrahedron_grid<double>({2, 2, 2}, {1., 1., 1.}));
#ifndef CONSUMER_IN_SPACE
    moved += move_all(triangle_grid<double>({2, 2}, {1., 1.}));
#endif
#ifndef CONSUMER_IN_DOUBLE
    moved += move_all(tetrahedron_grid<float>({2, 2, 2}, {1.f, 1.f, 1.f}));
#endif
    return moved > 0 ? 0 : 1;
}
