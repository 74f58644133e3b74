// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

/// What an engineer writes in an hour, without any library: the baselines that the benchmarks stand beside.
namespace plain {

template <int Dim, class Scalar>
struct Body {
    std::vector<Scalar> x, v, f, mass; // Dim per node, one mass per node
    std::vector<int> ends;             // two per spring
    std::vector<Scalar> k, rest_length, damping;
    std::vector<char> fixed;
    std::vector<int> corners; // Dim + 1 per cell
    std::vector<Scalar> rest_volume, volume_stiffness;
};

/// The forces of cells that hold their volume, from the first corner's edges.
template <int Dim, class Scalar>
void add_cells(Body<Dim, Scalar>& body) {
    for (std::size_t c = 0; c < body.rest_volume.size(); ++c) {
        const int* corners = &body.corners[(Dim + 1) * c];
        Scalar edges[Dim][Dim], gradients[Dim][Dim];
        for (int a = 0; a < Dim; ++a) {
            for (int d = 0; d < Dim; ++d) {
                edges[a][d] = body.x[static_cast<std::size_t>(Dim * corners[a + 1] + d)] -
                              body.x[static_cast<std::size_t>(Dim * corners[0] + d)];
            }
        }
        if constexpr (Dim == 2) {
            gradients[0][0] = edges[1][1] / 2;
            gradients[0][1] = -edges[1][0] / 2;
            gradients[1][0] = -edges[0][1] / 2;
            gradients[1][1] = edges[0][0] / 2;
        } else {
            for (int a = 0; a < 3; ++a) {
                const Scalar* p = edges[(a + 1) % 3];
                const Scalar* q = edges[(a + 2) % 3];
                for (int d = 0; d < 3; ++d) {
                    gradients[a][d] = (p[(d + 1) % 3] * q[(d + 2) % 3] - p[(d + 2) % 3] * q[(d + 1) % 3]) / 6;
                }
            }
        }
        Scalar volume = 0;
        for (int d = 0; d < Dim; ++d) {
            volume += edges[0][d] * gradients[0][d];
        }
        const Scalar pressure = body.volume_stiffness[c] * (1 - volume / body.rest_volume[c]);
        for (int a = 0; a < Dim; ++a) {
            for (int d = 0; d < Dim; ++d) {
                body.f[static_cast<std::size_t>(Dim * corners[a + 1] + d)] += pressure * gradients[a][d];
                body.f[static_cast<std::size_t>(Dim * corners[0] + d)] -= pressure * gradients[a][d];
            }
        }
    }
}

/// One symplectic Euler step, springs in their given order.
template <int Dim, class Scalar>
void step(Body<Dim, Scalar>& body, Scalar dt) {
    for (Scalar& f : body.f) {
        f = 0;
    }
    const std::size_t n_springs = body.k.size();
    for (std::size_t e = 0; e < n_springs; ++e) {
        const Scalar* xi = &body.x[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        const Scalar* xj = &body.x[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        const Scalar* vi = &body.v[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        const Scalar* vj = &body.v[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        Scalar* fi = &body.f[static_cast<std::size_t>(Dim * body.ends[2 * e])];
        Scalar* fj = &body.f[static_cast<std::size_t>(Dim * body.ends[2 * e + 1])];
        Scalar r[Dim];
        Scalar length2 = 0;
        Scalar rate = 0;
        for (int d = 0; d < Dim; ++d) {
            r[d] = xj[d] - xi[d];
            length2 += r[d] * r[d];
            rate += r[d] * (vj[d] - vi[d]);
        }
        const Scalar length = std::sqrt(length2);
        const Scalar pull = (body.k[e] * (length - body.rest_length[e]) + body.damping[e] * rate / length) / length;
        for (int d = 0; d < Dim; ++d) {
            fi[d] += pull * r[d];
            fj[d] -= pull * r[d];
        }
    }
    add_cells(body);
    for (std::size_t i = 0; i < body.mass.size(); ++i) {
        if (body.fixed[i]) {
            continue;
        }
        for (int d = 0; d < Dim; ++d) {
            body.v[Dim * i + d] += dt * body.f[Dim * i + d] / body.mass[i];
            body.x[Dim * i + d] += dt * body.v[Dim * i + d];
        }
    }
}

/// One linearised implicit step, (M + h C + h^2 K) dv = h f - h^2 K v at the present positions, by conjugate gradients
/// with the inverse diagonal to a residual of `tolerance` in the norm of the diagonal. No fixed node moves.
template <int Dim, class Scalar>
struct Implicit {
    std::vector<Scalar> blocks, diagonal, dv, r, z, p, q; // Dim x Dim per spring, Dim per node
    int iterations = 0;

    void multiply(const Body<Dim, Scalar>& body, const std::vector<Scalar>& in, std::vector<Scalar>& out) const {
        for (std::size_t i = 0; i < in.size(); ++i) {
            out[i] = body.mass[i / Dim] * in[i];
        }
        for (std::size_t e = 0; e < body.k.size(); ++e) {
            const std::size_t i = static_cast<std::size_t>(Dim * body.ends[2 * e]);
            const std::size_t j = static_cast<std::size_t>(Dim * body.ends[2 * e + 1]);
            for (int a = 0; a < Dim; ++a) {
                Scalar f = 0;
                for (int b = 0; b < Dim; ++b) {
                    f += blocks[Dim * Dim * e + Dim * a + b] * (in[j + b] - in[i + b]);
                }
                out[i + a] -= f;
                out[j + a] += f;
            }
        }
    }

    void step(Body<Dim, Scalar>& body, const std::vector<Scalar>& external, Scalar h, Scalar tolerance) {
        const std::size_t n = body.x.size();
        blocks.resize(Dim * Dim * body.k.size());
        for (auto* values : {&diagonal, &dv, &r, &z, &p, &q}) {
            values->assign(n, 0);
        }
        for (std::size_t i = 0; i < n; ++i) {
            diagonal[i] = body.mass[i / Dim];
            r[i] = h * external[i];
        }
        for (std::size_t e = 0; e < body.k.size(); ++e) {
            const std::size_t i = static_cast<std::size_t>(Dim * body.ends[2 * e]);
            const std::size_t j = static_cast<std::size_t>(Dim * body.ends[2 * e + 1]);
            Scalar length2 = 0, rate = 0, u[Dim];
            for (int d = 0; d < Dim; ++d) {
                u[d] = body.x[j + d] - body.x[i + d];
                length2 += u[d] * u[d];
            }
            const Scalar length = std::sqrt(length2);
            for (int d = 0; d < Dim; ++d) {
                u[d] /= length;
                rate += u[d] * (body.v[j + d] - body.v[i + d]);
            }
            const Scalar c1 = body.k[e] * (1 - body.rest_length[e] / length);
            const Scalar pull = body.k[e] * (length - body.rest_length[e]) + body.damping[e] * rate;
            for (int a = 0; a < Dim; ++a) {
                Scalar along = 0; // of h^2 K v
                for (int b = 0; b < Dim; ++b) {
                    const Scalar elastic = h * h * ((body.k[e] - c1) * u[a] * u[b] + (a == b ? c1 : 0));
                    along += elastic * (body.v[j + b] - body.v[i + b]);
                    blocks[Dim * Dim * e + Dim * a + b] = elastic + h * body.damping[e] * u[a] * u[b];
                }
                const Scalar f = h * pull * u[a] + along;
                r[i + a] += f;
                r[j + a] -= f;
                diagonal[i + a] += blocks[Dim * Dim * e + Dim * a + a];
                diagonal[j + a] += blocks[Dim * Dim * e + Dim * a + a];
            }
        }
        double rz = 0;
        for (std::size_t i = 0; i < n; ++i) {
            diagonal[i] = body.fixed[i / Dim] ? 0 : 1 / diagonal[i];
            p[i] = z[i] = diagonal[i] * r[i];
            rz += r[i] * z[i];
        }
        const double goal = tolerance * tolerance * rz;
        for (iterations = 0; rz > goal && iterations < 1000; ++iterations) {
            multiply(body, p, q);
            double curvature = 0;
            for (std::size_t i = 0; i < n; ++i) {
                curvature += p[i] * q[i];
            }
            const Scalar alpha = static_cast<Scalar>(rz / curvature);
            const double before = rz;
            rz = 0;
            for (std::size_t i = 0; i < n; ++i) {
                dv[i] += alpha * p[i];
                r[i] -= alpha * q[i];
                z[i] = diagonal[i] * r[i];
                rz += r[i] * z[i];
            }
            const Scalar beta = static_cast<Scalar>(rz / before);
            for (std::size_t i = 0; i < n; ++i) {
                p[i] = z[i] + beta * p[i];
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            body.v[i] += dv[i];
            body.x[i] += h * body.v[i];
        }
    }
};

} // namespace plain
