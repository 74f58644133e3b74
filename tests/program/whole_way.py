# SPDX-License-Identifier: BSD-3-Clause
"""The program's way from a body to files: what it writes is complete, agrees with itself and can be read by others."""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

import h5py
import numpy

import bodies

PROGRAM = sys.argv[1]
folder = pathlib.Path(tempfile.mkdtemp(prefix="springfit-"))


def run(*arguments, code=0):
    result = subprocess.run([PROGRAM] + [str(a) for a in arguments], capture_output=True, text=True)
    assert result.returncode == code, (result.returncode, result.stdout, result.stderr)
    return result


def fit(*arguments):
    """A fit; the exit code is that of its verdict."""
    result = subprocess.run([PROGRAM, "fit"] + [str(a) for a in arguments], capture_output=True, text=True)
    report = json.load(open(arguments[-1] / "report.json"))
    assert report["verdict"] in ("good", "fair", "poor", "unusable"), report["verdict"]
    usable = report["verdict"] in ("good", "fair")
    assert result.returncode == (0 if usable else 3), (result.returncode, result.stdout, result.stderr)
    assert result.stdout.splitlines()[-1].startswith(f"verdict: {report['verdict']} "), result.stdout
    return result


def check_model(model, nodes, springs, dimension):
    assert (model["format"], model["version"], model["units"]) == ("springfit-model", 1, "SI")
    assert model["dimension"] == dimension and model["damping_law"] == "axial"
    assert numpy.array(model["nodes"]["rest_position"]).shape == (nodes, dimension)
    assert numpy.all(numpy.array(model["nodes"]["mass"]) > 0) and len(model["nodes"]["mass"]) == nodes
    assert numpy.array(model["springs"]["nodes"]).shape == (springs, 2)
    for name in ("stiffness", "rest_length", "damping"):
        values = numpy.array(model["springs"][name])
        assert values.shape == (springs,) and numpy.all(values >= 0) and numpy.all(numpy.isfinite(values)), name
    assert model["stable_time_step"] > 0 and "springfit" in model["provenance"]


def check_motion(out, nodes, springs, dimension, fitted_only=False):
    with h5py.File(out / "motion.h5") as file:
        frames = file["/time"].shape[0]
        assert file["/mesh/points"].shape == (nodes, dimension) and file["/mesh/points"].dtype == numpy.float64
        assert file["/springs"].shape == (springs, 2)
        names = ["/fitted/displacement"]
        if not fitted_only:
            names += [f"/reference/{name}" for name in ("displacement", "velocity", "force")]
        for name in names:
            assert file[name].shape == (frames, nodes, dimension), name
            assert numpy.all(numpy.isfinite(file[name][:])), name
    root = xml.etree.ElementTree.parse(out / "motion.xdmf").getroot()
    assert len(list(root.iter("Time"))) >= frames
    return frames


# A cube of soft rubber, by FEM.
bodies.write_off(folder / "cube.off", bodies.CUBE_POINTS, bodies.CUBE_FACES)
out = folder / "cube"
fit(folder / "cube.off", "--young", 1e4, "--poisson", 0.3, "--density", 1000, "--nodes", 60, "--training-cases",
    2, "--held-out-cases", 2, "--frames", 12, "--seed", 3, "--out", out)
assert sorted(p.name for p in out.iterdir()) == ["model.json", "motion.h5", "motion.xdmf", "report.json"]
model = json.load(open(out / "model.json"))
report = json.load(open(out / "report.json"))
check_model(model, report["nodes"], report["springs"], 3)
check_motion(out, report["nodes"], report["springs"], 3)
assert abs(sum(model["nodes"]["mass"]) - 1000) < 1e-6
baselines = report["held_out"]["baselines"]
assert {"van_gelder", "dominant_term", "exact"} <= set(baselines)
assert report["held_out"]["error"] <= 1.2 * min(baselines.values())  # of near equals the one with fewer springs
failures = [fit.get("failed_cases", {}) for fit in report["detail"]["fits"].values()]
assert all(set(f) <= set(report["detail"]["reference"]["held_out_cases"]) for f in failures), failures
far_off = [w for w in report["warnings"] if "moves unlike the reference" in w]
assert len(far_off) == (report["held_out"]["error"] >= 0.25), report["warnings"]
assert report["method"] in baselines and set(report["training"]["baselines"]) == set(baselines)
assert report["detail"]["seed"] == 3

# The same seed gives the same model, on any number of threads.
again = folder / "again"
fit(folder / "cube.off", "--young", 1e4, "--poisson", 0.3, "--density", 1000, "--nodes", 60, "--training-cases",
    2, "--held-out-cases", 2, "--frames", 12, "--seed", 3, "--threads", 1, "--out", again)
assert json.load(open(again / "model.json")) == model

# One method alone is returned even where another would be better.
fit(folder / "cube.off", "--young", 1e4, "--poisson", 0.3, "--density", 1000, "--nodes", 60, "--training-cases",
    1, "--held-out-cases", 1, "--frames", 8, "--method", "dominant-term", "--out", again)
assert json.load(open(again / "report.json"))["method"].startswith("dominant_term")

# What a run with a finer reference left in the folder does not stay beside the files of one without.
for name in ("surface.h5", "surface.xdmf"):
    (again / name).write_text("of another network")
fit(folder / "cube.off", "--young", 1e4, "--poisson", 0.3, "--density", 1000, "--nodes", 60, "--training-cases",
    1, "--held-out-cases", 1, "--frames", 8, "--method", "closed-form", "--out", again)
assert sorted(p.name for p in again.iterdir()) == ["model.json", "motion.h5", "motion.xdmf", "report.json"]

# The fitted model, stepped.
for integrator in ("explicit", "implicit"):
    stepped = folder / integrator
    run("simulate", out / "model.json", "--duration", 0.2, "--frames", 11, "--integrator", integrator, "--gravity=0,0,-1",
        "--out", stepped)
    assert check_motion(stepped, report["nodes"], report["springs"], 3, fitted_only=True) == 11

# A network that is coarser than its reference: masses are handed over, and the fine surface is carried.
def check_surface(out, model, fitted_only=False):
    """surface.h5 agrees with motion.h5 by the weights of model.json."""
    surface, dimension = model["surface"], model["dimension"]
    with h5py.File(out / "motion.h5") as file:
        moved = file["/fitted/displacement"][:]
        times = file["/time"][:]
    points = numpy.array(surface["rest_position"])
    assert points.shape == (len(surface["nodes"]), dimension) and len(surface["weights"]) == len(points)
    with h5py.File(out / "surface.h5") as file:
        assert numpy.array_equal(file["/mesh/points"][:], points) and numpy.array_equal(file["/time"][:], times)
        cells = file["/mesh/cells" if dimension == 3 else "/springs"][:]
        assert numpy.array_equal(cells, numpy.array(surface["cells"])) and cells.shape[1] == dimension
        carried = file["/fitted/displacement"][:]
        reference = None if fitted_only else file["/reference/displacement"][:]
    assert len(list(xml.etree.ElementTree.parse(out / "surface.xdmf").getroot().iter("Time"))) >= len(times)
    for p, (nodes, weights) in enumerate(zip(surface["nodes"], surface["weights"])):
        assert abs(sum(weights) - 1) < 1e-12
        expected = numpy.einsum("w,twd->td", numpy.array(weights), moved[:, nodes])
        assert numpy.max(numpy.abs(carried[:, p] - expected)) <= 1e-12 * numpy.max(numpy.abs(moved)), p
    edges = {tuple(sorted((c[a], c[b]))) for c in cells.tolist() for a in range(dimension) for b in range(a)}
    if dimension == 3:
        assert len(points) - len(edges) + len(cells) == 2  # a closed surface without handles
    else:
        assert len(points) == len(cells)  # one closed outline
    return carried, reference


(folder / "sheet.wkt").write_text("POLYGON((0 0, 3 0, 3 1, 0 1, 0 0))\n")
for name, dimension, total, nodes in (("cube.off", 3, 1000, 40), ("sheet.wkt", 2, 3000, 40)):
    out = folder / ("coarse-" + name)
    fit(folder / name, "--young", 1e4, "--poisson", 0.3, "--density", 1000, "--nodes", nodes,
        "--reference-nodes", 6 * nodes, "--training-cases", 1, "--held-out-cases", 1, "--static-cases", 6, "--strain", 0.02,
        "--frames", 10, "--clamp", "x-min:0.1", "--method", "trajectory", "--out", out)
    assert sorted(p.name for p in out.iterdir()) == ["model.json", "motion.h5", "motion.xdmf", "report.json",
                                                     "surface.h5", "surface.xdmf"]
    model = json.load(open(out / "model.json"))
    report = json.load(open(out / "report.json"))
    check_model(model, report["nodes"], report["springs"], dimension)
    check_motion(out, report["nodes"], report["springs"], dimension)
    assert abs(sum(model["nodes"]["mass"]) / total - 1) < 1e-9
    at_fine = report["detail"]["reference_nodes"]
    assert report["nodes"] < 2 * nodes < 4 * nodes < at_fine["nodes"]
    assert 0 < at_fine["error_of_carrying"] < at_fine["error"] < 1, at_fine
    assert set(at_fine["cases"]) == set(report["detail"]["reference"]["held_out_cases"])
    carried, reference = check_surface(out, model)
    assert numpy.linalg.norm(carried - reference) < numpy.linalg.norm(reference)
    stepped = folder / ("coarse-stepped-" + name)
    run("simulate", out / "model.json", "--duration", 0.05, "--frames", 4, "--out", stepped)
    check_surface(stepped, model, fitted_only=True)

# A motion that another program recorded, of a spring network: its springs are found again.
points, triangles = bodies.strip_of_squares(6)
edges = sorted({tuple(sorted((t[a], t[(a + 1) % 3]))) for t in triangles for a in range(3)})
edges = numpy.array(edges)
random = numpy.random.default_rng(5)
stiffness = 100 * 10 ** random.random(len(edges))
damping = 0.2 * random.random(len(edges))
mass = numpy.zeros(len(points))
for t in triangles:
    mass[t] += 10 * 0.5 / 3
rest = numpy.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1)
held = points[:, 0] == 0
gravity = numpy.array([0.3, -1.0])


def acceleration(x, v):
    r = x[edges[:, 1]] - x[edges[:, 0]]
    length = numpy.linalg.norm(r, axis=1)
    n = r / length[:, None]
    rate = numpy.sum((v[edges[:, 1]] - v[edges[:, 0]]) * n, axis=1)
    f = (stiffness * (length - rest) + damping * rate)[:, None] * n
    total = mass[:, None] * gravity
    numpy.add.at(total, edges[:, 0], f)
    numpy.add.at(total, edges[:, 1], -f)
    a = total / mass[:, None]
    a[held] = 0
    return a


frames, substeps, dt = 60, 40, 0.02
x, v = points + 0.1 * random.standard_normal(points.shape), numpy.zeros(points.shape)
x[held] = points[held]
record = {"displacement": [], "velocity": [], "acceleration": [], "force": []}
for frame in range(frames):
    record["displacement"].append(x - points)
    record["velocity"].append(v)
    record["acceleration"].append(acceleration(x, v))
    record["force"].append(mass[:, None] * gravity)
    h = dt / substeps
    for _ in range(substeps):  # velocity Verlet with damping at the half step's velocity
        half = v + h / 2 * acceleration(x, v)
        x = x + h * half
        v = half + h / 2 * acceleration(x, half)
with h5py.File(folder / "strip.h5", "w") as file:
    file["/mesh/points"], file["/mesh/cells"], file["/time"] = points, triangles, dt * numpy.arange(frames)
    for name, values in record.items():
        file[f"/reference/{name}"] = numpy.array(values)
# The same in millimetres and milliseconds, with masses of its own and a marker that is lost for a while.
with h5py.File(folder / "lost_strip.h5", "w") as file:
    file["/mesh/points"], file["/mesh/cells"], file["/mesh/mass"] = 1e3 * points, triangles, mass
    file["/time"] = 1e3 * dt * numpy.arange(frames)
    for name, scale in (("displacement", 1e3), ("velocity", 1), ("acceleration", 1e-3), ("force", 1)):
        values = scale * numpy.array(record[name])
        if name == "displacement":
            values[10:14, -1] = numpy.nan
        file[f"/reference/{name}"] = values
OTHER_UNITS = ["--unit", "mm", "--time-unit", "ms", "--mass-from", folder / "lost_strip.h5"]
for method, name, recording, density, units in (
        ("exact", "exact", "strip.h5", 10, []), ("dominant-term", "dominant_term", "strip.h5", 10, []),
        ("exact", "exact", "lost_*.h5", 99, OTHER_UNITS)):
    out = folder / (method + recording[:4])
    fit(folder / recording, "--young", 1e3, "--poisson", 0.3, "--density", density, "--damping", "fitted", "--method",
        method, *units, "--out", out)
    model = json.load(open(out / "model.json"))
    report = json.load(open(out / "report.json"))
    check_model(model, len(points), len(edges), 2)
    found = {tuple(sorted(ends)): values for *values, ends in
             zip(model["springs"]["stiffness"], model["springs"]["damping"], model["springs"]["nodes"])}
    # A spring between two held nodes moves nothing: no motion can tell its stiffness.
    free = [e for e, (i, j) in enumerate(edges) if not (held[i] and held[j])]
    k = numpy.array([found[tuple(edges[e])] for e in free])
    assert numpy.max(numpy.abs(k[:, 0] / stiffness[free] - 1)) < 1e-6, method
    assert numpy.max(numpy.abs(k[:, 1] - damping[free])) < 1e-6 * numpy.max(damping), method
    assert report["method"] == name and report["held_out"]["error"] < 1e-2, report["held_out"]
    assert (out / "report.json").read_text().startswith('{\n  "verdict": "good"'), method
    lost = [w for w in report["detail"]["warnings"] if w["code"] == "unobserved"]
    assert [w["values"]["positions"] for w in lost] == ([4] if units else []), lost

# Ctrl-C: the best result so far, complete, or nothing at all.
out = folder / "interrupted"
process = subprocess.Popen([PROGRAM, "fit", folder / "cube.off", "--young", "1e4", "--poisson", "0.45", "--density", "1000",
                            "--nodes", "300", "--training-cases", "40", "--frames", "60", "--out", out],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
time.sleep(4)
process.send_signal(signal.SIGINT)
assert process.wait(timeout=120) == 130
if out.exists():
    assert sorted(p.name for p in out.iterdir()) == ["model.json", "motion.h5", "motion.xdmf", "report.json"]
    report = json.load(open(out / "report.json"))
    assert report["status"] == "interrupted"
    check_model(json.load(open(out / "model.json")), report["nodes"], report["springs"], 3)
print("ok")
