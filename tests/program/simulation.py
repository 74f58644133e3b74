# SPDX-License-Identifier: BSD-3-Clause
"""A simulation of its own of a model.json under recorded motions, which shares no code with springfit.

    simulation.py MODEL.json MOTION.h5...

prints sqrt(sum |x - x_ref|^2 / sum |x_ref - x_rest|^2), over free nodes and frames, of each file and of all together. A
file of one frame is an equilibrium under its forces; several frames are stepped from the first of them.
"""

import json
import sys

import h5py
import numpy
import scipy.sparse
import scipy.sparse.linalg


class Recording:
    """A recorded motion; what the file lacks is filled in as docs/files.md says."""

    def __init__(self, path):
        with h5py.File(path) as file:
            read = lambda name: numpy.array(file[name], dtype=float) if name in file else None
            self.rest = read("/mesh/points")
            self.times = read("/time")
            self.positions = self.rest + read("/reference/displacement")
            velocities = read("/reference/velocity")
            forces = read("/reference/force")
            self.clamped = numpy.array(file["/mesh/clamped"], dtype=int) if "/mesh/clamped" in file else None
        n_frames = len(self.times)
        if velocities is None and n_frames == 1:
            velocities = numpy.zeros_like(self.positions)
        elif velocities is None:
            velocities = numpy.gradient(self.positions, self.times, axis=0, edge_order=min(2, n_frames - 1))
        self.velocities = velocities
        self.forces = numpy.zeros_like(self.positions) if forces is None else forces


class Model:
    """The network of a model.json: forces, and the second derivative of its energy."""

    def __init__(self, data):
        self.rest = numpy.array(data["nodes"]["rest_position"], dtype=float)
        self.mass = numpy.array(data["nodes"]["mass"], dtype=float)
        self.fixed = numpy.array(data["nodes"].get("fixed", []), dtype=int)
        self.n, self.dim = self.rest.shape
        springs = data["springs"]
        self.ends = numpy.array(springs["nodes"], dtype=int).reshape(-1, 2)
        self.stiffness, self.rest_length, self.damping = (
            numpy.array(springs[name], dtype=float) for name in ("stiffness", "rest_length", "damping"))
        cells = data.get("cells", {"nodes": [], "rest_volume": [], "stiffness": []})
        self.corners = numpy.array(cells["nodes"], dtype=int).reshape(-1, self.dim + 1)
        self.rest_volume = numpy.array(cells["rest_volume"], dtype=float)
        self.bulk = numpy.array(cells["stiffness"], dtype=float)
        # Differences along the springs, and sums over the corners of the cells, as products with sparse matrices.
        s, c = len(self.ends), len(self.corners)
        self.along = scipy.sparse.csr_matrix(
            (numpy.tile([-1., 1.], s), (numpy.repeat(numpy.arange(s), 2), self.ends.ravel())), (s, self.n))
        self.against = self.along.T.tocsr()
        self.at_corners = scipy.sparse.csr_matrix(
            (numpy.ones(c * (self.dim + 1)), (self.corners.ravel(), numpy.arange(c * (self.dim + 1)))),
            (self.n, c * (self.dim + 1)))

    def spring_state(self, x):
        """Lengths and directions from the first end to the second."""
        r = self.along @ x
        length = numpy.sqrt(numpy.einsum("ij,ij->i", r, r))
        return length, r / length[:, None]

    def volumes(self, x):
        return volumes(x[self.corners])

    def energy(self, x):
        length, _ = self.spring_state(x)
        total = self.stiffness @ (length - self.rest_length)**2 / 2
        if len(self.corners):
            total += (self.bulk / self.rest_volume) @ (self.volumes(x)[0] - self.rest_volume)**2 / 2
        return total

    def elastic_forces(self, x, state=None):
        length, direction = state or self.spring_state(x)
        tension = self.stiffness * (length - self.rest_length)
        forces = -(self.against @ (tension[:, None] * direction))
        if len(self.corners):
            volume, gradient = self.volumes(x)
            pressure = -self.bulk * (volume - self.rest_volume) / self.rest_volume
            forces += self.at_corners @ (pressure[:, None, None] * gradient).reshape(-1, self.dim)
        return forces

    def damping_forces(self, direction, v):
        rate = numpy.einsum("ij,ij->i", direction, self.along @ v)
        return -(self.against @ ((self.damping * rate)[:, None] * direction))

    def hessian(self, x, convex=False):
        """Second derivative of the energy; `convex` leaves out what can make it indefinite."""
        length, n = self.spring_state(x)
        across = 1 - self.rest_length / length
        if convex:
            across = numpy.maximum(across, 0)
        blocks = (self.stiffness * across)[:, None, None] * numpy.eye(self.dim)
        blocks = blocks + (self.stiffness * (1 - across))[:, None, None] * n[:, :, None] * n[:, None, :]
        springs = self.spring_matrix(blocks)
        return springs + self.cell_matrix(x, convex) if len(self.corners) else springs

    def damping_matrix(self, x):
        _, n = self.spring_state(x)
        return self.spring_matrix(self.damping[:, None, None] * n[:, :, None] * n[:, None, :])

    def spring_matrix(self, blocks):
        signs = numpy.array([[1., -1.], [-1., 1.]])
        return self.assembled(self.ends, signs[None, :, None, :, None] * blocks[:, None, :, None, :])

    def cell_matrix(self, x, convex):
        corners, dim = self.dim + 1, self.dim
        volume, gradient = self.volumes(x)
        bulk = numpy.maximum(self.bulk, 0) if convex else self.bulk
        blocks = numpy.einsum("c,cai,cbj->caibj", bulk / self.rest_volume, gradient, gradient)
        if not convex:
            pressure = self.bulk * (volume - self.rest_volume) / self.rest_volume
            # dV/dx is linear (plane) or quadratic (space) in the corners: central differences of it are exact.
            for b in range(corners):
                for j in range(dim):
                    step = numpy.zeros((len(self.corners), corners, dim))
                    step[:, b, j] = 1
                    ahead, behind = (volumes(x[self.corners] + sign * step)[1] for sign in (1, -1))
                    blocks[:, :, :, b, j] += pressure[:, None, None] * (ahead - behind) / 2
        return self.assembled(self.corners, blocks)

    def assembled(self, nodes, blocks):
        """Sum of dense blocks [parts x nodes x dim x nodes x dim] of the parts of the network."""
        size = nodes.shape[1] * self.dim
        rows = (nodes[:, :, None] * self.dim + numpy.arange(self.dim)).reshape(-1, size)
        i = numpy.repeat(rows, size, axis=1).ravel()
        j = numpy.tile(rows, (1, size)).ravel()
        total = self.n * self.dim
        return scipy.sparse.csc_matrix((blocks.ravel(), (i, j)), (total, total))


def cross(a, b):
    return numpy.stack([a[:, (i + 1) % 3] * b[:, (i + 2) % 3] - a[:, (i + 2) % 3] * b[:, (i + 1) % 3]
                        for i in range(3)], 1)


def volumes(corners):
    """V of simplices [cells x corners x dim], and dV/dx of their corners."""
    e = corners[:, 1:] - corners[:, :1]
    gradient = numpy.empty(corners.shape)
    if corners.shape[2] == 2:
        a, b = e[:, 0], e[:, 1]
        gradient[:, 1] = numpy.stack([b[:, 1], -b[:, 0]], 1) / 2
        gradient[:, 2] = numpy.stack([-a[:, 1], a[:, 0]], 1) / 2
    else:
        for i in range(3):
            gradient[:, i + 1] = cross(e[:, (i + 1) % 3], e[:, (i + 2) % 3]) / 6
    gradient[:, 0] = -gradient[:, 1:].sum(1)
    return numpy.einsum("ci,ci->c", e[:, 0], gradient[:, 1]), gradient


def free_nodes(model, recording):
    clamped = model.fixed if recording.clamped is None else recording.clamped
    free = numpy.ones(model.n, dtype=bool)
    free[clamped] = False
    return free


def solve_definite(matrix, right):
    """The solution, and whether the symmetric matrix is positive definite."""
    factor = scipy.sparse.linalg.splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0,
                                      options={"SymmetricMode": True})
    return factor.solve(right), bool(numpy.all(factor.U.diagonal() > 0))


def equilibrium(model, forces, start, free):
    """Positions at rest under forces, with all but the `free` nodes held where `start` has them: Newton's method on the
    potential. Raises RuntimeError where none is found that is stable."""
    unknown = numpy.repeat(free, model.dim)
    x = start.copy()
    potential = lambda at: model.energy(at) - numpy.sum(forces * at)
    for _ in range(200):
        residual = (model.elastic_forces(x) + forces).ravel()[unknown]
        step, definite = solve_definite(model.hessian(x)[unknown][:, unknown], residual)
        if numpy.linalg.norm(residual) <= 1e-9 * numpy.linalg.norm(forces) and definite:
            return x
        if not definite:
            convex = model.hessian(x, convex=True)[unknown][:, unknown]
            shift = 1e-6 * convex.diagonal().max() * scipy.sparse.identity(len(residual), format="csc")
            step, _ = solve_definite((convex + shift).tocsc(), residual)
        move = numpy.zeros(x.size)
        move[unknown] = step
        move = move.reshape(x.shape)
        slope, before, length = residual @ step, potential(x), 1.
        while potential(x + length * move) > before - 1e-4 * length * slope + 1e-13 * abs(before):
            length /= 2
            if length < 1e-12:
                raise RuntimeError("no equilibrium: the line search ended")
        x = x + length * move
    raise RuntimeError("no equilibrium: too many iterations")


def largest_rate(model, matrix, free):
    """Largest eigenvalue of a matrix of the free nodes over their masses."""
    unknown = numpy.repeat(free, model.dim)
    scale = scipy.sparse.diags(1 / numpy.sqrt(numpy.repeat(model.mass, model.dim)[unknown]))
    scaled = scale @ matrix[unknown][:, unknown] @ scale
    if scaled.nnz == 0:
        return 0.
    start = numpy.cos(numpy.arange(scaled.shape[0]))
    return abs(scipy.sparse.linalg.eigsh(scaled, k=1, which="LM", v0=start, tol=1e-2, return_eigenvectors=False)[0])


def stepped(model, recording, free, step_fraction=0.5):
    """Positions in the frames of a recording: velocity Verlet from its first, under its forces, which are linear
    between frames, as are the places of held nodes. `step_fraction` is of the longest stable step at rest."""
    times = recording.times
    stable = 2 / numpy.sqrt(largest_rate(model, model.hessian(model.rest), free))
    damped = largest_rate(model, model.damping_matrix(model.rest), free)
    longest = step_fraction * min(stable, 1 / damped if damped > 0 else numpy.inf)
    x, v = recording.positions[0].copy(), recording.velocities[0].copy()
    held, mass = ~free, model.mass[:, None]
    frames = [x.copy()]
    for t in range(1, len(times)):
        gap = times[t] - times[t - 1]
        n_steps = int(numpy.ceil(gap / longest))
        h = gap / n_steps
        start, end = recording.positions[t - 1], recording.positions[t]
        force, growth = recording.forces[t - 1], (recording.forces[t] - recording.forces[t - 1]) / n_steps
        v[held] = (end - start)[held] / gap
        state = model.spring_state(x)
        elastic = model.elastic_forces(x, state)
        for step in range(1, n_steps + 1):
            half = v + h / 2 * (elastic + model.damping_forces(state[1], v) + force) / mass
            half[held] = v[held]
            x = x + h * half
            x[held] = (start + (end - start) * (step / n_steps))[held]
            force = force + growth
            state = model.spring_state(x)
            elastic = model.elastic_forces(x, state)
            v = half + h / 2 * (elastic + model.damping_forces(state[1], half) + force) / mass
            v[held] = half[held]
        if not numpy.all(numpy.isfinite(x)):
            raise RuntimeError(f"the motion diverges in frame {t}")
        frames.append(x.copy())
    return numpy.array(frames)


def simulated(model, recording, step_fraction=0.5):
    """Positions of the model in the frames of a recording."""
    free = free_nodes(model, recording)
    if len(recording.times) > 1:
        return stepped(model, recording, free, step_fraction)
    start = model.rest.copy()
    start[~free] = recording.positions[0][~free]
    return equilibrium(model, recording.forces[0], start, free)[None]


def squared_distances(model, recording, positions):
    """The two sums of the error."""
    free = free_nodes(model, recording)
    from_reference = numpy.sum((positions - recording.positions)[:, free]**2)
    return numpy.array([from_reference, numpy.sum((recording.positions - recording.rest)[:, free]**2)])


def errors(model, paths, step_fraction=0.5):
    """The error of each file, and that of all together."""
    recordings = [Recording(path) for path in paths]
    sums = [squared_distances(model, r, simulated(model, r, step_fraction)) for r in recordings]
    error = lambda s: float(numpy.sqrt(s[0] / s[1]))
    return [error(s) for s in sums], error(sum(sums))


def read_model(path):
    with open(path) as file:
        return Model(json.load(file))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    by_file, total = errors(read_model(sys.argv[1]), sys.argv[2:])
    for path, error in zip(sys.argv[2:], by_file):
        print(f"{path} {error:.5f}")
    print(f"all {total:.5f}")
