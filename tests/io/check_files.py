# SPDX-License-Identifier: BSD-3-Clause
"""Reads with h5py, numpy and json what write_files.cpp wrote, and compares every value with the closed form."""

import json
import math
import os
import sys
import xml.etree.ElementTree as xml

import h5py
import numpy as np

FRAMES = 5
SPRINGS = [[0, 1], [1, 2], [3, 0]]
SPACE = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]
PLANE = [[0, 0], [1, 0], [0, 1], [1, 1.5]]
BODIES = {
    "triangles": (PLANE, [[0, 1, 2], [1, 3, 2]], "Triangle", 1e-15),
    "triangles_float": (PLANE, [[0, 1, 2], [1, 3, 2]], "Triangle", 3e-7),
    "tetrahedra": (SPACE, [[0, 1, 2, 3], [1, 2, 3, 4]], "Tetrahedron", 1e-15),
    "membrane": (SPACE[:4], [[0, 1, 3, 2]], "Quadrilateral", 1e-15),
}


def expect(found, expected, what, tolerance=0.0):
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, f"{what}: shape {found.shape}, expected {expected.shape}"
    error = np.max(np.abs(found - expected), initial=0.0)
    scale = max(np.max(np.abs(expected), initial=0.0), 1.0)
    assert error <= tolerance * scale, f"{what}: off by {error}"


def analytic(nodes, dimension):
    """time [T] and displacement, velocity, acceleration, force [T x n x Dim] of analytic_motion.hpp"""
    frame = np.arange(FRAMES)[:, None, None]
    node = np.arange(nodes)[None, :, None]
    axis = np.arange(dimension)[None, None, :]
    time = 0.1 * frame + 0.01 * frame**2
    phase = 3 * time + node + 2 * axis
    return time.ravel(), {
        "/reference/displacement": 0.1 * np.sin(phase),
        "/reference/velocity": 0.3 * np.cos(phase),
        "/reference/acceleration": -0.9 * np.sin(phase),
        "/reference/force": frame + 10.0 * node + 100.0 * axis,
        "/fitted/displacement": 0.2 * np.sin(phase),
    }


def check_motion(folder, name):
    points, cells, topology, tolerance = BODIES[name]
    points = np.array(points, dtype=float)
    time, arrays = analytic(*points.shape)
    with h5py.File(os.path.join(folder, name + ".h5"), "r") as file:
        float64, int32 = np.dtype("<f8"), np.dtype("<i4")
        exact = {"/mesh/points": (points, float64), "/mesh/cells": (cells, int32), "/mesh/clamped": ([0, 2], int32),
                 "/springs": (SPRINGS, int32)}
        for dataset, (values, dtype) in exact.items():
            expect(file[dataset][()], values, f"{name}:{dataset}")
            assert file[dataset].dtype == dtype, f"{name}:{dataset} is {file[dataset].dtype}"
        for dataset, values in {"/time": time, **arrays}.items():
            expect(file[dataset][()], values, f"{name}:{dataset}", tolerance)
            assert file[dataset].dtype == float64, f"{name}:{dataset} is {file[dataset].dtype}"
        names = set()
        file.visititems(lambda path, item: names.add("/" + path) if isinstance(item, h5py.Dataset) else None)
        shown = {path for path in names if path.startswith("/frames/")}
        assert names - shown == set(exact) | {"/time"} | set(arrays), f"{name}: holds {names}"
        assert len(shown) == FRAMES * len(arrays)
        assert file.attrs["format"] == "springfit-motion" and file.attrs["version"] == "1"
        assert file.attrs["units"] == "SI" and file.attrs["case"] == "analytic <case> & more"
        assert file["/mesh/cells"].attrs["kind"] == topology.lower()
        check_xdmf(folder, name, file, topology, time, arrays, tolerance)


def check_xdmf(folder, name, file, topology, time, arrays, tolerance):
    """Follows every DataItem of the XDMF file and compares what it finds with what the grid says of it."""
    points = file["/mesh/points"][()]

    def follow(item):
        assert item.tag == "DataItem" and item.get("Format") == "HDF" and item.get("ItemType") is None
        target, dataset = item.text.strip().split(":")
        assert target == os.path.basename(target) == name + ".h5", f"{name}: points to {target}"
        values = file[dataset][()]
        assert list(values.shape) == [int(n) for n in item.get("Dimensions").split()], f"{name}: shape of {dataset}"
        kind = {"Float": np.float64, "Int": np.int32}[item.get("NumberType")]
        assert values.dtype == kind and values.itemsize == int(item.get("Precision"))
        return values

    root = xml.parse(os.path.join(folder, name + ".xdmf")).getroot()
    assert root.tag == "Xdmf" and len(root) == 1 and root[0].tag == "Domain"
    grids = {grid.get("Name"): grid for grid in root[0]}
    assert list(grids) == ["mesh", "springs"]
    followed = 0
    for grid_name, grid in grids.items():
        assert grid.get("GridType") == "Collection" and grid.get("CollectionType") == "Temporal"
        assert len(grid) == FRAMES
        for t, frame in enumerate(grid):
            assert frame.get("GridType") == "Uniform"
            expect(float(frame.find("Time").get("Value")), time[t], f"{name}: time {t}", tolerance)
            found = frame.find("Topology")
            joined = follow(found[0])
            expected, kind = (file["/mesh/cells"], topology) if grid_name == "mesh" else (file["/springs"], "Polyline")
            assert found.get("TopologyType") == kind
            assert int(found.get("NumberOfElements")) == len(joined)
            assert grid_name == "mesh" or found.get("NodesPerElement") == "2"
            expect(joined, expected[()], f"{name}: topology")
            geometry = frame.find("Geometry")
            assert geometry.get("GeometryType") == "XYZ"[: points.shape[1]]
            expect(follow(geometry[0]), points, f"{name}: geometry")
            attributes = frame.findall("Attribute")
            assert {a.get("Name") for a in attributes} == {d[1:].replace("/", "_") for d in arrays}
            for attribute in attributes:
                assert attribute.get("AttributeType") == "Vector" and attribute.get("Center") == "Node"
                dataset = "/" + attribute.get("Name").replace("_", "/", 1)
                values = follow(attribute[0])
                assert values.shape == (len(points), 3)
                expect(values[:, : points.shape[1]], file[dataset][t], f"{name}: frame {t} of {dataset}")
                expect(values[:, points.shape[1] :], 0 * values[:, points.shape[1] :], f"{name}: third component")
                followed += 1
    assert followed == 2 * FRAMES * len(arrays)


def check_model(folder, name):
    points, _, _, tolerance = BODIES[name]
    with open(os.path.join(folder, name + ".json"), encoding="utf-8") as stream:
        model = json.load(stream, parse_constant=lambda word: math.nan / 0)  # NaN and Infinity are not JSON
    real = np.float32 if tolerance > 1e-10 else np.float64

    def numbers(*values):
        return [float(real(real(a) / real(b))) for a, b in values]

    assert list(model) == ["format", "version", "dimension", "units", "damping_law", "nodes", "springs",
                           "stable_time_step", "provenance"]
    assert (model["format"], model["version"], model["units"]) == ("springfit-model", 1, "SI")
    assert (model["dimension"], model["damping_law"]) == (len(points[0]), "axial")
    assert model["nodes"] == {"rest_position": points, "mass": numbers(*[(1, 9)] * len(points)), "fixed": [0, 2]}
    assert model["springs"] == {"nodes": SPRINGS, "stiffness": numbers((1, 3), (0, 1), (1e20, 1)),
                                "rest_length": numbers((1, 1), (0.1, 1), (2, 1)),
                                "damping": numbers((0, 1), (2, 7), (1, 1))}
    assert model["stable_time_step"] == numbers((1, 1234))[0]
    assert model["provenance"] == {"springfit": "0.1.0", "material": {"young": 5e4}}


def main():
    folder = sys.argv[1]
    expected = sorted(name + ending for name in BODIES for ending in (".h5", ".json", ".xdmf"))
    assert sorted(os.listdir(folder)) == expected, f"{folder} holds {os.listdir(folder)}"
    for name in BODIES:
        check_motion(folder, name)
        check_model(folder, name)
    print(f"{len(BODIES)} motions and models read back as written")


if __name__ == "__main__":
    main()
