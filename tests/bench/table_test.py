# SPDX-License-Identifier: GPL-3.0-or-later
"""What the bench's table says of two small tables, of kept times and of wrong tips."""
import os
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import charts  # noqa: E402
import kernels  # noqa: E402
import peers  # noqa: E402
import rows  # noqa: E402
import table  # noqa: E402
import wishes  # noqa: E402

MACHINE = {"triad_1": 20.0, "triad_2": 40.0}


def read(text):
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        file.write("# triad_1 20, triad_2 40\n" + text)
        file.flush()
        return table.read_csv(file.name)


def beam_line(seconds, tip_z=-0.0376164, **more):
    row = rows.Row("static", "tet10", 8)
    result = {"answer": seconds, "total": seconds, "runs": 5, "tip": [0, 0, tip_z], "unknowns": 70227, **more}
    return table.line_of(row, result, [peers.scaled(entry, peers.kept()["machine"], MACHINE)
                                       for entry in peers.kept()["times"]], peers.kept(), MACHINE)


class Comparison(unittest.TestCase):
    before = "work,kind,n,nu,method,moved_gb,SOFA\nstep,tet4,6,0.3,automatic,0.2,10\nscene,,,,automatic,2,\n"

    def now(self, moved, ratio, scene=2.0):
        return read(f"work,kind,n,nu,method,moved_gb,SOFA\nstep,tet4,6,0.3,automatic,{moved},{ratio}\n"
                    f"scene,,,,automatic,{scene},\nstep,tet4,9,0.3,automatic,9,1\n")

    def test_equal_tables_and_lines_of_one_of_them_lose_nothing(self):
        self.assertEqual(table.losses(read(self.before), self.now(0.2, 10)), [])

    def test_a_fifth_less_is_let_pass_and_more_is_not(self):
        self.assertEqual(table.losses(read(self.before), self.now(0.2, 8.01)), [])
        self.assertEqual(table.losses(read(self.before), self.now(0.2, 7.9)),
                         ["step tet4 6 0.3 automatic: ratio to SOFA fell from 10 to 7.9"])

    def test_lines_without_a_peer_are_compared_with_the_memory_bandwidth(self):
        found = table.losses(read(self.before), self.now(0.2, 10, scene=2.6))
        self.assertEqual(len(found), 1)
        self.assertIn("scene", found[0])

    def test_a_kept_time_is_not_compared_with_a_run_beside(self):
        head = "work,kind,n,nu,method,DOLFINx,beside\nstatic,tet10,8,0.3,automatic,"
        self.assertEqual(table.losses(read(head + "9,DOLFINx CalculiX\n"), read(head + "4,CalculiX\n")), [])
        self.assertEqual(len(table.losses(read(head + "9,DOLFINx\n"), read(head + "4,DOLFINx\n"))), 1)

    def test_gains_are_no_losses(self):
        self.assertEqual(table.losses(read(self.before), self.now(0.1, 20, scene=1)), [])


class Lines(unittest.TestCase):
    def test_kept_times_are_scaled_by_the_bandwidth_of_as_many_threads(self):
        # DOLFINx kept 2.10 s on two ranks where the triad moved 29.2 GB/s: 2.10 * 29.2 / 40 here.
        self.assertAlmostEqual(beam_line(0.5)["DOLFINx"], 2.10 * 29.2 / 40 / 0.5, places=12)
        # The faster of CalculiX's two ways is the sparse factorisation with 9.7 s on two threads.
        self.assertAlmostEqual(beam_line(0.5)["CalculiX"], min(9.7 * 29.2 / 40, 8.4 * 14.9 / 20) / 0.5, places=12)

    def test_cost_is_counted_in_the_bandwidth_of_one_thread(self):
        self.assertEqual(beam_line(0.5)["moved_gb"], 0.5 * 20)

    def test_a_run_beside_us_replaces_a_kept_time(self):
        kept = {"peer": "DOLFINx", "seconds": 1.0, "beside": False}
        slow, fast = ({"peer": "DOLFINx", "seconds": s, "beside": True} for s in (3.0, 2.0))
        self.assertIs(peers.best_of([slow, kept, fast])["DOLFINx"], fast)

    def test_a_tip_that_differs_in_the_sixth_digit_is_wrong(self):
        self.assertEqual(table.wrong([beam_line(1, -0.03761645)]), [])
        self.assertEqual(len(table.wrong([beam_line(1, -0.0376170)])), 1)

    def test_what_is_written_is_read(self):
        line = beam_line(0.5, peak_mb=250.0)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "results.csv")
            table.write_csv([line], MACHINE, path)
            read_line = table.read_csv(path)[0]
        for name, value in line.items():
            if isinstance(value, float):
                self.assertAlmostEqual(float(read_line[name]), value, delta=1e-4 * abs(value), msg=name)
            else:
                self.assertEqual(str(read_line[name]).removesuffix(".0"), str(value), msg=name)
        self.assertEqual(table.losses([read_line], [read_line]), [])

    def test_a_run_that_fails_leaves_the_others_standing(self):
        def run(row):
            if row.work == "b":
                raise RuntimeError("did not converge")
            return {"answer": 1}
        failures = []
        found = rows.run_round([rows.Row("a"), rows.Row("b"), rows.Row("c", runs=0)], 0, run, lambda text: None, failures)
        self.assertEqual((found, failures), ({"a": {"answer": 1}}, ["b: did not converge"]))

    def test_medians_are_of_numbers_and_the_worst_stays_the_worst(self):
        runs = [{"step": s, "worst": w, "solver": "cg"} for s, w in ((1.0, 5.0), (9.0, 20.0), (2.0, 6.0))]
        self.assertEqual(rows.median_of(runs), {"step": 2.0, "worst": 20.0, "solver": "cg", "runs": 3})

    def test_a_wish_is_reached_up_to_its_limit(self):
        line = lambda nu, unit: table.line_of(rows.Row("step", "tet4", 6, nu), {"answer": unit, "total": 1, "runs": 1}, [],
                                              peers.kept(), MACHINE)
        self.assertRegex(wishes.text_of(wishes.of_rows([line(0.3, 1.0), line(0.49, 1.9)], [])), r"n=6, nu 0.49.* 1.9 +2 +reached")
        self.assertRegex(wishes.text_of(wishes.of_rows([line(0.3, 1.0), line(0.49, 2.1)], [])), r"n=6, nu 0.49.* 2.1 +2 +short")

    def test_a_power_law_has_its_exponent_as_slope(self):
        self.assertAlmostEqual(charts.slope([(x, 3 * x ** 1.5) for x in (10, 100, 700)]), 1.5, places=12)
        self.assertIsNone(charts.slope([(1, 2)]))

    def test_a_kernel_at_half_the_bandwidth_has_half_the_roofline(self):
        # 100 bytes at 20 GB/s take 5 ns, 10 operations at 50 GFLOP/s 0.2 ns.
        found = kernels.share([self.repetition("x", 1, 1e-3)], {"triad_1": 20, "fma_1": 50})
        self.assertEqual((found["bound"], round(found["share"], 12)), ("memory", 0.5))

    def repetition(self, name, threads, milliseconds, **more):
        return {"run_name": f"{name}/threads:{threads}/real_time", "real_time": milliseconds, "items": 100,
                "bytes_per_item": 100, "flops_per_item": 10, **more}

    def test_the_gain_is_that_of_near_processors_and_beside_it_that_of_all_runs(self):
        machine = {"triad_1": 20, "fma_1": 50, "triad_2": 40, "fma_2": 100}
        alone = [self.repetition("internal force", 1, 6)] * 3
        both = [self.repetition("internal force", 2, t, handover=ns) for t, ns in ((3, 40), (5, 180), (5, 190))]
        line = kernels.lines_of([both, alone], machine)[1]
        self.assertEqual((line["gain"], line["gain_of_all"], line["near"], line["runs"]), (2, 1.2, 1, 3))
        self.assertRegex(wishes.text_of(wishes.of_kernels([line])), r"gain of 1.8 .* 0.9 +1 +reached")
        far = kernels.lines_of([both[1:], alone], machine)[1]  # none was near: all count
        self.assertEqual((far["gain"], far["near"]), (1.2, 0))
        self.assertRegex(wishes.text_of(wishes.of_kernels([far])), r"gain of 1.8 .* 1.5 +1 +short")


if __name__ == "__main__":
    unittest.main()
