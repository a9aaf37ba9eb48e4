# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernels and the share each reaches of what memory and arithmetic of the machine allow."""
import json
import os
import statistics
import subprocess


NEAR = 100  # ns from one thread to another, at most, where their processors share a cache


def run(binaries, quick):
    """The repetitions of each kernel and number of threads, in turns with those of all others, as a machine may be slower
    for some seconds; none where the program is not built."""
    program = os.path.join(binaries, "kernel_bench")
    if not os.path.exists(program):
        return []
    command = [program, "--benchmark_format=json", "--benchmark_repetitions=9", "--benchmark_min_time=0.05",
               "--benchmark_enable_random_interleaving=true"]
    done = subprocess.run(command + (["quick"] if quick else []), capture_output=True, text=True, check=True)
    groups = {}
    for entry in json.loads(done.stdout)["benchmarks"]:
        if entry["run_type"] == "iteration":
            groups.setdefault(entry["run_name"], []).append(entry)
    return list(groups.values())


def share(repetitions, machine):
    """One line: seconds per item, median of the repetitions with processors that share a cache (of all where none did), what
    bounds it, and the share of the bound that is reached (the roofline)."""
    entry = repetitions[0]
    name, threads = entry["run_name"].split("/threads:")
    threads = threads.split("/")[0]
    near = [one for one in repetitions if one.get("handover", 0) <= NEAR]
    of_all, of_near = (statistics.median(one["real_time"] for one in runs) * 1e-3 / entry["items"]
                        for runs in (repetitions, near or repetitions))
    memory = entry["bytes_per_item"] / (1e9 * machine[f"triad_{threads}"])
    arithmetic = entry["flops_per_item"] / (1e9 * machine[f"fma_{threads}"])
    return {"kernel": name, "threads": int(threads), "ns_per_item": 1e9 * of_near, "ns_of_all": 1e9 * of_all,
            "bytes": entry["bytes_per_item"], "flops": entry["flops_per_item"],
            "bound": "memory" if memory > arithmetic else "arithmetic", "share": max(memory, arithmetic) / of_near,
            "near": len(near), "runs": len(repetitions)}


def lines_of(groups, machine):
    """One line per kernel and number of threads, with the gain from the second thread in `gain` and `gain_of_all`."""
    lines = sorted((share(group, machine) for group in groups), key=lambda line: (line["kernel"], line["threads"]))
    alone = {line["kernel"]: line["ns_per_item"] for line in lines if line["threads"] == 1}
    for line in lines:
        line["gain"] = alone[line["kernel"]] / line["ns_per_item"]
        line["gain_of_all"] = alone[line["kernel"]] / line["ns_of_all"]
    return lines


def text_of(lines):
    """The kernels for people."""
    rows = [f"{'kernel':36}  thr.  ns/item  bytes  flops  GB/s  GFLOP/s  bound by    share  gain  of runs  of all"]
    for line in lines:
        rows.append(f"{line['kernel']:36}  {line['threads']:4}  {line['ns_per_item']:7.1f}  {line['bytes']:5.0f}  "
                    f"{line['flops']:5.0f}  {line['bytes'] / line['ns_per_item']:4.1f}  "
                    f"{line['flops'] / line['ns_per_item']:7.1f}  {line['bound']:10}  {100 * line['share']:4.0f} %  "
                    f"{line['gain']:.2f}  {line['near']:3}/{line['runs']}    {line['gain_of_all']:.2f}")
    rows.append(f"of runs: those whose threads were at most {NEAR} ns apart, which share a cache; a virtual machine may be "
                "moved meanwhile")
    return "\n".join(rows)


def write_csv(lines, path):
    with open(path, "w") as out:
        out.write("kernel,threads,ns_per_item,bytes,flops,bound,share,gain,near,runs,gain_of_all\n")
        for line in lines:
            out.write(f"{line['kernel']},{line['threads']},{line['ns_per_item']:.4g},{line['bytes']:.0f},"
                      f"{line['flops']:.0f},{line['bound']},{line['share']:.3f},{line['gain']:.3f},"
                      f"{line['near']},{line['runs']},{line['gain_of_all']:.3f}\n")
