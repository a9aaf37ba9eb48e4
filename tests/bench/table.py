# SPDX-License-Identifier: GPL-3.0-or-later
"""The bench's table: from runs to lines, as text and CSV, and the comparison with an earlier one."""
import csv

from peers import best_of

PEERS = ["SOFA", "VegaFEM", "DOLFINx", "CalculiX", "FEBio"]
NUMBERS = ["unknowns", "runs", "setup", "assembly", "linear", "first", "unit", "rest", "worst", "total", "peak_mb",
           "reported_mb", "solves", "iterations", "tip_error", "mesh_error", "moved_gb", "rate", *PEERS, "memory_ratio"]
COLUMNS = ["work", "kind", "n", "nu", "method", *NUMBERS, "beside", "wanted"]
LOSS = 0.2  # a ratio that falls by more is reported
TIP_DIGITS = 3e-6  # references have six digits, and both sides round


def same(row, entry):
    return (row.work, row.kind, row.n, row.nu) == (entry["work"], entry["kind"], entry["n"], entry["nu"])


def relative(value, reference):
    return abs(value - reference) / abs(reference)


def line_of(row, result, peer_entries, known, machine):
    """One line: `unit` is the time of a step or of a solve, `moved_gb` what the machine's triad moves in that time with
    one thread: with two it may move twice as much from one minute to the next, where a virtual machine is moved."""
    line = {name: "" for name in COLUMNS}
    unit = result.get("step", result["answer"])
    line.update(work=row.work, kind=row.kind, n=row.n or "", nu=row.nu if row.n else "", method=row.solver, unit=unit,
                wanted=row.wanted, runs=result["runs"], total=result["total"], moved_gb=unit * machine["triad_1"])
    for name in ("unknowns", "setup", "assembly", "linear", "first", "rest", "worst", "peak_mb", "reported_mb", "solves", "rate"):
        line[name] = result.get(name, "")
    if result.get("solves"):
        line["iterations"] = result["iterations"] / result["solves"]
    if "tip" in result:
        add_errors(line, row, result["tip"][2], known)
    if row.solver == "automatic":
        add_ratios(line, unit, result.get("peak_mb"), [entry for entry in peer_entries if same(row, entry)])
    return line


def add_errors(line, row, tip, known):
    for reference in known["tips"]:
        if same(row, reference):
            line["tip_error"] = relative(tip, reference["u_z"])
    if row.work == "static" and row.nu == 0.3:
        line["mesh_error"] = relative(tip, known["limit"]["u_z"])


def add_ratios(line, unit, peak_mb, entries):
    best = best_of(entries)
    for peer, entry in best.items():
        line[peer] = entry["seconds"] / unit
    line["beside"] = " ".join(peer for peer in PEERS if peer in best and best[peer]["beside"])
    if "peak_mb" in best.get("DOLFINx", {}) and peak_mb:
        line["memory_ratio"] = peak_mb / best["DOLFINx"]["peak_mb"]


def key_of(line):
    return tuple(str(line[name]) for name in ("work", "kind", "n", "nu", "method"))


def write_csv(lines, machine, path):
    with open(path, "w", newline="") as out:
        out.write("# " + ", ".join(f"{name} {value}" for name, value in machine.items()) + "\n")
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for line in lines:
            writer.writerow({name: f"{value:.5g}" if isinstance(value, float) else value for name, value in line.items()})


def read_csv(path):
    """Lines as write_csv wrote them; numbers are numbers, what is empty stays an empty text."""
    with open(path, newline="") as file:
        lines = list(csv.DictReader(row for row in file if not row.startswith("#")))
    for line in lines:
        for name in NUMBERS:
            if line.get(name):
                line[name] = float(line[name])
    return lines


def losses(before, now, allowed=LOSS):
    """What has become worse by more than the allowed share since an earlier table: sentences.

    Speed is compared by the ratio to each peer, and by the bytes that the machine would have moved in the same time,
    which no peer can hide. Both tables are as read_csv gives them. Lines that only one of them has are passed over, and
    so are ratios where the peer ran beside us in one of them alone."""
    earlier = {key_of(line): line for line in before}
    found = []
    for line in now:
        old = earlier.get(key_of(line))
        if old is None:
            continue
        speeds = [(f"ratio to {peer}", old.get(peer), line.get(peer)) for peer in PEERS
                  if (peer in old.get("beside", "")) == (peer in line.get("beside", ""))]
        if old.get("moved_gb") and line.get("moved_gb"):
            speeds.append(("speed beside the memory's", 1 / old["moved_gb"], 1 / line["moved_gb"]))
        for what, then, today in speeds:
            if then and today and today < (1 - allowed) * then:
                found.append(f"{' '.join(key_of(line))}: {what} fell from {then:.3g} to {today:.3g}")
    return found


def wrong(lines):
    """Lines whose tip is not that of other programs on the same mesh: sentences."""
    return [f"{' '.join(key_of(line))}: the tip is off by {line['tip_error']:.1e}, more than {TIP_DIGITS:g}"
            for line in lines if line["tip_error"] != "" and line["tip_error"] > TIP_DIGITS]


def milliseconds(value):
    return "" if value == "" else f"{1e3 * value:.2f}" if value < 0.1 else f"{1e3 * value:.0f}"


def text_of(lines):
    """The table for people; times in milliseconds, ratios marked * where the peer's time is a kept one, scaled."""
    heads = ["work", "method", "n", "nu", "unknowns", "set-up", "first", "step/solve", "rest", "worst", "total s", "peak MB", "it.",
             "tip off", *PEERS, "memory", "wanted"]
    rows = [heads]
    for line in lines:
        short = lambda name, form: format(line[name], form) if line[name] != "" else ""
        method = f"{line['kind']} {'' if line['method'] == 'automatic' else line['method']}".strip()
        rate = f"{line['rate']:.2f} of the bare speed" if line["rate"] != "" else ""
        rows.append([line["work"], f"{method} {rate}".strip(), short("n", "d"), short("nu", "g"), short("unknowns", ",.0f"),
                     *(milliseconds(line[name]) for name in ("setup", "first", "unit", "rest", "worst")), short("total", ".2f"),
                     short("peak_mb", ".0f"), short("iterations", ".1f"), short("tip_error", ".0e"),
                     *(short(peer, ".2f") + ("" if line[peer] == "" or peer in line["beside"] else "*") for peer in PEERS),
                     short("memory_ratio", ".2f"), verdict(line)])
    widths = [max(len(row[k]) for row in rows) for k in range(len(heads))]
    keep = [k for k in range(len(heads)) if any(row[k] for row in rows[1:])]
    return "\n".join("  ".join(row[k].ljust(widths[k]) if k < 2 else row[k].rjust(widths[k]) for k in keep).rstrip()
                     for row in rows)


def verdict(line):
    """What is wanted of a ratio, and whether it is reached."""
    if not line["wanted"]:
        return ""
    peer, ratio = line["wanted"].split()
    if line[peer] == "":
        return line["wanted"]
    return f"{line['wanted']}: {'reached' if line[peer] >= float(ratio) else 'short'}"
