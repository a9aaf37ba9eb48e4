# SPDX-License-Identifier: GPL-3.0-or-later
"""Two charts by gnuplot: time against unknowns with slopes, and error against time."""
import math
import os
import shutil
import subprocess


def slope(points):
    """The exponent p of y = c x^p through points by least squares in logarithms; None for fewer than two."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    if len(logs) < 2:
        return None
    x_mean, y_mean = (sum(values) / len(logs) for values in zip(*logs))
    spread = sum((x - x_mean) ** 2 for x, _ in logs)
    return sum((x - x_mean) * (y - y_mean) for x, y in logs) / spread if spread > 0 else None


def series_of(lines, beside, x, y):
    """{name: [(x, y), …]} of our rows by work, element and nu, and of peers run beside us."""
    series = {}
    for line in lines:
        if line["kind"] and line["method"] == "automatic" and line[x] and line[y]:
            series.setdefault(f"{line['work']} {line['kind']} nu {line['nu']}", []).append((line[x], line[y]))
    for entry in beside:
        if entry.get(x) and entry.get(y):
            name = f"{entry['work']} {entry['kind']} nu {entry['nu']:g}, {entry['peer']} {entry['method']}"
            series.setdefault(name, []).append((entry[x], entry[y]))
    # A lone time of a peer says nothing about growth.
    return {name: sorted(points) for name, points in series.items() if len(points) > 1 or "," not in name}


def draw(path, series, x_label, y_label):
    """An SVG with logarithmic axes; false where gnuplot is missing or there is nothing to show."""
    program = shutil.which("gnuplot")
    if not program or not series:
        return False
    words = [f"set terminal svg size 1200,600; set output '{path}'; set logscale xy; set key outside right; set grid",
             f"set xlabel '{x_label}'; set ylabel '{y_label}'; set format y '%g'; set format x '%g'"]
    curves = []
    for k, (name, points) in enumerate(series.items()):
        words.append(f"$series{k} << END\n" + "\n".join(f"{x:g} {y:g}" for x, y in points) + "\nEND")
        exponent = slope(points)
        title = name + (f": slope {exponent:.2f}" if exponent is not None else "")
        dash = "dashtype 2" if "," in name else ""
        curves.append(f"$series{k} using 1:2 with linespoints pointtype {k % 12 + 1} {dash} title '{title}'")
    subprocess.run([program], input="\n".join([*words, "plot " + ", ".join(curves)]), text=True, check=True)
    return True


def draw_all(lines, beside, known, folder):
    """time.svg and error.svg; the paths of those that were drawn."""
    sizes = {(line["work"], line["kind"], line["n"], line["nu"]): line["unknowns"] for line in lines}
    peers = []
    for entry in beside:
        peer = {**entry, "unit": entry["seconds"],
                "unknowns": sizes.get(tuple(entry[name] for name in ("work", "kind", "n", "nu")))}
        if entry["work"] == "static" and entry["nu"] == 0.3:
            peer["mesh_error"] = abs(entry["tip"] / known["limit"]["u_z"] - 1)
        peers.append(peer)
    time, error = os.path.join(folder, "time.svg"), os.path.join(folder, "error.svg")
    drawn = [draw(time, series_of(lines, peers, "unknowns", "unit"), "unknowns", "seconds of a step or a solve"),
             draw(error, series_of(lines, peers, "unit", "mesh_error"), "seconds of a solve", "error of the tip")]
    return [path for path, done in zip((time, error), drawn) if done]
