# SPDX-License-Identifier: BSD-3-Clause
"""The errors that the program reports on another program's recordings are those that a simulation finds which shares no
code with it, and equilibria that the program never saw are met as well as those that it judged by."""

import json
import pathlib
import subprocess
import sys
import tempfile

import simulation

PROGRAM = sys.argv[1]
RECORDINGS = pathlib.Path(__file__).resolve().parent / "calculix"
folder = pathlib.Path(tempfile.mkdtemp(prefix="springfit-"))
MATERIAL = ["--young", "5e4", "--poisson", "0.45", "--density", "1000"]
failures = 0


def check(holds, what):
    global failures
    failures += not holds
    print(f"{'ok' if holds else 'FAILED':6} {what}", flush=True)


def files(names):
    return [RECORDINGS / f"{name}.h5" for name in names]


def fit(out, names, *options):
    """The data of the model that a fit to recordings returns, and the report."""
    paths = files(names)
    arguments = [PROGRAM, "fit", paths[0], *(part for path in paths[1:] for part in ("--reference", path))]
    result = subprocess.run([str(a) for a in [*arguments, *MATERIAL, *options, "--out", out]], capture_output=True,
                            text=True)
    assert result.returncode in (0, 3), (result.returncode, result.stdout, result.stderr)
    report = json.load(open(out / "report.json"))
    split = report["detail"]["reference"]
    assert sorted(split["training_cases"] + split["held_out_cases"]) == sorted(names), split
    return json.load(open(out / "model.json")), report


def agree(reported, found, within):
    return abs(reported - found) <= within * found


def compare(data, report, within):
    """The reported errors beside the simulation's, on the cases that were held out and on those that were fitted to."""
    model = simulation.Model(data)
    split = report["detail"]["reference"]
    by_case = report["detail"]["fits"][report["method"]]["held_out_cases"]
    for part in ("held_out", "training"):
        names = split[part + "_cases"]
        cases, found = simulation.errors(model, files(names))
        reported = report[part]["error"]
        check(agree(reported, found, within), f"{part}: reported {reported:.5f}, simulated {found:.5f}")
        for name, case in zip(names, cases):
            if part == "held_out":
                check(agree(by_case[name], case, within), f"  of this {name}: {by_case[name]:.5f}, {case:.5f}")


def altered(data, **factors):
    """The model with the arrays of its springs and cells of these names times factors."""
    copy = json.loads(json.dumps(data))
    for part in ("springs", "cells"):
        for name, factor in factors.items():
            if name in copy.get(part, {}):
                copy[part][name] = [factor * value for value in copy[part][name]]
    return simulation.Model(copy)


def tells(data, report, within, what, **factors):
    """Another network has another error on what was held out: agreement is not for want of a difference."""
    _, other = simulation.errors(altered(data, **factors), files(report["detail"]["reference"]["held_out_cases"]))
    check(not agree(report["held_out"]["error"], other, within), f"  {what}, it would be {other:.5f}")


# Equilibria. The four that are fitted to load the block along all its axes, two of them a part of it alone; a fifth
# judges, and the sixth is kept from the program altogether. Springs alone, then with cells that hold their volume.
for options in ([], ["--volume", "--second-ring"]):
    data, report = fit(folder / "equilibria", ["static_1", "static_2", "static_3", "static_4", "static_0"], *options)
    assert ("cells" in data) == bool(options)
    compare(data, report, 0.01)
    never_seen = report["detail"]["reference"]["held_out_cases"] + ["static_5"]
    cases, error = simulation.errors(simulation.Model(data), files(never_seen))
    found = ", ".join(f"{name} {case:.5f}" for name, case in zip(never_seen, cases))
    check(error <= 0.04, f"  never fitted to: {found}, together {error:.5f}")
    tells(data, report, 0.5, "were it stiffer by a fifth", stiffness=1.2)

# Motions, each stepped from its first frame: one matched to motion, and a damped one with cells.
data, report = fit(folder / "motions", ["motion_1", "motion_2", "motion_0"], "--fit-seconds", "20")
compare(data, report, 0.02)
check(report["held_out"]["error"] <= 0.04, "  which is at most 0.04")
tells(data, report, 0.5, "were it stiffer by a fifth", stiffness=1.2)
data, report = fit(folder / "damped", ["motion_1", "motion_2", "motion_0"], "--method", "closed-form", "--volume",
                   "--damping", "ratio", "--zeta", "0.2")
assert "cells" in data and max(data["springs"]["damping"]) > 0
compare(data, report, 0.02)
tells(data, report, 0.1, "were it not damped", damping=0)

sys.exit(1 if failures else 0)
