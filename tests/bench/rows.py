# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of the bench: what is run, and what one run of it says."""
import json
import os
import re
import statistics
import subprocess
import tempfile
import time
from dataclasses import dataclass, field


@dataclass
class Row:
    """A piece of work on the cantilever (work: static, neo, step or push), or something around it (scene, write, …)."""
    work: str
    kind: str = ""
    n: int = 0
    nu: float = 0.3
    solver: str = "automatic"
    count: int = 0
    runs: int = 5
    needs_gb: float = 1
    wanted: str = ""  # "PEER RATIO", what the project asks of itself
    command: list = field(default_factory=list)

    def key(self):
        return f"{self.work} {self.kind} n={self.n} nu={self.nu:g} {self.solver}" if self.n else self.work


def beam_rows(quick):
    """What is asked for: interactive steps, static linear and neo-Hookean equilibria."""
    step = lambda kind, n, nu, wanted="": Row("step", kind, n, nu, count=60 if quick else 1000, wanted=wanted,
                                             runs=3 if quick else 5 if n < 10 else 3)
    if quick:
        rows = [step("tet4", 4, nu) for nu in (0.3, 0.49)] + [step("tet10", 2, 0.3), step("tet10SR", 2, 0.3)]
        rows += [Row("static", "tet10", n, 0.3, runs=3) for n in (2, 4)] + [Row("static", "tet10", 4, 0.49, runs=3)]
        return rows + [Row("static", "tet4", 4, runs=3), Row("neo", "tet10", 4, 0.3, runs=3)]
    rows = [step("tet4", 6, 0.3, "SOFA 15"), step("tet4", 9, 0.3, "SOFA 20"), step("tet4", 15, 0.3, "SOFA 35")]
    rows += [step("tet4", n, 0.49) for n in (6, 9, 15)]
    rows += [Row("push", "tet4", n, 0.3, count=1000, runs=3) for n in (6, 15)]
    rows += [step(kind, 3, 0.3) for kind in ("tet10", "tet10SR")]
    rows += [Row("step", kind, n, 0.3, count=100, runs=3)
             for kind, n in (("tet4", 16), ("tet10", 8), ("tet10SR", 8))]
    rows += [Row("static", "tet4", n) for n in (4, 8, 16)]
    rows += [Row("static", "tet10", 4), Row("static", "tet10", 8, wanted="DOLFINx 2"),
             Row("static", "tet10", 8, solver="direct"), Row("static", "tet10", 8, 0.49, wanted="DOLFINx 2.22"),
             Row("static", "tet10", 12, wanted="DOLFINx 2.5"), Row("static", "tet10", 12, 0.49),
             Row("static", "tet10", 20, runs=3, needs_gb=4), Row("static", "tet10", 20, 0.49, runs=1, needs_gb=4),
             Row("static", "tet10", 35, runs=1, needs_gb=18), Row("static", "tet10", 35, 0.49, runs=1, needs_gb=18)]
    rows += [Row("neo", "tet10", 4), Row("neo", "tet10", 4, 0.49), Row("neo", "tet10", 8, wanted="DOLFINx 5")]
    return rows


def all_rows(quick, folder):
    """Every row; programs that write do so in `folder`."""
    runs = 3 if quick else 5
    return beam_rows(quick) + [Row("scene", runs=runs),
                               Row("write", "vtu", runs=runs, command=["write_bench", folder, "8" if quick else "24"]),
                               Row("mesh", "ball", runs=runs, command=["mesh_bench", "0.1" if quick else "0.05"])]


SCENE = """<msml:msml xmlns:msml="http://sfb125.de/msml">
<workflow>
<GenerateBoxMesh id="box" size="1 1 1" divisions="1 1 1"/>
<ComputeIndicesFromBoxROI id="all" mesh="${box}" select="elements" box="-1 -1 -1 2 2 2"/>
<ComputeIndicesFromBoxROI id="foot" mesh="${box}" select="points" box="-1 -1 -1 0.1 2 2"/>
</workflow>
<scene><object id="cube">
<mesh><linearTet id="cubeMesh" mesh="${box}"/></mesh>
<material><region id="body" indices="${all}">
<linearElasticMaterial youngModulus="1e5" poissonRatio="0.3"/><mass massDensity="1000"/></region></material>
<constraints><constraint name="wall"><fixedConstraint indices="${foot}"/></constraint></constraints>
<output><result id="bent" fields="displacement"/></output>
</object></scene>
<environment><solver timeIntegration="static"/><simulation><step name="weight" gravity="0 0 -9.81"/></simulation>
</environment>
</msml:msml>
"""


def memory_available_gb():
    try:
        with open("/proc/meminfo") as info:
            return int(re.search(r"MemAvailable: +(\d+)", info.read()).group(1)) / 1e6
    except (OSError, AttributeError):
        return float("inf")


def run_program(command, **options):
    """The last line of JSON that a program prints; raises RuntimeError with its words where there is none."""
    done = subprocess.run(command, capture_output=True, text=True, **options)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 and not lines:
        raise RuntimeError(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout[-500:]}{done.stderr[-1500:]}")
    return json.loads(lines[-1])


def run_beam(binaries, row):
    words = [row.work, row.kind, row.n, row.nu, row.solver, 2, row.count]
    result = run_program([os.path.join(binaries, "beam_bench"), *map(str, words)])
    if result["failure"]:
        raise RuntimeError(f"{row.key()}: {result['failure']}")
    return result


def run_scene(binaries, row):
    """Wall time of a whole run of a scene of six tetrahedra, results written to memory: disks may take their time."""
    memory = "/dev/shm"
    with tempfile.TemporaryDirectory(dir=memory if os.access(memory, os.W_OK) else None) as scratch:
        scene = os.path.join(scratch, "tiny.msml.xml")
        with open(scene, "w") as out:
            out.write(SCENE)
        start = time.perf_counter()
        done = subprocess.run([os.path.join(binaries, "msml"), "exec", scene, "-o", os.path.join(scratch, "out")],
                              capture_output=True, text=True)
        seconds = time.perf_counter() - start
        if done.returncode != 0:
            raise RuntimeError(f"{row.key()}: {done.stdout[-800:]}{done.stderr[-800:]}")
    return {"answer": seconds, "total": seconds}


def wake(binaries, row):
    """Has as much memory as a row may need at hand; otherwise the system's share depends on what ran before. The same
    before the peers."""
    subprocess.run([os.path.join(binaries, "machine_probe"), "wake", str(row.needs_gb)], check=True)


def run_row(binaries, row):
    if row.work in ("step", "push", "static", "neo"):
        return run_beam(binaries, row)
    if row.work == "scene":
        return run_scene(binaries, row)
    return run_program([os.path.join(binaries, row.command[0]), *row.command[1:]])


def run_round(rows, turn, run, say, failures):
    """One result of each row that still wants one; in rounds over all rows a slow minute meets all of them.

    What fails is told, and its words are added to `failures`."""
    results = {}
    for row in rows:
        if turn >= row.runs:
            continue
        if memory_available_gb() < row.needs_gb:
            say(f"{row.key()}: left out, wants {row.needs_gb:g} GB of free memory")
            continue
        say(f"round {turn + 1}: {row.key()}")
        try:
            results[row.key()] = run(row)
        except (RuntimeError, OSError) as error:
            say(str(error))
            failures.append(f"{row.key()}: {error}")
    return results


def median_of(results):
    """Of each number the median over the runs, but of `worst` the largest; other values are those of the first run."""
    middle = dict(results[0])
    for name, value in middle.items():
        values = [result[name] for result in results if name in result]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            middle[name] = max(values) if name == "worst" else statistics.median(values)
    middle["runs"] = len(results)
    return middle
