# SPDX-License-Identifier: GPL-3.0-or-later
"""What the project asks of its own speed, beside the ratios to other programs."""


FOUR_POINTS = "tangent tet10 of four points, for steps"  # the kernel that one rotation saves


def value(lines, name, *key):
    """A number of the line with that work, kind, n and nu (solver: automatic); None where there is none."""
    for line in lines:
        if (line["work"], line["kind"], line["n"], line["nu"], line["method"]) == (*key, "automatic"):
            return line[name] if line[name] != "" else None
    return None


def of(above, below):
    return above / below if above is not None and below else None


def interactive(lines):
    step = lambda kind, n, nu=0.3: value(lines, "unit", "step", kind, n, nu)
    found = [(f"step tet4 n={n}, nu 0.49 beside 0.3", of(step("tet4", n, 0.49), step("tet4", n)), 2) for n in (6, 9, 15)]
    for small, large in ((3, 6), (8, 16)):
        found.append((f"step tet10 n={small} beside tet4 n={large}", of(step("tet10", small), step("tet4", large)), 1.5))
    return found


def static(lines, beside):
    number = lambda name, n, nu=0.3, work="static": value(lines, name, work, "tet10", n, nu)
    million, quarter = of(number("unit", 20), number("unknowns", 20)), of(number("unit", 12), number("unknowns", 12))
    found = [("a million unknowns beside 226,875, time per unknown", of(million, quarter), 1.2),
             ("a million unknowns, GB", of(number("peak_mb", 20), 1000), 3),
             ("226,875 unknowns, memory beside DOLFINx", number("memory_ratio", 12), 0.5)]
    for n in (4, 8):
        newton = of(number("unit", n, work="neo"), number("solves", n, work="neo"))
        found.append((f"a Newton iteration beside a linear solve, n={n}", of(newton, number("unit", n)), 1.3))
    theirs = [entry["assembly"] for entry in beside
              if (entry["peer"], entry["work"], entry["kind"], entry["n"], entry["nu"])
              == ("DOLFINx", "static", "tet10", 8, 0.3)]
    found.append(("tangent of 15,360 tet10 beside DOLFINx", of(number("assembly", 8), min(theirs, default=None)), 0.25))
    iterations = [line["iterations"] for line in lines if line["work"] == "static" and line["iterations"] != ""]
    found.append(("iterations of a static solve, largest", max(iterations, default=None), 40))
    memory = [of(line["peak_mb"], line["reported_mb"]) for line in lines if line["reported_mb"] != ""]
    found.append(("peak memory beside mesh, matrix and hierarchy", max(filter(None, memory), default=None), 1.2))
    return found


def around(lines):
    return [("scene of six tetrahedra, ms", of(value(lines, "unit", "scene", "", "", ""), 1e-3), 50),
            ("raw writing beside VTU, speed", of(1, value(lines, "rate", "write", "vtu", "", "")), 2),
            ("meshing beside CGAL alone, time", of(1, value(lines, "rate", "mesh", "ball", "", "")), 1.1)]


def of_rows(lines, beside):
    return interactive(lines) + static(lines, beside) + around(lines)


def of_kernels(lines):
    """Forces and tangents: 60 % of the roofline, 1.8 times the speed with two threads where arithmetic is the bound; of one
    rotation a quarter of the time that the matrix of four points takes."""
    found = []
    times = {(line["kernel"], line["threads"]): line["ns_per_item"] for line in lines}
    for threads in (1, 2):
        single, four = (times.get((name, threads)) for name in ("step tangent tet10SR", FOUR_POINTS))
        found.append((f"step tangent tet10SR beside {FOUR_POINTS}, {threads} thr.", of(single, four), 0.25))
    for line in lines:
        if not line["kernel"].startswith(("internal force", "tangent", "step tangent")):
            continue
        name = f"{line['kernel']}, {line['threads']} thr."
        found.append((f"0.6 roofline beside {name}", of(0.6, line["share"]), 1))
        if line["threads"] == 2 and line["kernel"].startswith("internal force"):
            found.append((f"gain of 1.8 beside {name}", of(1.8, line["gain"]), 1))
    return found


def text_of(wishes):
    """One line per wish: what is measured, what it may be at most, and whether it is."""
    known = [wish for wish in wishes if wish[1] is not None]
    width = max((len(what) for what, *_ in known), default=0)
    rows = [f"  {what:{width}}  {measured:7.3g}  {limit:5g}  {'reached' if measured <= limit else 'short'}"
            for what, measured, limit in known]
    return "\n".join(["what is asked of ourselves: measured, at most"] + rows)
