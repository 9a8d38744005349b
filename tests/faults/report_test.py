"""Tests of the drawing and of the report: the same seed gives the same faults, and a missed bar is a missed bar."""
import unittest

import judge
import plan
import report

BARS = judge.Bars()


def result(number=0, kind="kill", service="tracker", outage_s=0.2, **changes):
    return {"number": number, "group": kind, "text": f"{kind} {service}", "busy_cores": 1.0, "outage_s": outage_s,
            "injections": [{"kind": kind, "arguments": {"service": service}}], "recovered": True,
            "recovered_after_s": 0.5, "lost_states": [], "findings": [], "state": "",
            "false_s": {"available_misaligned": 0.0, "available_silent": 0.0, "misaligned": 0.0,
                        "pipeline_available": 0.0}, **changes}


def missed(results):
    return [bar["bar"] for bar in report.judge(results, BARS) if not bar["passed"]]


class Plan(unittest.TestCase):
    def test_a_fault_depends_on_seed_and_number_alone(self):
        self.assertEqual(plan.draw(7, 3), plan.draw(7, 3))
        self.assertNotEqual([plan.draw(7, k) for k in range(9)], [plan.draw(8, k) for k in range(9)])

    def test_every_kind_is_drawn_and_some_faults_are_two(self):
        faults = [plan.draw(1, number) for number in range(1000)]
        self.assertEqual({fault.injections[0].kind for fault in faults}, set(plan.KINDS))
        self.assertTrue(150 < sum(len(fault.injections) == 2 for fault in faults) < 350)

    def test_only_the_chosen_kinds_are_drawn(self):
        self.assertEqual({plan.draw(1, k, ["hog"]).group() for k in range(20)}, {"hog"})


class Bars(unittest.TestCase):
    def test_all_are_met_by_short_outages_and_true_verdicts(self):
        self.assertEqual(missed([result(k) for k in range(10)]), [])
        self.assertEqual(list(report.failures([result()], BARS)), [])

    def test_each_failure_misses_its_bar_and_is_listed(self):
        false = {**result()["false_s"], "misaligned": 0.1}
        for changes, bar in (({"false_s": false}, "false MISALIGNED"), ({"lost_states": ["x"]}, "lost persisted states"),
                             ({"recovered": False, "recovered_after_s": None}, "not recovered"),
                             ({"findings": ["crash"]}, "crashes, other findings")):
            results = [result(0), result(1, **changes)]
            self.assertEqual(missed(results), [bar])
            self.assertIn("--seed 5 --only 1", report.text(results, BARS, 5, (1.0, 2, 1.5)))

    def test_a_data_path_kill_has_a_shorter_limit(self):
        self.assertEqual(missed([result(outage_s=1.5)]), ["outage p99, data-path kill"])
        self.assertEqual(missed([result(outage_s=1.5, service="health")]), [])
        self.assertEqual(missed([result(outage_s=1.5, kind="kill_roudi")]), [])
        self.assertEqual(missed([result(outage_s=2.5, kind="kill_roudi")]), ["outage p99, all faults", "outage p99, RouDi"])


    def test_times_that_are_not_judged_are_stated(self):
        results = [result(outage_s=9.0), result(1, lost_states=["x"])]
        self.assertEqual([bar["bar"] for bar in report.judge(results, BARS, with_times=False) if not bar["passed"]],
                         ["lost persisted states"])
        self.assertEqual([r["number"] for r, _ in report.failures(results, BARS, with_times=False)], [1])
        text = report.text(results, BARS, 5, (1.0, 2, 1.5), with_times=False)
        self.assertIn("outage p99, all faults: 9.00 s of 2 (limit 2 s on a quiet machine, not judged here)", text)


class Statistics(unittest.TestCase):
    def test_percentiles_are_values_that_occurred(self):
        self.assertEqual(report.percentile([3, 1, 2], 0.5), 2)
        self.assertEqual(report.percentile(list(range(1, 101)), 0.99), 99)
        self.assertEqual(report.percentile(list(range(1, 61)), 0.99), 60)

    def test_the_bound_for_no_failure_is_the_rule_of_three(self):
        self.assertAlmostEqual(report.upper_bound(0, 1000), 3 / 1000, 4)
        self.assertAlmostEqual(report.upper_bound(1, 100), 0.0466, 3)
        self.assertEqual(report.upper_bound(4, 4), 1.0)


if __name__ == "__main__":
    unittest.main()
