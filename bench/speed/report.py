#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the speed benchmarks and writes docs/performance.md with its figures. Standard library only.

    python3 bench/speed/report.py build-bench/bin/bench_* [--out docs] [--repetitions 2] [--min-time 0.1]

Of the repetitions of a benchmark the fastest counts. A ratio is always of two benchmarks of one program, which ran in
one process. What a program does not measure, or could not, is left out.
"""
import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile

NAMES = {
    "plain_loop": "plain loop",
    "explicit_step": "springfit, explicit step",
    "plain_loop_volume": "plain loop, with volume cells",
    "explicit_step_volume": "springfit, explicit step, with volume cells",
    "batch_step_volume": "springfit, 64 bodies with volume cells",
    "plain_loop_random_order": "plain loop, nodes and springs in random order",
    "explicit_step_random_order": "springfit, explicit step, random order",
    "explicit_step_two_threads": "springfit, explicit step, two threads",
    "batch_step": "springfit, explicit step of 64 bodies",
    "implicit_step": "springfit, implicit step",
    "implicit_step_tight": "springfit, implicit step, further solved",
    "projective_step": "springfit, projective step",
    "plain_implicit_step": "plain linear implicit step",
    "bullet_world_step": "Bullet soft body, world step",
    "bullet_deformable_elastic_force": "Bullet deformable, elastic force alone",
    "bullet_deformable_explicit_step": "Bullet deformable, explicit world step",
    "bullet_deformable_implicit_step": "Bullet deformable, implicit world step",
    "mujoco_step": "MuJoCo, step",
    "plain_exact": "plain projected Gauss-Seidel",
    "exact": "springfit, exact",
    "exact_poor": "springfit, exact, poorly excited",
    "streamed_fit": "springfit, assembly and exact, frames streamed",
    "supernodal_factor": "factor of the stiffness, CHOLMOD",
    "supernodal_solves": "solves for 16 cases, with CHOLMOD's factor",
    "simplicial_factor": "factor of the stiffness, Eigen",
    "simplicial_solves": "solves for 16 cases, with Eigen's factor",
    "match": "springfit, three iterations of matching 16 static cases",
    "ipopt": "Ipopt",
    "ipopt_poor": "Ipopt, poorly excited",
    "tao_bnls": "PETSc/TAO, bnls",
    "tao_bntr": "PETSc/TAO, bntr",
    "tao_gpcg": "PETSc/TAO, gpcg",
    "scipy_lbfgsb": "SciPy, L-BFGS-B",
}
COLOURS = ["#1b6ca8", "#d1495b", "#2e933c", "#edae49", "#6b4c9a", "#00798c", "#8d5b4c", "#4f4f4f"]


class Row:
    """One benchmark: name `<what>/<dim>d/<scalar>/<springs>`, its counters from the fastest repetition."""

    def __init__(self, what, dim, scalar, springs, counters):
        self.what, self.dim, self.scalar, self.springs = what, dim, scalar, springs
        self.counters = counters
        self.ns = counters["ns_per_spring"]

    @property
    def kind(self):
        return self.what, self.dim, self.scalar

    @property
    def name(self):
        what, _, factor = re.fullmatch(r"(.*?)(_(\d+))?", self.what).groups()
        return NAMES.get(what, what.replace("_", " ")) + (f" of {factor} stable steps" if factor else "")


class Run:
    """The output of one program."""

    def __init__(self, program, output):
        self.program = program
        self.context = output.get("context", {})
        self.fastest = {}  # full name: counters
        for entry in output.get("benchmarks", []):
            if entry.get("run_type", "iteration") != "iteration" or entry.get("error_occurred"):
                continue
            by_the_wall = re.search("manual_time|real_time", entry["name"])
            time = entry["real_time" if by_the_wall else "cpu_time"]
            name = re.sub(r"/(iterations:\d+|manual_time|real_time)", "", entry.get("run_name", entry["name"]))
            kept = self.fastest.get(name)
            if kept is None or time < kept["time"]:
                self.fastest[name] = {**entry, "time": time}
        self.rows = []
        for name, counters in self.fastest.items():
            parts = re.fullmatch(r"(\w+)/(\d)d/(\w+)/(\d+)", name)
            if parts and "ns_per_spring" in counters:
                self.rows.append(Row(parts[1], int(parts[2]), parts[3], int(parts[4]), counters))

    def find(self, what, row):
        """The benchmark `what` of the same dimension, scalar and size, or None."""
        for other in self.rows:
            if other.kind == (what, row.dim, row.scalar) and other.springs == row.springs:
                return other
        return None


def run(program, options):
    """Runs one program; its tables are read from a file, since libraries print what they like."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [
            program,
            "--benchmark_out=" + file.name,
            "--benchmark_out_format=json",
            f"--benchmark_repetitions={options.repetitions}",
            f"--benchmark_min_time={options.min_time}",
            f"--benchmark_filter={options.filter}",
        ]
        print(" ".join(command), file=sys.stderr)
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        try:
            status = subprocess.run(command, stdout=subprocess.DEVNULL, env=environment, check=False).returncode
        except OSError as error:
            status = error.strerror
        if status != 0:
            print(f"{program} ended with {status}; left out", file=sys.stderr)
            return None
        try:
            with open(file.name, encoding="utf-8") as text:
                return Run(os.path.basename(program), json.load(text))
        except json.JSONDecodeError:
            print(f"{program} measured nothing", file=sys.stderr)
            return None


def digits(value):
    """Two significant digits, three above 100."""
    if value >= 100:
        return f"{value:.0f}"
    return f"{value:.{max(0, 1 - math.floor(math.log10(value)))}f}" if value > 0 else "0"


def power(springs):
    return f"1e{round(math.log10(springs))}" if math.log10(springs).is_integer() else str(springs)


def table(rows, cell):
    """One line per kind, one column per size; `cell(row)` is its text."""
    sizes = sorted({row.springs for row in rows})
    kinds = list(dict.fromkeys(row.kind for row in rows))
    lines = ["| | " + " | ".join(power(s) for s in sizes) + " |", "|---|" + "---|" * len(sizes)]
    for kind in kinds:
        own = {row.springs: row for row in rows if row.kind == kind}
        name = f"{next(iter(own.values())).name}, {kind[2]}"
        lines.append(f"| {name} | " + " | ".join(cell(own[s]) if s in own else "-" for s in sizes) + " |")
    return "\n".join(lines) + "\n"


def with_ratio(run_, base_of, form):
    """A cell: `form(row)`, and in brackets the time over that of `base_of(row)` in the same run."""

    def cell(row):
        base = next((b for b in map(lambda what: run_.find(what, row), base_of(row)) if b is not None), None)
        return form(row) + (f" ({digits(row.ns / base.ns)})" if base is not None and base is not row else "")

    return cell


def ns_cell(row):
    return digits(row.ns) + (f", {row.counters['error']:.0e}" if "error" in row.counters else "")


def ms_cell(row):
    text = digits(row.ns * row.counters.get("springs", row.springs) * 1e-6)
    text += f", {row.counters['kkt']:.0e}" if "kkt" in row.counters else ""
    return text + (f", {row.counters['peak_MiB']:.0f} MiB" if "peak_MiB" in row.counters else "")


def cache_sizes(context):
    return ", ".join(
        f"L{c['level']} {c['type'].lower()} {c['size'] // 1024} kB" for c in context.get("caches", []) if c.get("size")
    )


def processor():
    """What the operating system calls it."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            fields = dict(re.findall(r"^([\w ]+?)\s*: (.*)$", file.read(), re.MULTILINE))
        return f"{fields['model name']} (family {fields.get('cpu family', '?')}, model {fields.get('model', '?')})"
    except (OSError, KeyError):
        return "unknown"


class Machine:
    """Bandwidths by MiB and peak rates by scalar, as far as they were measured."""

    def __init__(self, runs):
        self.bandwidth, self.peak = {}, {}
        for run_ in runs:
            for name, counters in run_.fastest.items():
                what, _, which = name.partition("/")
                if what == "copy_bandwidth":
                    self.bandwidth[float(which)] = counters["bytes_per_second"]
                elif what == "multiply_add_peak":
                    self.peak[which] = counters["operations_per_second"]

    def bandwidth_of(self, mebibytes):
        """Of the measured size that is nearest in ratio."""
        return self.bandwidth[min(self.bandwidth, key=lambda size: abs(math.log(size / mebibytes)))]


def page_of_machine(runs, machine, options):
    context = next((r.context for r in runs if "flags" in r.context), runs[0].context)
    lines = ["| | |", "|---|---|", f"| processor | {processor()}, {context.get('num_cpus', '?')} cores, one used |"]
    lines.append(f"| caches | {cache_sizes(context) or 'unknown'} |")
    if "flags" in context:
        lines.append(f"| compiler | {context['compiler']}, `{context['flags']}` |")
    lines.append(f"| measured | {context.get('date', '?')[:10]}, the fastest of {options.repetitions} repetitions |")
    for size, rate in sorted(machine.bandwidth.items()):
        lines.append(f"| copy, {size:g} MiB | {digits(rate * 1e-9)} GB/s |")
    for scalar, rate in machine.peak.items():
        lines.append(f"| multiply and add, {scalar} | {digits(rate * 1e-9)} Gflop/s |")
    return "## Machine\n\n" + "\n".join(lines) + "\n\n"


def is_step(row):
    return re.search(r"(_step|_force|_loop)(_random_order|_two_threads|_tight|_volume)?(_\d+)?$", row.what) is not None


def plain_step(row):
    """What a step is compared with."""
    for suffix in ("_random_order", "_volume"):
        if row.what.endswith(suffix):
            return ["plain_loop" + suffix]
    of_stable_step = re.search(r"_\d+$", row.what)
    return ["plain_implicit_step" + of_stable_step[0] if of_stable_step else "plain_loop"]


def page_of_steps(runs):
    page = ""
    for run_ in runs:
        steps = [row for row in run_.rows if is_step(row)]
        peers = [row for row in steps if row.what.startswith(("bullet", "mujoco"))]
        for dim in sorted({row.dim for row in steps}):
            of_dim = [row for row in steps if row.dim == dim]
            page += f"### {'In the plane' if dim == 2 else 'In space'}, `{run_.program}`\n\n"
            page += table(of_dim, with_ratio(run_, plain_step, ns_cell)) + "\n"
        if peers:
            own = lambda row: ["implicit_step" if "implicit" in row.what else "explicit_step"]
            rows = [row for row in peers if run_.find(own(row)[0], row)]
            if rows:
                page += "Time of a peer over springfit's, in the same run:\n\n"
                page += table(rows, lambda row: digits(row.ns / run_.find(own(row)[0], row).ns)) + "\n"
    if not page:
        return ""
    return (
        "## Time steps\n\nNanoseconds per spring and step, and in brackets the time over the plain loop's in the same run. "
        "`plain loop` is symplectic Euler as written in an hour (bench/speed/plain.hpp); explicit steps are half the stable "
        "step, implicit ones 30 or 100 stable steps, with the error against the converged step relative to its movement; those "
        "beside peers are from a stretched state. With volume cells, one per simplex (2 per node in the plane, 6 in space), "
        "the time is still per spring. MuJoCo's step is the same mathematics as ours "
        "(three sliding joints per node, a tendon per spring). Bullet's soft body solves constraints on "
        "positions, one pass over them; its deformable body has one stiffness for all springs, and an implicit step is one "
        "linear solve, to a relative residual of about the root of the precision's epsilon, where ours is one to a "
        "hundredth. Each library is as Debian builds it.\n\n" + page
    )


def page_of_fits(runs):
    page = ""
    for run_ in runs:
        fits = [row for row in run_.rows if not is_step(row) and run_.program != "bench_solve"]
        base = lambda row: ["plain_" + row.what, "plain_exact"] if run_.program == "bench_peers_fit" else ["plain_" + row.what]
        for dim in sorted({row.dim for row in fits}):
            page += f"### {'In the plane' if dim == 2 else 'In space'}, `{run_.program}`\n\n"
            page += table([row for row in fits if row.dim == dim], with_ratio(run_, base, ms_cell)) + "\n"
        own = [row for row in fits if row.what.startswith("exact")]
        if run_.program == "bench_peers_fit" and own:

            def fastest_own(row):
                same = [o for o in own if (o.dim, o.scalar, o.springs) == (row.dim, row.scalar, row.springs)]
                return min((o.ns for o in same), default=None)

            rows = [row for row in fits if not row.what.startswith(("exact", "plain")) and fastest_own(row)]
            if rows:
                page += "Time of a peer over springfit's fastest exact solver, in the same run:\n\n"
                page += table(rows, lambda row: digits(row.ns / fastest_own(row))) + "\n"
    if not page:
        return ""
    return (
        "## Acceleration fit\n\nMilliseconds; where a solver was to reach an optimum, the KKT residual that it reached, and for streamed "
        "frames the peak memory of the process; in "
        "brackets the time over the plain baseline's in the same run (`plain_<name>`, for peers projected "
        "Gauss-Seidel). Peers get the assembled quadratic in scaled variables, start at the prior, and are to reach a "
        "residual of 1e-9 with about an eighth of the bounds active.\n\n" + page
    )


def page_of_matching(runs):
    page = ""
    for run_ in runs:
        if run_.program == "bench_solve":
            base = lambda row: [row.what.replace("supernodal", "simplicial")]
            page += table(run_.rows, with_ratio(run_, base, ms_cell))
    if not page:
        return ""
    return (
        "## Matching of motion\n\nMilliseconds, one thread, and in brackets the time over that of Eigen's in the same run: "
        "sparse factors of a solid network's stiffness, the solves that all cases of a block share, and iterations of "
        "Gauss-Newton, with CHOLMOD's factor where it is linked.\n\n" + page + "\n"
    )


def page_of_roofline(runs, machine):
    lines = {}
    for run_ in runs:
        for row in sorted(run_.rows, key=lambda r: r.ns):
            moved = row.counters.get("bytes_per_spring")
            if not moved or not machine.bandwidth:
                continue
            mebibytes = moved * row.counters.get("springs", row.springs) / 2**20
            memory = moved / machine.bandwidth_of(mebibytes) * 1e9
            operations = row.counters.get("operations_per_spring")
            peak = machine.peak.get(row.scalar)
            arithmetic = operations / peak * 1e9 if operations and peak else None
            bound = max(memory, arithmetic or 0)
            lines.setdefault(
                (row.kind, row.springs),
                f"| {row.name}, {row.dim}d, {row.scalar} | {power(row.springs)} | {digits(moved)} | {digits(memory)} | "
                f"{digits(arithmetic) if arithmetic else '-'} | {digits(row.ns)} | {digits(100 * bound / row.ns)} % |",
            )
    if not lines:
        return ""
    return (
        "## How far from the machine's limits\n\nNanoseconds per spring that the machine allows: to move each array of a step "
        "once at the copy bandwidth of that many bytes, and to do its operations at the peak rate. Last, which share of "
        "the speed allowed is reached. These two are of different programs, so the share is no better than the machine "
        "is steady.\n\n"
        "| | springs | bytes per spring | memory allows | operations allow | measured | share |\n|---|---|---|---|---|---|---|\n"
        + "\n".join(lines[key] for key in sorted(lines)) + "\n\n"
    )


def figure(title, series):
    """Lines of ns per spring over springs, both axes logarithmic; `series`: name to [(springs, ns)]."""
    left, right, top, bottom = 70, 470, 40, 360
    xs = [x for points in series.values() for x, _ in points]
    ys = [y for points in series.values() for _, y in points]
    x_range = [math.log10(min(xs)) - 0.1, math.log10(max(xs)) + 0.1]
    y_range = [math.floor(math.log10(min(ys))), math.ceil(math.log10(max(ys)) + 1e-9)]
    at_x = lambda x: left + (right - left) * (math.log10(x) - x_range[0]) / (x_range[1] - x_range[0])
    at_y = lambda y: bottom - (bottom - top) * (math.log10(y) - y_range[0]) / (y_range[1] - y_range[0])
    out = [
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 420" font-family="sans-serif" font-size="12">',
        '<rect width="100%" height="100%" fill="white"/>',
        f'<text x="{(left + right) / 2}" y="22" text-anchor="middle" font-size="14">{title}</text>',
    ]
    for decade in range(y_range[0], y_range[1] + 1):
        for step in (1, 2, 5):
            y = step * 10.0**decade
            if y > 10.0 ** y_range[1]:
                break
            out.append(f'<path d="M{left} {at_y(y):.1f}H{right}" stroke="#ddd"/>')
            out.append(f'<text x="{left - 6}" y="{at_y(y) + 4:.1f}" text-anchor="end">{y:g}</text>')
    for x in sorted(set(xs)):
        out.append(f'<text x="{at_x(x):.1f}" y="{bottom + 18}" text-anchor="middle">{power(x)}</text>')
    out.append(f'<path d="M{left} {top}V{bottom}H{right}" fill="none" stroke="black"/>')
    out.append(f'<text x="{(left + right) / 2}" y="402" text-anchor="middle">springs</text>')
    out.append('<text text-anchor="middle" transform="translate(18 200) rotate(-90)">ns per spring and step</text>')
    for s, (name, points) in enumerate(series.items()):
        colour = COLOURS[s % len(COLOURS)]
        path = "L".join(f"{at_x(x):.1f} {at_y(y):.1f}" for x, y in sorted(points))
        out.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += [f'<circle cx="{at_x(x):.1f}" cy="{at_y(y):.1f}" r="3" fill="{colour}"/>' for x, y in points]
        out.append(f'<rect x="{right + 14}" y="{top + 1 + 18 * s}" width="12" height="10" fill="{colour}"/>')
        out.append(f'<text x="{right + 32}" y="{top + 10 + 18 * s}">{name}</text>')
    return "\n".join(out + ["</svg>", ""])


def write_figures(runs, folder):
    """One figure for each scalar, explicit steps in space; returns what the page says to show them."""
    page = ""
    for scalar in ("float", "double"):
        series = {}
        for run_ in sorted(runs, key=lambda r: "peers" not in r.program):  # a run with peers before one without
            for row in run_.rows:
                if is_step(row) and row.dim == 3 and row.scalar == scalar and "implicit" not in row.what:
                    points = series.setdefault(row.name, {})
                    points.setdefault(row.springs, row.ns)
        if series:
            name = f"performance-step-{scalar}.svg"
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                title = f"Explicit steps in space, {scalar}"
                file.write(figure(title, {n: list(p.items()) for n, p in series.items()}))
            page += f"![{title}]({name})\n"
    return page + "\n" if page else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs", nargs="+", help="benchmark programs")
    parser.add_argument("--out", default="docs", help="folder of performance.md")
    parser.add_argument("--repetitions", type=int, default=2)
    parser.add_argument("--min-time", type=float, default=0.1, help="seconds of one repetition")
    parser.add_argument("--filter", default=".", help="regular expression of the benchmarks that are run")
    options = parser.parse_args()
    runs = [r for r in (run(program, options) for program in options.programs) if r is not None]
    if not runs:
        sys.exit("no benchmark was run")
    os.makedirs(options.out, exist_ok=True)
    machine = Machine(runs)
    steps = page_of_steps(runs)
    page = (
        "# Performance\n\nWritten by `sh cmake/quickstart.sh performance`. Times move by 5 to 15 % from run to run; compare "
        "the ratios, each of two times from one run.\n\n"
        + page_of_machine(runs, machine, options)
        + steps
        + write_figures(runs, options.out)
        + page_of_fits(runs)
        + page_of_matching(runs)
        + page_of_roofline(runs, machine)
    )
    with open(os.path.join(options.out, "performance.md"), "w", encoding="utf-8") as file:
        file.write(page.rstrip() + "\n")


if __name__ == "__main__":
    main()
