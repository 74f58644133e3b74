# SPDX-License-Identifier: BSD-3-Clause
"""Small bodies that the tests of the program write."""

import h5py
import numpy

CUBE_POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
CUBE_FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def write_off(path, points, faces):
    with open(path, "w") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        for point in points:
            file.write(" ".join(str(x) for x in point) + "\n")
        for face in faces:
            file.write(f"{len(face)} " + " ".join(str(i) for i in face) + "\n")


def write_gmsh_tets(path, points, tets):
    with open(path, "w") as file:
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(points))
        for number, point in enumerate(points, 1):
            file.write(f"{number} " + " ".join(str(x) for x in point) + "\n")
        file.write("$EndNodes\n$Elements\n%d\n" % len(tets))
        for number, tet in enumerate(tets, 1):
            file.write(f"{number} 4 2 0 1 " + " ".join(str(i + 1) for i in tet) + "\n")
        file.write("$EndElements\n")


def strip_of_squares(n):
    """Points [m x 2] and triangles of a strip of n unit squares, two high."""
    points = numpy.array([(x, y) for y in range(3) for x in range(n + 1)], dtype=float)
    triangles = []
    for y in range(2):
        for x in range(n):
            a = x + y * (n + 1)
            b, c, d = a + 1, a + n + 2, a + n + 1
            triangles += [(a, b, c), (a, c, d)]
    return points, numpy.array(triangles)


def write_motion(path, points, cells, times, displacement, force=None, leave_out=()):
    """A reference recorded by another program: displacement and force only."""
    with h5py.File(path, "w") as file:
        arrays = {"/mesh/points": points, "/mesh/cells": cells, "/time": times, "/reference/displacement": displacement}
        if force is not None:
            arrays["/reference/force"] = force
        for name, array in arrays.items():
            if name not in leave_out:
                file[name] = array
