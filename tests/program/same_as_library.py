# SPDX-License-Identifier: BSD-3-Clause
"""The program gives the numbers that a call of calibrate() gives: bit for bit the same model, on a mesh and on a
recorded motion, whatever solver finds the exact fit to what its tolerance allows."""

import json
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy

import bodies

PROGRAM, MESH_EXAMPLE, MOTION_EXAMPLE, HAS_IPOPT = sys.argv[1:5]
folder = pathlib.Path(tempfile.mkdtemp(prefix="springfit-"))
MATERIAL = ["--young", "5e4", "--poisson", "0.3", "--density", "1000"]


def run(*arguments, code=0):
    result = subprocess.run([str(a) for a in arguments], capture_output=True, text=True)
    assert result.returncode == code, (result.returncode, result.stdout, result.stderr)
    return result


def model_in(out):
    """The model without where it is from."""
    model = json.load(open(out / "model.json"))
    return {**model, "provenance": model["provenance"]["method"]}


def box(n, size):
    """Points and tetrahedra of a box of n[0] x n[1] x n[2] cells, six tetrahedra in each."""
    number = lambda x, y, z: x + (n[0] + 1) * (y + (n[1] + 1) * z)
    points = [(x * size / n[0], 2 * y * size / n[1], z * size / n[2])
              for z in range(n[2] + 1) for y in range(n[1] + 1) for x in range(n[0] + 1)]
    tets = []
    for z in range(n[2]):
        for y in range(n[1]):
            for x in range(n[0]):
                c = [number(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) for i in range(8)]
                tets += [(c[0], c[a], c[b], c[7]) for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))]
    return numpy.array(points), numpy.array(tets)


points, tets = box((3, 6, 3), 0.1)
mesh = folder / "box.msh"
bodies.write_gmsh_tets(mesh, points, tets)
for name in ("library", "program"):
    (folder / name).mkdir()
run(MESH_EXAMPLE, mesh, folder / "library")
run(PROGRAM, "fit", mesh, *MATERIAL, "--strain", "0.01", "--deformation", "0.01", "--out", folder / "program")
assert model_in(folder / "library") == model_in(folder / "program")
report = json.load(open(folder / "program" / "report.json"))
assert report["verdict"] in ("good", "fair") and report["detail"]["chosen_by"] == "least_held_out_error"
fits = report["detail"]["fits"]
held_out = set(report["detail"]["reference"]["held_out_cases"])
for name, fit in fits.items():  # every case is there, with its error or why it failed
    scored = set(fit["held_out_cases"]) | set(fit.get("failed_cases", {}))
    assert scored == held_out if not fit.get("failed_cases") else scored <= held_out, name

# The motion that the program shows of its own network, as another program's recording.
recording = folder / "recording.h5"
with h5py.File(folder / "program" / "motion.h5") as file:
    with h5py.File(recording, "w") as copy:
        for name in ("/mesh/points", "/mesh/cells", "/mesh/clamped", "/time", "/reference"):
            if name in file:
                file.copy(name, copy, name)
for name in ("library-motion", "program-motion"):
    (folder / name).mkdir()
run(MOTION_EXAMPLE, recording, folder / "library-motion")
run(PROGRAM, "fit", recording, *MATERIAL, "--out", folder / "program-motion")
assert model_in(folder / "library-motion") == model_in(folder / "program-motion")

# Both exact solvers find the one minimum; the report has the residual of whichever ran.
if HAS_IPOPT == "1":
    models = {}
    for solver in ("native", "ipopt"):
        out = folder / solver
        run(PROGRAM, "fit", recording, *MATERIAL, "--method", "exact", "--exact-solver", solver, "--out", out)
        models[solver] = json.load(open(out / "model.json"))
        exact = json.load(open(out / "report.json"))["detail"]["fits"]["exact"]
        assert exact["status"] == "converged" and 0 <= exact["kkt_residual"] < 1e-8, exact
    stiffness = [numpy.array(models[solver]["springs"]["stiffness"]) for solver in ("native", "ipopt")]
    assert numpy.max(numpy.abs(stiffness[0] - stiffness[1])) <= 1e-6 * numpy.max(stiffness[0])
else:
    refusal = run(PROGRAM, "fit", recording, *MATERIAL, "--exact-solver", "ipopt", "--out", folder / "none", code=2)
    assert "built without Ipopt" in refusal.stderr and not (folder / "none").exists(), refusal.stderr
