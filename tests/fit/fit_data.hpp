// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "instances/instances.hpp"
#include "tolerance.hpp"

#include <random>
#include <string>

#include <springfit/fit/acceleration/objective.hpp>
#include <springfit/mesh/structured.hpp>

namespace springfit::test {

template <int Dim, class Scalar>
struct Body {
    std::string name;
    SpringNetwork<Dim, Scalar> network;
    std::vector<int> clamped;
};

class Random {
public:
    explicit Random(unsigned seed) : m_engine(seed) {}
    double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(m_engine); }

    template <int Dim, class Scalar>
    Points<Dim, Scalar> points(Index n, double size) {
        Points<Dim, Scalar> result(Dim, n);
        for (Scalar& value : result.reshaped()) {
            value = static_cast<Scalar>((*this)(-size, size));
        }
        return result;
    }

private:
    std::mt19937 m_engine;
};

template <int Dim, class Scalar>
SpringNetwork<Dim, Scalar> network_at_rest(const Points<Dim, Scalar>& nodes, const NodePairs& pairs) {
    SpringNetwork<Dim, Scalar> network;
    network.rest_positions = nodes;
    network.springs = pairs;
    network.mass = Values<Scalar>::Ones(nodes.cols());
    network.stiffness = Values<Scalar>::Ones(pairs.cols());
    network.damping = Values<Scalar>::Zero(pairs.cols());
    network.rest_length.resize(pairs.cols());
    for (Index e = 0; e < pairs.cols(); ++e) {
        network.rest_length(e) = (nodes.col(pairs(1, e)) - nodes.col(pairs(0, e))).norm();
    }
    return network;
}

inline NodePairs join(const NodePairs& a, const NodePairs& b) {
    NodePairs all(2, a.cols() + b.cols());
    all << a, b;
    return all;
}

/// Small bodies of every kind of this dimension; the clamped nodes share a spring and leave most of the body free.
template <int Dim, class Scalar>
std::vector<Body<Dim, Scalar>> bodies() {
    std::vector<Body<Dim, Scalar>> all;
    const auto braced = [](const auto& mesh) {
        return network_at_rest<Dim, Scalar>(mesh.nodes, join(edges(mesh), diagonals(mesh)));
    };
    if constexpr (Dim == 2) {
        auto triangles = triangle_grid<Scalar>({5, 4}, {Scalar(1.25), Scalar(1)});
        jitter(triangles, Scalar(0.3), 11u);
        all.push_back({"triangles", network_at_rest<2, Scalar>(triangles.nodes, edges(triangles)), {0, 1}});
        auto quads = quad_grid<Scalar>({4, 4}, {Scalar(1), Scalar(1)});
        jitter(quads, Scalar(0.2), 12u);
        all.push_back({"braced quadrilaterals", braced(quads), {0, 1}});
    } else {
        auto tets = tetrahedron_grid<Scalar>({2, 2, 2}, {Scalar(0.5), Scalar(0.5), Scalar(0.5)});
        jitter(tets, Scalar(0.2), 13u);
        all.push_back({"tetrahedra", network_at_rest<3, Scalar>(tets.nodes, edges(tets)), {0, 1}});
        all.push_back({"braced hexahedra",
                       braced(hex_grid<Scalar>({2, 2, 1}, {Scalar(0.5), Scalar(0.5), Scalar(0.25)})),
                       {0, 1}});
        auto plane = triangle_grid<Scalar>({5, 4}, {Scalar(1.25), Scalar(1)});
        jitter(plane, Scalar(0.3), 14u);
        const auto sheet = membrane(plane);
        all.push_back({"membrane", network_at_rest<3, Scalar>(sheet.nodes, edges(sheet)), {0, 1}});
    }
    return all;
}

/// Gives a network random masses, stiffness over a decade and, where wanted, damping over a decade, 1e-3 as large.
template <int Dim, class Scalar>
void randomise(SpringNetwork<Dim, Scalar>& network, bool damped, Random& random) {
    for (Scalar& m : network.mass) {
        m = static_cast<Scalar>(random(0.5, 2));
    }
    for (Index e = 0; e < network.n_springs(); ++e) {
        network.stiffness(e) = static_cast<Scalar>(std::pow(10., random(2, 3)));
        network.damping(e) = static_cast<Scalar>(damped ? std::pow(10., random(-1, 0)) : 0.);
    }
}

/// What the springs and cells of a network do to its nodes, written down once more, in double.
template <int Dim, class Scalar>
Points<Dim, Scalar> accelerations(const SpringNetwork<Dim, Scalar>& network, const Points<Dim, Scalar>& positions,
                                  const Points<Dim, Scalar>& velocities, const Points<Dim, Scalar>& forces) {
    const Points<Dim, double> x = positions.template cast<double>();
    const Points<Dim, double> v = velocities.template cast<double>();
    Points<Dim, double> total = forces.template cast<double>();
    for (Index e = 0; e < network.n_springs(); ++e) {
        const int i = network.springs(0, e);
        const int j = network.springs(1, e);
        const double length = (x.col(j) - x.col(i)).norm();
        const Vector<Dim, double> n = (x.col(j) - x.col(i)) / length;
        const double tension = double(network.stiffness(e)) * (length - double(network.rest_length(e))) +
                               double(network.damping(e)) * (v.col(j) - v.col(i)).dot(n);
        total.col(i) += tension * n;
        total.col(j) -= tension * n;
    }
    for (Index c = 0; c < network.n_cells(); ++c) {
        Eigen::Matrix<double, Dim + 1, Dim + 1> corners = Eigen::Matrix<double, Dim + 1, Dim + 1>::Ones();
        for (int a = 0; a <= Dim; ++a) {
            corners.template block<Dim, 1>(1, a) = x.col(network.cells(a, c));
        }
        const double volume = corners.determinant() / (Dim == 2 ? 2 : 6);
        const double rest = double(network.rest_volume(c));
        const Eigen::Matrix<double, Dim + 1, Dim> gradient = volume * corners.inverse().template rightCols<Dim>();
        for (int a = 0; a <= Dim; ++a) {
            total.col(network.cells(a, c)) -=
                double(network.volume_stiffness(c)) * (volume / rest - 1) * gradient.row(a).transpose();
        }
    }
    for (Index i = 0; i < total.cols(); ++i) {
        total.col(i) /= double(network.mass(i));
    }
    return total.template cast<Scalar>();
}

/// Frames far from rest (springs strained by up to about half their length), moving and loaded at random, each with the
/// network's own accelerations.
template <int Dim, class Scalar>
Motion<Dim, Scalar> random_motion(const SpringNetwork<Dim, Scalar>& network, const std::vector<int>& clamped,
                                  int frames, Random& random, double load = 1) {
    Motion<Dim, Scalar> motion;
    motion.name = "random";
    motion.rest_positions = network.rest_positions;
    motion.clamped = clamped;
    const double size = 0.25 * double(network.rest_length.minCoeff());
    const Index n = network.n_nodes();
    for (int t = 0; t < frames; ++t) {
        motion.times.push_back(static_cast<Scalar>(t));
        motion.positions.push_back(network.rest_positions + random.points<Dim, Scalar>(n, size));
        motion.velocities.push_back(random.points<Dim, Scalar>(n, 1));
        motion.external_forces.push_back(random.points<Dim, Scalar>(n, load));
        motion.accelerations.push_back(accelerations<Dim, Scalar>(
            network, motion.positions.back(), motion.velocities.back(), motion.external_forces.back()));
    }
    return motion;
}

/// Largest relative error of `found` where the spring has an unknown.
template <class Scalar>
double relative_error(const Parameters& parameters, ParameterKind kind, const Values<Scalar>& found,
                      const Values<Scalar>& truth) {
    double worst = 0;
    for (Index e = 0; e < truth.size(); ++e) {
        if (parameters.unknown(kind, e) >= 0) {
            worst = maximum(worst, std::abs(double(found(e)) - double(truth(e))) / std::abs(double(truth(e))));
        }
    }
    return worst;
}

/// Stiffness matrix [Dim n x Dim n] of linear elasticity over a simplex mesh with linear shape functions;
/// in the plane, plane stress of unit thickness.
template <int Dim, CellType Cell>
DenseMatrix<double> simplex_stiffness(const Mesh<Dim, double, Cell>& mesh, double young, double poisson) {
    const double mu = young / (2 * (1 + poisson));
    const double lambda =
        Dim == 2 ? young * poisson / (1 - poisson * poisson) : young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    DenseMatrix<double> k = DenseMatrix<double>::Zero(Dim * mesh.n_nodes(), Dim * mesh.n_nodes());
    for (Index c = 0; c < mesh.n_cells(); ++c) {
        Eigen::Matrix<double, Dim + 1, Dim + 1> corners;
        corners << Eigen::Matrix<double, 1, Dim + 1>::Ones(), mesh.cell_nodes(c);
        const double volume = std::abs(corners.determinant()) / (Dim == 2 ? 2 : 6);
        const Eigen::Matrix<double, Dim + 1, Dim> gradients = corners.inverse().template rightCols<Dim>();
        for (int a = 0; a <= Dim; ++a) {
            for (int b = 0; b <= Dim; ++b) {
                const Vector<Dim, double> ga = gradients.row(a);
                const Vector<Dim, double> gb = gradients.row(b);
                k.block(Dim * mesh.cells(a, c), Dim * mesh.cells(b, c), Dim, Dim) +=
                    volume * (lambda * ga * gb.transpose() + mu * gb * ga.transpose() +
                              mu * ga.dot(gb) * Eigen::Matrix<double, Dim, Dim>::Identity());
            }
        }
    }
    return k;
}

/// One frame at rest velocity per displacement, with the accelerations -K u / m.
template <int Dim>
Motion<Dim, double> linear_motion(const SpringNetwork<Dim, double>& network, const DenseMatrix<double>& stiffness,
                                  const std::vector<Points<Dim, double>>& displacements) {
    Motion<Dim, double> motion;
    motion.name = "linear";
    motion.rest_positions = network.rest_positions;
    for (const auto& u : displacements) {
        const Values<double> force = -stiffness * u.reshaped();
        Points<Dim, double> a = force.reshaped(Dim, u.cols());
        for (Index i = 0; i < a.cols(); ++i) {
            a.col(i) /= network.mass(i);
        }
        motion.times.push_back(static_cast<double>(motion.times.size()));
        motion.positions.push_back(network.rest_positions + u);
        motion.velocities.push_back(Points<Dim, double>::Zero(Dim, u.cols()));
        motion.external_forces.push_back(Points<Dim, double>::Zero(Dim, u.cols()));
        motion.accelerations.push_back(a);
    }
    return motion;
}

/// Smooth fields: sums of four plane waves of random direction, with up to `waves` radians per metre.
template <int Dim>
std::vector<Points<Dim, double>> smooth_fields(const Points<Dim, double>& nodes, int count, double amplitude,
                                               double waves, Random& random) {
    std::vector<Points<Dim, double>> fields;
    for (int f = 0; f < count; ++f) {
        Points<Dim, double> u = Points<Dim, double>::Zero(Dim, nodes.cols());
        for (int wave = 0; wave < 4; ++wave) {
            const Vector<Dim, double> direction = random.points<Dim, double>(1, amplitude);
            const Vector<Dim, double> number = random.points<Dim, double>(1, waves);
            const double phase = random(0, 6.28);
            for (Index i = 0; i < nodes.cols(); ++i) {
                u.col(i) += std::sin(number.dot(nodes.col(i)) + phase) * direction;
            }
        }
        fields.push_back(u);
    }
    return fields;
}

/// A linear body let go from a smooth deformation, with the nodes at x = 0 clamped: frames of its free vibration.
template <int Dim>
Motion<Dim, double> vibration(const SpringNetwork<Dim, double>& network, const DenseMatrix<double>& stiffness,
                              int frames, double amplitude, Random& random) {
    const Index n = network.n_nodes();
    std::vector<int> clamped;
    for (Index i = 0; i < n; ++i) {
        if (network.rest_positions(0, i) < 1e-9) {
            clamped.push_back(static_cast<int>(i));
        }
    }
    const Vector<Dim, double> size = network.rest_positions.rowwise().maxCoeff();
    Points<Dim, double> u = Points<Dim, double>::Zero(Dim, n);
    for (int wave = 0; wave < 8; ++wave) {
        const Vector<Dim, double> direction = random.points<Dim, double>(1, amplitude);
        const Vector<Dim, double> number = random.points<Dim, double>(1, 6);
        for (Index i = 0; i < n; ++i) {
            const Vector<Dim, double> x = network.rest_positions.col(i).cwiseQuotient(size);
            u.col(i) += x(0) * std::sin(number.dot(x) + wave) * direction;
        }
    }
    const Values<double> masses = network.mass.transpose().template replicate<Dim, 1>().reshaped();
    const double fastest = std::sqrt(stiffness.cwiseAbs().rowwise().sum().cwiseQuotient(masses).maxCoeff());
    Values<double> position = u.reshaped();
    Values<double> velocity = Values<double>::Zero(position.size());
    std::vector<Points<Dim, double>> displacements;
    for (int step = 0; step < 10 * frames; ++step) {
        if (step % 10 == 0) {
            displacements.push_back(position.reshaped(Dim, n));
        }
        velocity -= 0.5 / fastest * (stiffness * position).cwiseQuotient(masses);
        for (int node : clamped) {
            velocity.segment<Dim>(Dim * node).setZero();
        }
        position += 0.5 / fastest * velocity;
    }
    Motion<Dim, double> motion = linear_motion<Dim>(network, stiffness, displacements);
    motion.clamped = clamped;
    return motion;
}

} // namespace springfit::test

#include "fit_data.ipp" // compiled once
