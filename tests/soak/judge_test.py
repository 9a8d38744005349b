"""Tests of the judge: what is growth, and what is not."""
import random
import unittest

import judge
import trend

BARS = judge.Bars()


def correlated(n, phi, seed):
    draws = random.Random(seed)
    values = [draws.gauss(0, 1)]
    for _ in range(n - 1):
        values.append(phi * values[-1] + draws.gauss(0, 1))
    return values


class TrendTest(unittest.TestCase):
    def test_of_a_constant_is_zero_without_an_interval(self):
        found = trend.trend_of(range(20), [7.0] * 20)
        self.assertEqual((found.slope, found.lower, found.upper), (0.0, 0.0, 0.0))

    def test_of_a_line_is_its_slope(self):
        found = trend.trend_of(range(20), [3.0 + 0.5 * t for t in range(20)])
        self.assertAlmostEqual(found.slope, 0.5)
        self.assertAlmostEqual(found.lower, 0.5)
        self.assertAlmostEqual(found.upper, 0.5)

    def test_is_robust_against_single_values(self):
        values = [0.1 * t for t in range(30)]
        values[10] = values[20] = 1000.0
        self.assertAlmostEqual(trend.trend_of(range(30), values).slope, 0.1, delta=0.02)

    def test_is_the_median_of_the_slopes_between_distant_pairs(self):
        times, values = [1, 2, 3, 4, 5], [10, 22, 21, 30, 26]
        self.assertEqual(trend.distant_pairs(times), [(0, 2), (0, 3), (0, 4), (1, 3), (1, 4), (2, 4)])
        # Slopes 11/2, 20/3, 16/4, 8/2, 4/3, 5/2.
        self.assertAlmostEqual(trend.trend_of(times, values).slope, 4.0)

    def test_variance_of_all_pairs_is_kendalls(self):
        n = 7
        self.assertAlmostEqual(trend.kendall_variance(n, [(i, j) for j in range(n) for i in range(j)]),
                               n * (n - 1) * (2 * n + 5) / 18)

    def test_a_staircase_is_no_steeper_than_twice_its_height(self):
        found = trend.trend_of(range(100), [20.0] * 50 + [20.2] * 50)
        self.assertLessEqual(100 * found.upper, 0.42)

    def test_interval_of_independent_values_covers_the_truth(self):
        self.assertGreaterEqual(self.covered(0.0), 0.92)

    def test_interval_of_correlated_values_covers_the_truth(self):
        self.assertGreaterEqual(self.covered(0.7), 0.88)

    def test_interval_for_independence_would_not(self):
        whole = trend.variance_factor
        trend.variance_factor = lambda residuals: 1.0
        try:
            self.assertLess(self.covered(0.7), 0.75)
        finally:
            trend.variance_factor = whole

    @staticmethod
    def covered(phi, runs=150, n=60):
        """Share of runs without a trend whose interval contains zero."""
        found = [trend.trend_of(range(n), correlated(n, phi, seed)) for seed in range(runs)]
        return sum(t.lower <= 0.0 <= t.upper for t in found) / runs


class GrowthTest(unittest.TestCase):
    def of(self, values, bound):
        return judge.growth("x", "", [(10.0 * i, v) for i, v in enumerate(values)], bound)

    def test_constant_descriptors_do_not_grow(self):
        self.assertTrue(self.of([14] * 30, 0.0).passed)

    def test_one_more_descriptor_is_growth(self):
        self.assertFalse(self.of([14] * 18 + [15] * 12, 0.0).passed)

    def test_a_descriptor_that_is_open_for_a_moment_is_none(self):
        self.assertTrue(self.of([14] * 10 + [15] + [14] * 19, 0.0).passed)

    def test_fewer_descriptors_are_no_growth(self):
        self.assertTrue(self.of([15] * 10 + [14] * 20, 0.0).passed)

    def test_noise_around_a_constant_is_no_growth_beyond_the_bound(self):
        noise = random.Random(1)
        self.assertTrue(self.of([20.0 + noise.gauss(0, 0.1) for _ in range(120)], 1.0).passed)

    def test_a_slow_leak_below_the_noise_is_found(self):
        noise = random.Random(1)
        self.assertFalse(self.of([20.0 + 1.5 * i / 120 + noise.gauss(0, 0.5) for i in range(120)], 1.0).passed)

    def test_noise_too_large_for_a_statement_is_not_passed(self):
        noise = random.Random(1)
        found = self.of([20.0 - 0.1 * i + noise.gauss(0, 5.0) for i in range(12)], 1.0)
        self.assertEqual(found.verdict, judge.NOT_SHOWN)
        self.assertFalse(found.passed)

    def test_a_difference_of_noisy_medians_is_no_proof_of_growth(self):
        noise = random.Random(6)
        points = [(10.0 * i, 100.0 + noise.gauss(0, 20.0)) for i in range(30)]
        found = judge.growth("x", "us", points, 0.5, is_counted=False)
        self.assertGreater(found.end - found.begin, 0.5)
        self.assertEqual(found.verdict, judge.NOT_SHOWN)

    def test_growth_beyond_doubt_is_missed(self):
        self.assertEqual(self.of([20.0 + 0.1 * i for i in range(60)], 1.0).verdict, judge.MISSED)

    def test_a_late_step_counts_whole(self):
        found = self.of([20.0] * 78 + [25.0] * 42, 1.0)
        self.assertAlmostEqual(found.end - found.begin, 5.0)
        self.assertFalse(found.passed)


def sample(t_s, rss_mb=20.0, latency_us=1000.0, lost=0, scans=None, late=0, names=("tracker",)):
    scans = int(160 * t_s) if scans is None else scans
    return {"t_s": t_s, "processes": {name: {"rss_mb": rss_mb, "own_mb": 5.0, "descriptors": 9, "threads": 4, "cpu_s": t_s}
                                         for name in names},
            "shared_memory": {"size_mb": 80.0, "allocated_mb": 80.0, "files": 9},
            "latency_us": {"total": {"p50": latency_us, "p99": 2 * latency_us}},
            "counts": {"scans": scans, "track_lists": scans, "lost": lost, "dropped": 0, "late": late}}


class RunTest(unittest.TestCase):
    def test_of_constant_samples_passes(self):
        samples = [sample(10.0 * i) for i in range(20)]
        self.assertTrue(all(g.passed for g in judge.growths(samples, BARS)))
        self.assertTrue(all(n.passed for n in judge.numbers(samples, 0, BARS)))
        self.assertEqual(judge.is_judgeable(samples, 160 * 190), "")

    def failed(self, samples, ends=0):
        judged = [*judge.growths(samples, BARS), *judge.numbers(samples, ends, BARS)]
        return [found.what for found in judged if not found.passed]

    def test_names_the_process_whose_memory_grows(self):
        self.assertEqual(self.failed([sample(10.0 * i, rss_mb=20 + 0.2 * i) for i in range(20)]), ["tracker: rss_mb"])

    def test_names_the_latency_that_grows_beyond_its_share(self):
        self.assertEqual(self.failed([sample(10.0 * i, latency_us=1000 + 8 * i) for i in range(20)]),
                         ["latency, total: p50"])

    def test_growth_during_the_warm_up_is_not_judged(self):
        samples = [sample(10.0 * i, rss_mb=min(20.0, 10.0 + i)) for i in range(40)]
        self.assertEqual(self.failed(judge.judged_part(samples, 100.0)), [])
        self.assertIn("tracker: rss_mb", self.failed(samples))

    def test_counts_of_the_warm_up_do_not_count_but_later_ones_do(self):
        samples = [sample(10.0 * i, lost=3) for i in range(20)]
        self.assertEqual(self.failed(samples), [])
        self.assertEqual(self.failed([*samples, sample(200.0, lost=4)]), ["scans lost"])

    def test_late_lists_may_be_one_in_a_thousand(self):
        self.assertEqual(self.failed([sample(10.0 * i, late=i) for i in range(20)]), [])
        self.assertEqual(self.failed([sample(10.0 * i, late=2 * i) for i in range(20)]),
                         ["track lists beyond the latency budget"])

    def test_a_process_that_ended_is_a_finding(self):
        self.assertEqual(self.failed([sample(10.0 * i) for i in range(20)], ends=1), ["processes that ended or began"])

    def test_too_few_samples_or_scans_prove_nothing(self):
        self.assertIn("only 3 samples", judge.is_judgeable([sample(10.0 * i) for i in range(3)], 0))
        self.assertIn("scans came", judge.is_judgeable([sample(10.0 * i, scans=0) for i in range(20)], 30_400))
