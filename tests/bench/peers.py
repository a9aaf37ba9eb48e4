# SPDX-License-Identifier: GPL-3.0-or-later
"""Other programs: their kept times, and runs beside ours where they are installed and MSML_PEERS holds their scripts."""
import json
import os
import shutil
import subprocess
import tempfile

from rows import run_program

HERE = os.path.dirname(os.path.abspath(__file__))
SYSTEM_PYTHON = "/usr/bin/python3"  # Debian's packages live there


def kept():
    with open(os.path.join(HERE, "peers.json")) as file:
        return json.load(file)


def scaled(entry, theirs, ours):
    """A kept time as this machine would need it, by the bandwidth that each has for that many threads."""
    triad = "triad_2" if entry["threads"] > 1 else "triad_1"
    return {**entry, "seconds": entry["seconds"] * theirs[triad] / ours[triad], "beside": False}


def has_dolfinx(folder):
    if not os.path.exists(os.path.join(folder, "dolfinx_beam.py")) or not shutil.which("mpirun"):
        return False
    return subprocess.run([SYSTEM_PYTHON, "-c", "import dolfinx, petsc4py"], capture_output=True).returncode == 0


def has_calculix(folder):
    return os.path.exists(os.path.join(folder, "beam_mesh.py")) and bool(shutil.which("ccx"))


def run_dolfinx(folder, row, solver, ranks):
    case = "linear" if row.work == "static" else "nh_iso"
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(ranks), SYSTEM_PYTHON,
               os.path.join(folder, "dolfinx_beam.py"), "--n", str(row.n), "--order", "2" if "10" in row.kind else "1",
               "--nu", str(row.nu), "--case", case, "--solver", solver]
    found = run_program(command, env={**os.environ, "OMP_NUM_THREADS": "1"})
    parts = ["t_total"] if case == "nh_iso" else ["t_sparsity", "t_assemble", "t_setup", "t_solve"]
    return {"seconds": sum(found[part] for part in parts), "peak_mb": found["maxrss_MB"] * 1.048576,
            "assembly": found["t_assemble"], "tip": found["tip"][2],
            "iterations": found["its"] if case == "linear" else found["lin_its"]}


def run_calculix(folder, row, threads):
    with tempfile.TemporaryDirectory() as scratch:
        order = "2" if "10" in row.kind else "1"
        subprocess.run([SYSTEM_PYTHON, os.path.join(folder, "beam_mesh.py"), "--n", str(row.n), "--order", order, "--nu",
                        str(row.nu), "--out", scratch, "--formats", "inp"], check=True, capture_output=True)
        ending = "lin" if row.work == "static" else "nl"
        name = next(file[:-4] for file in os.listdir(scratch) if file.endswith(f"_{ending}.inp"))
        found = run_program([SYSTEM_PYTHON, os.path.join(folder, "run_ccx.py"), scratch, name, str(threads), "1"])
    if not found["wall_s"] or not found["tip"]:
        raise RuntimeError(f"CalculiX on {row.key()}: {found}")
    return {"seconds": found["wall_s"], "peak_mb": found["rss_MB"] * 1.048576, "tip": found["tip"][2]}


def ways(folder, row):
    """(peer, method, threads, run) of each peer that can run beside a row."""
    found = []
    if row.work not in ("static", "neo") or row.solver != "automatic" or row.n > 12:
        return found
    if has_dolfinx(folder):
        direct = "chol" if row.work == "static" else "lu"
        for solver, ranks in (("gamg", 2), (direct, 2)):
            if solver != "gamg" and row.n > 8:
                continue
            name = {"gamg": "GAMG", "chol": "MUMPS", "lu": "LU"}[solver]
            found.append(("DOLFINx", f"{name}, {ranks} ranks", ranks,
                          lambda solver=solver, ranks=ranks: run_dolfinx(folder, row, solver, ranks)))
    if has_calculix(folder) and row.n <= (8 if row.work == "static" else 4):
        found.append(("CalculiX", "SPOOLES", 2, lambda: run_calculix(folder, row, 2)))
    return found


def run_beside(folder, row, wake, say):
    """One run of every peer on a row; a peer that fails is told of and left out."""
    results = []
    for peer, method, threads, run in ways(folder, row):
        say(f"{peer} ({method}): {row.key()}")
        try:
            wake(row)
            result = run()
        except (RuntimeError, subprocess.CalledProcessError, KeyError) as error:
            say(f"{peer} failed: {error}")
            continue
        results.append({"peer": peer, "method": method, "work": row.work, "kind": row.kind, "n": row.n, "nu": row.nu,
                        "threads": threads, "beside": True, **result})
    return results


def best_of(entries):
    """Of each peer the fastest way; what ran beside us replaces what is kept."""
    best = {}
    for entry in entries:
        known = best.get(entry["peer"])
        if known is None or (entry["beside"], -entry["seconds"]) > (known["beside"], -known["seconds"]):
            best[entry["peer"]] = entry
    return best
