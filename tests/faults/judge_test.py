"""Tests of the judge: what counts as false, for how long, and what does not."""
import unittest

import judge
import records as r

S = r.SECOND_NS
TRUTH = judge.Truth({1: 0.0, 2: 0.0436}, (2,))
BARS = judge.Bars()
GOOD = [[1, r.AVAILABLE, r.NORMAL], [2, r.AVAILABLE_REDUCED, r.MISALIGNED]]


def report(at_s, radars, pipeline=r.AVAILABLE, services=(r.ALIVE,)):
    return {"at_ns": int(at_s * S), "topic": "health_report", "overall": r.AVAILABLE_REDUCED, "pipeline": pipeline,
            "radars": radars, "services": list(services)}


def flow(from_s, to_s, topics=("radar_scan", "track_list"), radars=(1, 2)):
    count = int(round((to_s - from_s) / 0.05))
    return [{"at_ns": int((from_s + 0.05 * i) * S), "topic": topic, "radar": radar}
            for i in range(count) for topic in topics for radar in radars]


def sample(at_s, radar, verdict, reason, writer="product"):
    return {"at_ns": int(at_s * S), "topic": "dds_sensor", "radar": radar, "verdict": verdict, "reason": reason,
            "writer": writer}


def ordered(*parts):
    attached = [{"at_ns": 0, "topic": "attached"}]
    return sorted([*attached, *(record for part in parts for record in part)], key=lambda record: record["at_ns"])


def verdicts(records, end_s=10, **window):
    return judge.false_verdicts(records, TRUTH, judge.Window(0, int(end_s * S), **window), BARS, {"stranger"})


class FalseVerdicts(unittest.TestCase):
    def test_none_if_the_truth_is_reported(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        samples = [sample(i, 2, r.AVAILABLE_REDUCED, r.MISALIGNED) for i in range(10)]
        self.assertEqual(set(verdicts(ordered(flow(0, 10), reports, samples)).values()), {0.0})

    def test_a_misaligned_radar_is_falsely_available_until_the_next_report(self):
        false = [[1, r.AVAILABLE, r.NORMAL], [2, r.AVAILABLE, r.NORMAL]]
        records = ordered(flow(0, 10), [report(5, false), report(5.1, GOOD)])
        self.assertAlmostEqual(verdicts(records)["available_misaligned"], 0.1)

    def test_a_verdict_is_no_longer_valid_after_its_deadline(self):
        false = [[2, r.AVAILABLE, r.NORMAL]]
        self.assertAlmostEqual(verdicts(ordered(flow(0, 10), [report(5, false)]))["available_misaligned"], 0.5)

    def test_a_sample_on_dds_counts_but_not_a_strangers(self):
        product = [sample(5, 2, r.AVAILABLE, r.NORMAL), sample(5.2, 2, r.AVAILABLE_REDUCED, r.MISALIGNED)]
        stranger = [sample(7, 2, r.AVAILABLE, r.NORMAL, "stranger")]
        self.assertAlmostEqual(verdicts(ordered(flow(0, 10), product, stranger))["available_misaligned"], 0.2)

    def test_a_silent_radar_is_falsely_available_after_the_time_for_detection(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        silent_from_4_to_6_s = flow(0, 4) + flow(4, 6, radars=(2,)) + flow(6, 10)
        false = verdicts(ordered(silent_from_4_to_6_s, reports))
        self.assertAlmostEqual(false["available_silent"], 1.5, delta=0.15)
        self.assertEqual(false["pipeline_available"], 0.0)

    def test_a_silent_radar_may_be_available_before_that_time(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        records = ordered(flow(0, 4), flow(4, 4.4, radars=(2,)), flow(4.4, 10), reports)
        self.assertEqual(verdicts(records)["available_silent"], 0.0)

    def test_nothing_is_known_of_a_radar_while_the_observer_is_detached(self):
        samples = [sample(0.5 * i, 1, r.AVAILABLE, r.NORMAL) for i in range(20)]
        detached = [{"at_ns": int(4.01 * S), "topic": "detached"}, {"at_ns": int(6 * S), "topic": "attached"}]
        self.assertEqual(verdicts(ordered(flow(0, 4), flow(6, 10), samples, detached))["available_silent"], 0.0)

    def test_what_is_read_in_a_dead_domain_is_no_sign_of_silence(self):
        detached = [{"at_ns": int(4.01 * S), "topic": "detached"}, {"at_ns": int(6 * S), "topic": "attached"}]
        late = [*flow(4.02, 4.2), report(4.1, GOOD), sample(5.5, 1, r.AVAILABLE, r.NORMAL)]
        records = r.of_live_domains([*ordered(flow(0, 4), flow(6, 10), late), *detached])
        self.assertEqual(verdicts(records)["available_silent"], 0.0)
        self.assertEqual([x["topic"] for x in records if 4.01 * S < x["at_ns"] < 6 * S], ["dds_sensor"])

    def test_a_sample_that_was_sent_before_the_silence_is_not_false(self):
        samples = [sample(3.9, 1, r.AVAILABLE, r.NORMAL), sample(4.9, 1, r.AVAILABLE, r.NORMAL),
                   sample(5.4, 1, r.NOT_AVAILABLE, 2)]
        records = ordered(flow(0, 4), flow(4, 6, radars=(2,)), flow(6, 10), samples)
        self.assertAlmostEqual(verdicts(records)["available_silent"], 0.5)

    def test_useless_input_is_silence_after_the_time_for_its_detection(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        useless = ((1 * S, 8 * S, 1),)
        self.assertAlmostEqual(verdicts(ordered(flow(0, 10), reports), useless=useless)["available_silent"], 2.0, delta=0.15)

    def test_a_well_mounted_radar_is_falsely_misaligned(self):
        records = ordered(flow(0, 10), [report(5, [[1, r.AVAILABLE_REDUCED, r.MISALIGNED]]), report(5.1, GOOD)])
        self.assertAlmostEqual(verdicts(records)["misaligned"], 0.1)

    def test_the_pipeline_is_falsely_available_without_track_lists(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        records = ordered(flow(0, 10, topics=("radar_scan",)), flow(0, 4, topics=("track_list",)), reports)
        self.assertGreater(verdicts(records)["pipeline_available"], 5.0)

    def test_the_pipeline_may_be_available_while_no_scans_come(self):
        reports = [report(0.1 * i, GOOD) for i in range(100)]
        self.assertEqual(verdicts(ordered(flow(0, 4), flow(6, 10), reports))["pipeline_available"], 0.0)


class Outage(unittest.TestCase):
    WINDOW = judge.Window(4 * S, 10 * S)

    def test_is_the_longest_time_without_a_track_list(self):
        self.assertAlmostEqual(judge.outage_s(ordered(flow(0, 5), flow(6, 10)), self.WINDOW), 1.05)

    def test_lasts_to_the_end_if_none_comes(self):
        self.assertAlmostEqual(judge.outage_s(ordered(flow(0, 4)), self.WINDOW), 6.05)

    def test_does_not_count_the_time_in_which_the_fault_withholds_the_input(self):
        window = judge.Window(4 * S, 10 * S, excused=((int(4.5 * S), 7 * S),))
        self.assertAlmostEqual(judge.outage_s(ordered(flow(0, 4.5), flow(7.2, 10)), window), 0.25)


class LostAlignment(unittest.TestCase):
    WINDOW = judge.Window(0, 10 * S)

    def estimate(self, yaw_rad, radar=2):
        return [{"at_ns": 5 * S, "topic": "alignment_estimate", "radar": radar, "yaw_rad": yaw_rad}]

    def test_is_an_estimate_far_from_the_truth(self):
        self.assertEqual(judge.lost_alignment(self.estimate(0.0), TRUTH, self.WINDOW, BARS), [2])
        self.assertEqual(judge.lost_alignment(self.estimate(0.042), TRUTH, self.WINDOW, BARS), [])
        self.assertEqual(judge.lost_alignment(self.estimate(0.042, radar=1), TRUTH, self.WINDOW, BARS), [1])


class IsGood(unittest.TestCase):
    def good(self, *reports, radars=(1, 2)):
        return judge.is_good(ordered(flow(0, 5, radars=radars), reports), TRUTH, 5 * S)

    def test_needs_tracks_of_every_radar_the_true_verdicts_and_live_services(self):
        self.assertTrue(self.good(report(4.9, GOOD)))
        self.assertTrue(self.good(report(4.9, GOOD, services=(r.RESTARTED,))))
        self.assertFalse(self.good(report(4.9, GOOD), radars=(1,)))
        self.assertFalse(self.good(report(4.0, GOOD)))
        self.assertFalse(self.good(report(4.9, GOOD, services=(r.SILENT,))))
        self.assertFalse(self.good(report(4.9, GOOD, pipeline=r.NOT_AVAILABLE)))
        self.assertFalse(judge.is_good(ordered(flow(0, 5), [report(4.9, GOOD)]), TRUTH, 5 * S, int(4.95 * S)))
        self.assertFalse(self.good(report(4.9, [[1, r.AVAILABLE, r.NORMAL], [2, r.AVAILABLE, r.NORMAL]])))


if __name__ == "__main__":
    unittest.main()
