// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "body/example.hpp"
#include "tolerance.hpp"

namespace springfit::test {

/// A body whose nodes are set one by one moves as one that is given arrays, and is read in part as in full.
template <class Body>
void check_node_access(Body by_node, Body by_array, const std::vector<int>& clamped, typename Body::Scalar h) {
    constexpr int dim = Body::dimension;
    using Scalar = typename Body::Scalar;
    Points<dim, Scalar> x, v;
    by_array.read(x, v);
    Points<dim, Scalar> forces(dim, x.cols());
    for (Index i = 0; i < x.size(); ++i) {
        x.data()[i] += Scalar(1e-3) * std::sin(static_cast<Scalar>(i));
        v.data()[i] = std::cos(static_cast<Scalar>(i));
        forces.data()[i] = std::sin(static_cast<Scalar>(3 * i));
    }
    by_array.write(x, v);
    by_array.set_external_forces(forces);
    by_array.set_clamped(clamped);
    by_node.set_clamped(clamped); // kept by what follows
    for (int node = 0; node < x.cols(); ++node) {
        by_node.set_position(node, x.col(node));
        by_node.set_velocity(node, v.col(node));
        by_node.set_external_force(node, forces.col(node) / 2);
        by_node.add_external_force(node, forces.col(node) / 2);
        CHECK(by_node.position(node) == x.col(node));
    }
    by_array.step(h);
    by_node.step(h);
    Points<dim, Scalar> x_array, v_array, x_node, v_node, some;
    by_array.read(x_array, v_array);
    by_node.read(x_node, v_node);
    CHECK(x_array == x_node);
    CHECK(v_array == v_node);
    by_node.read(some);
    CHECK(some == x_node);
    const std::vector<int> nodes{3, 0, 2};
    by_node.read(nodes, some);
    CHECK(some == x_node(Eigen::all, nodes));
}

} // namespace springfit::test
