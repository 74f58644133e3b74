# SPDX-License-Identifier: BSD-3-Clause
"""Every wrong input: exit code 2, one error line that names the thing, and no file left behind."""

import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy

import bodies

PROGRAM = sys.argv[1]
MATERIAL = ["--young", "1e4", "--poisson", "0.3", "--density", "1000"]
QUICK = ["--nodes", "40", "--training-cases", "1", "--held-out-cases", "1", "--frames", "6"]

folder = pathlib.Path(tempfile.mkdtemp(prefix="springfit-"))
failures = 0


def file_size_limit():
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, 2048))


def memory_limit():
    resource.setrlimit(resource.RLIMIT_AS, (600 << 20, 600 << 20))


def refused(what, arguments, words, out=None, limit=None):
    """Runs the program and checks that it refuses with all of `words` in its one error line."""
    global failures
    out = folder / "out" / what.replace(" ", "-") if out is None else out
    before = {p for p in folder.rglob("*") if p.is_file()}
    result = subprocess.run([PROGRAM] + [str(a) for a in arguments] + ["--out", str(out)], capture_output=True,
                            text=True, preexec_fn=limit, timeout=120)
    errors = [line for line in result.stderr.splitlines() if line.startswith("springfit: ")]
    left = {p for p in folder.rglob("*") if p.is_file()} - before
    problems = []
    if result.returncode != 2:
        problems.append(f"exit code {result.returncode}")
    if len(errors) != 1:
        problems.append(f"{len(errors)} error lines")
    problems += [f"'{word}' is not in the error" for word in words if not errors or word not in errors[0]]
    if left:
        problems.append(f"left behind: {sorted(str(p) for p in left)}")
    print(f"{'FAILED' if problems else 'ok':6} {what}: {errors[0] if errors else result.stderr[-300:]}")
    for problem in problems:
        print("       ", problem)
    failures += bool(problems)


cube = folder / "cube.off"
bodies.write_off(cube, bodies.CUBE_POINTS, bodies.CUBE_FACES)

# Files
refused("missing file", ["fit", folder / "none.off", *MATERIAL], ["none.off"])
(folder / "picture.png").write_text("x")
refused("unknown kind of file", ["fit", folder / "picture.png", *MATERIAL], ["picture.png", ".off"])
(folder / "empty.off").write_text("")
refused("empty file", ["fit", folder / "empty.off", *MATERIAL], ["empty.off"])
bodies.write_off(folder / "no-faces.off", [], [])
refused("empty surface", ["fit", folder / "no-faces.off", *MATERIAL], ["no-faces.off"])
bodies.write_off(folder / "open.off", bodies.CUBE_POINTS, bodies.CUBE_FACES[:-1])
refused("open surface", ["fit", folder / "open.off", *MATERIAL], ["open.off", "4 boundary edges", "1 hole"])
bodies.write_off(folder / "sheet.off", bodies.CUBE_POINTS, bodies.CUBE_FACES[:1])
refused("sheet", ["fit", folder / "sheet.off", *MATERIAL], ["sheet.off", "membrane", "a volume is needed"])
bodies.write_off(folder / "crossed.off", bodies.CUBE_POINTS, [(2, 7, 6, 0, 4)])
refused("face that crosses itself", ["fit", folder / "crossed.off", *MATERIAL], ["crossed.off", "face 1"])
shifted = [(x + 0.5, y + 0.5, z + 0.5) for x, y, z in bodies.CUBE_POINTS]
crossing = bodies.CUBE_FACES + [tuple(i + 8 for i in face) for face in bodies.CUBE_FACES]
bodies.write_off(folder / "crossing.off", bodies.CUBE_POINTS + shifted, crossing)
refused("self-intersecting surface", ["fit", folder / "crossing.off", *MATERIAL], ["crossing.off", "intersect"])
bodies.write_off(folder / "nan.off", [("nan", 0, 0)] + bodies.CUBE_POINTS[1:], bodies.CUBE_FACES)
refused("NaN vertex", ["fit", folder / "nan.off", *MATERIAL], ["nan.off"])
bodies.write_gmsh_tets(folder / "inverted.msh", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)],
                       [(0, 1, 2, 3), (1, 3, 2, 4)])
refused("inverted element", ["fit", folder / "inverted.msh", *MATERIAL], ["cell 1"])
broken = {"format": "springfit-model", "version": 1, "dimension": 2, "units": "SI", "damping_law": "axial",
          "nodes": {"rest_position": [[0, 0], [1, 0]], "mass": [1, 1], "fixed": [0]},
          "springs": {"nodes": [[0, 1]], "stiffness": [1], "rest_length": [1], "damping": [0]},
          "surface": {"rest_position": [[0, 1], [1, 1]], "cells": [[0, 1]], "nodes": [[0], [2]], "weights": [[1], [1]]},
          "stable_time_step": 0.1, "provenance": {}}
(folder / "surface.json").write_text(json.dumps(broken))
refused("surface that names no node", ["simulate", folder / "surface.json"], ["surface.json", "/surface/nodes/1/0"])
del broken["surface"]
small = json.dumps(broken)
(folder / "small.json").write_text(small)
(folder / "no-nodes.json").write_text(small.replace("[[0, 0], [1, 0]]", "[]").replace("[1, 1]", "[]"))
refused("model without nodes", ["simulate", folder / "no-nodes.json"], ["no-nodes.json", "/nodes/rest_position"])
(folder / "far.json").write_text(small.replace('"nodes": [[0, 1]]', '"nodes": [[0, 2]]'))
refused("spring to a node that is not there", ["simulate", folder / "far.json"], ["far.json", "/springs/nodes/0/1", "2"])
(folder / "deep.json").write_text(small.replace('"provenance": {}', f'"provenance": {"[" * 1000000}{"]" * 1000000}'))
refused("model nested deep", ["simulate", folder / "deep.json"], ["deep.json:1", "100 deep"])
(folder / "lines.json").write_text(small.replace("SI", "S\\nI"))
refused("text of two lines in a model", ["simulate", folder / "lines.json"], ["lines.json", "/units"])
refused("output folder without a name", ["simulate", folder / "small.json"], ["--out"], out="")
refused("output folder without a name for a fit", ["fit", cube, *MATERIAL], ["--out"], out="")
refused("more frames than memory", ["simulate", folder / "small.json", "--frames", "2000000000"], ["--frames", "GB"])
refused("frames that run out of memory", ["simulate", folder / "small.json", "--frames", "8000000"],
        ["not enough memory", "small.json", "--frames 8000000"], limit=memory_limit)
refused("steps without end", ["simulate", folder / "small.json", "--duration", "1e30"], ["--duration", "--frames"])
refused("a time step of almost 0", ["simulate", folder / "small.json", "--time-step", "1e-300"], ["--time-step"])
refused("missing model", ["simulate", folder / "none.json"], ["none.json"])
(folder / "broken.json").write_text('{"format": "springfit-model", "version": 1, "dimension": 3')
refused("broken model", ["simulate", folder / "broken.json"], ["broken.json"])

# Values
def material(**changed):
    values = {"young": "1e4", "poisson": "0.3", "density": "1000"} | changed
    return [part for name, value in values.items() for part in (f"--{name}={value}",)]


refused("nu of 0.5", ["fit", cube, *material(poisson="0.5")], ["poisson", "(-1, 0.5)", "0.5"])
refused("nu that is NaN", ["fit", cube, *material(poisson="nan")], ["poisson", "nan"])
refused("negative density", ["fit", cube, *material(density="-1")], ["density", "-1"])
refused("Young's modulus of 0", ["fit", cube, *material(young="0")], ["young", "0"])
refused("unknown method", ["fit", cube, *MATERIAL, "--method", "magic"], ["--method", "magic"])
refused("unknown material", ["fit", cube, *MATERIAL, "--material", "cheese"], ["--material", "cheese"])
refused("unknown option", ["fit", cube, *MATERIAL, "--colour", "red"], ["--colour"])
refused("missing option", ["fit", cube, "--young", "1e4", "--poisson", "0.3"], ["--density"])
refused("element of other cells", ["fit", cube, *MATERIAL, *QUICK, "--element", "quad4"], ["--element", "quad4"])
refused("unknown clamp", ["fit", cube, *MATERIAL, *QUICK, "--clamp", "left"], ["--clamp", "left"])
refused("cells without number", ["fit", cube, *MATERIAL, "--cell-size", "1e-9"], ["cell_size", "20000000 nodes"])
refused("nodes without number", ["fit", cube, *MATERIAL, "--nodes", "2147483647"], ["n_nodes", "20000000"])
refused("two sizes", ["fit", cube, *MATERIAL, "--nodes", "40", "--cell-size", "0.3"], ["--nodes", "--cell-size"])
refused("reference no finer than the network", ["fit", cube, *MATERIAL, "--nodes", "40", "--reference-nodes", "40"],
        ["--reference-nodes", "more than the 40"])
refused("reference coarser than the nodes by default", ["fit", cube, *MATERIAL, "--reference-nodes", "900"],
        ["--reference-nodes", "more than the 1000"])
refused("reference coarser than the cells", ["fit", cube, *MATERIAL, "--cell-size", "0.4", "--reference-nodes", "5"],
        ["--reference-nodes", "nodes of the network", "5"])
bodies.write_gmsh_tets(folder / "one.msh", [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)])
refused("finer reference for a mesh", ["fit", folder / "one.msh", *MATERIAL, "--reference-nodes", "2000"],
        ["--reference-nodes", "a surface or an outline", "one.msh"])
bodies.write_off(folder / "diamond.off", [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)],
                 [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
refused("clamp that does not hold the network",
        ["fit", folder / "diamond.off", *MATERIAL, "--nodes", "40", "--reference-nodes", "300"],
        ["--clamp", "hold the network", "too few"])
refused("thickness of a solid", ["fit", cube, *MATERIAL, *QUICK, "--thickness", "0.1"], ["--thickness"])

# Output
(folder / "file").write_text("x")
refused("output folder that is a file", ["fit", cube, *MATERIAL], ["file"], out=folder / "file")
refused("unwritable output folder", ["fit", cube, *MATERIAL], ["/proc/springfit"], out=pathlib.Path("/proc/springfit"))
refused("full disk", ["fit", cube, *MATERIAL, *QUICK], ["motion.h5"], limit=file_size_limit)

# Recorded references
points, triangles = bodies.strip_of_squares(4)
times = numpy.linspace(0, 1, 12)
shape = (len(times), *points.shape)
displacement = numpy.zeros(shape)
displacement[:, :, 1] = 0.01 * numpy.outer(numpy.sin(times), points[:, 0])
bodies.write_motion(folder / "strip.h5", points, triangles, times, displacement)
bodies.write_motion(folder / "slow.h5", points, triangles, 1e9 * times, displacement)
other_points, other_triangles = bodies.strip_of_squares(5)
other = numpy.zeros((len(times), *other_points.shape))
bodies.write_motion(folder / "other.h5", other_points, other_triangles, times, other)
refused("reference with other node count",
        ["fit", folder / "strip.h5", *MATERIAL, "--reference", folder / "other.h5"], ["15 nodes", "18"])
bodies.write_motion(folder / "no-displacement.h5", points, triangles, times, displacement,
                    leave_out=["/reference/displacement"])
refused("missing column", ["fit", folder / "no-displacement.h5", *MATERIAL], ["/reference/displacement"])
displacement[3, 2, 1] = numpy.inf
bodies.write_motion(folder / "inf.h5", points, triangles, times, displacement)
refused("infinity in a motion", ["fit", folder / "inf.h5", *MATERIAL], ["inf.h5", "/reference/displacement"])
with h5py.File(folder / "strip.h5") as good, h5py.File(folder / "huge.h5", "w") as file:
    good.copy("/time", file)
    good.copy("/reference", file)
    file.create_dataset("/mesh/points", (500000000, 2))
refused("size without numbers", ["fit", folder / "huge.h5", *MATERIAL], ["huge.h5", "/mesh/points", "0 bytes"])
with h5py.File(folder / "strip.h5") as good, h5py.File(folder / "linked.h5", "w") as file:
    good.copy("/mesh", file)
    good.copy("/time", file)
    file["/reference/displacement"] = h5py.ExternalLink(str(folder / "strip.h5"), "/reference/displacement")
refused("link to a file elsewhere", ["fit", folder / "linked.h5", *MATERIAL],
        ["linked.h5", "/reference/displacement", "same folder"])
(folder / "angles.xdmf").write_text("<Xdmf>" + "<" * 300000)
refused("XDMF of nothing but angles", ["fit", folder / "angles.xdmf", *MATERIAL], ["angles.xdmf", "no HDF5 file"])
(folder / "up.xdmf").write_text("<Xdmf><DataItem>../strip.h5:/mesh/points</DataItem></Xdmf>")
refused("XDMF that leads elsewhere", ["fit", folder / "up.xdmf", *MATERIAL], ["up.xdmf", "../strip.h5"])
# HDF5 1.10 crashes on a text that is longer than the heap it is in.
with h5py.File(folder / "inf.h5", "r+") as file:
    file.attrs["case"] = "a text in the global heap"
damaged = bytearray((folder / "inf.h5").read_bytes())
heap = damaged.index(b"GCOL")
damaged[heap + 24:heap + 32] = b"\xff\xff\xff\x7f\x00\x00\x00\x00"
(folder / "damaged.h5").write_bytes(damaged)
refused("damaged HDF5", ["fit", folder / "damaged.h5", *MATERIAL], ["damaged.h5"])
refused("pattern that no file matches", ["fit", folder / "none_*.h5", *MATERIAL], ["none_*.h5", "no such file"])
refused("masses of the FEM reference", ["fit", cube, *MATERIAL, "--mass-from", folder / "broken.json"], ["--mass-from"])
(folder / "mass.json").write_text('{"nodes": {"mass": [1, 2]}}')
refused("masses of other nodes", ["fit", folder / "strip.h5", *MATERIAL, "--mass-from", folder / "mass.json"],
        ["mass.json", "/nodes/mass", "found 2"])
(folder / "mass.json").write_text("[1, 2]")
refused("no masses", ["fit", folder / "strip.h5", *MATERIAL, "--mass-from", folder / "mass.json"],
        ["mass.json", "/nodes/mass"])
refused("masses that are not there", ["fit", folder / "strip.h5", *MATERIAL, "--mass-from", folder / "other.h5"],
        ["other.h5", "/mesh/mass"])
refused("frames that are many periods apart", ["fit", folder / "slow.h5", *MATERIAL], ["slow", "--time-unit ms"])
refused("mesh after a motion", ["fit", folder / "strip.h5", cube, *MATERIAL], ["INPUT", "recorded motions"])
refused("meshing option for a motion", ["fit", folder / "strip.h5", *MATERIAL, "--nodes", "100"], ["--nodes"])
refused("finer reference for a motion", ["fit", folder / "strip.h5", *MATERIAL, "--reference-nodes", "2000"],
        ["--reference-nodes", "recorded motion"])
refused("finer reference beside a recorded one",
        ["fit", cube, *MATERIAL, "--reference", folder / "strip.h5", "--nodes", "40", "--reference-nodes", "200"],
        ["--reference-nodes", "recorded motion"])
refused("FEM option for a motion", ["fit", folder / "strip.h5", *MATERIAL, "--element", "tri6"], ["--element"])

# Simulations that are whole, however stiff the model is, and what a signal leaves of one
def simulated(what, arguments, exit_code, frames, signal_number=None):
    """Runs a simulation, after a second sends it a signal, and checks exit code and frames."""
    global failures
    out = folder / "out" / what.replace(" ", "-")
    process = subprocess.Popen([PROGRAM, "simulate", str(folder / "stiff.json"), *arguments, "--out", str(out)],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if signal_number is not None:
        time.sleep(1)
        process.send_signal(signal_number)
    process.wait(timeout=120)
    with h5py.File(out / "motion.h5") as file:
        n_frames = len(file["/time"])
    is_good = process.returncode == exit_code and n_frames in frames
    print(f"{'ok' if is_good else 'FAILED':6} {what}: exit code {process.returncode}, {n_frames} frames")
    failures += not is_good


stiff = broken | {"nodes": broken["nodes"] | {"mass": [1e-3, 1e-3]},
                  "springs": broken["springs"] | {"stiffness": [1e7]}}
(folder / "stiff.json").write_text(json.dumps(stiff))
simulated("more than a million steps in a frame", ["--duration", "20", "--frames", "4"], 0, [4])
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    simulated(f"a simulation that {number.name} ends", ["--duration", "1e7", "--frames", "1000000"], 130,
              range(1, 1000000), number)

sys.exit(1 if failures else 0)
