# SPDX-License-Identifier: GPL-3.0-or-later
"""Kernels and the share each reaches of what memory and arithmetic of the machine allow."""
import json
import os
import subprocess


def run(binaries, quick):
    """One entry per kernel and number of threads, medians over repetitions in turns with those of all others, as a
    machine may be slower for some seconds; none where the program is not built."""
    program = os.path.join(binaries, "kernel_bench")
    if not os.path.exists(program):
        return []
    command = [program, "--benchmark_format=json", "--benchmark_repetitions=9", "--benchmark_min_time=0.05",
               "--benchmark_enable_random_interleaving=true"]
    done = subprocess.run(command + (["quick"] if quick else []), capture_output=True, text=True, check=True)
    return [entry for entry in json.loads(done.stdout)["benchmarks"] if entry.get("aggregate_name") == "median"]


def share(entry, machine):
    """One line: seconds per item, what bounds it, and the share of the bound that is reached (the roofline)."""
    name, threads = entry["run_name"].split("/threads:")
    threads = threads.split("/")[0]
    seconds = entry["real_time"] * 1e-3 / entry["items"]
    memory = entry["bytes_per_item"] / (1e9 * machine[f"triad_{threads}"])
    arithmetic = entry["flops_per_item"] / (1e9 * machine[f"fma_{threads}"])
    return {"kernel": name, "threads": int(threads), "ns_per_item": 1e9 * seconds, "bytes": entry["bytes_per_item"],
            "flops": entry["flops_per_item"], "bound": "memory" if memory > arithmetic else "arithmetic",
            "share": max(memory, arithmetic) / seconds}


def text_of(lines):
    """The kernels for people, with the gain from the second thread."""
    alone = {line["kernel"]: line["ns_per_item"] for line in lines if line["threads"] == 1}
    rows = [f"{'kernel':36}  thr.  ns/item  bytes  flops  GB/s  GFLOP/s  bound by    share  gain"]
    for line in sorted(lines, key=lambda line: (line["kernel"], line["threads"])):
        gain = alone[line["kernel"]] / line["ns_per_item"] if line["threads"] > 1 else 1
        rows.append(f"{line['kernel']:36}  {line['threads']:4}  {line['ns_per_item']:7.1f}  {line['bytes']:5.0f}  "
                    f"{line['flops']:5.0f}  {line['bytes'] / line['ns_per_item']:4.1f}  "
                    f"{line['flops'] / line['ns_per_item']:7.1f}  {line['bound']:10}  {100 * line['share']:4.0f} %  {gain:.2f}")
    return "\n".join(rows)


def write_csv(lines, path):
    with open(path, "w") as out:
        out.write("kernel,threads,ns_per_item,bytes,flops,bound,share\n")
        for line in lines:
            out.write(f"{line['kernel']},{line['threads']},{line['ns_per_item']:.4g},{line['bytes']:.0f},"
                      f"{line['flops']:.0f},{line['bound']},{line['share']:.3f}\n")
