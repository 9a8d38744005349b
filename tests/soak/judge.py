"""Judges the samples of a soak run. Pure: samples in, findings out. README.md states what each bar means.

A sample is a dictionary: `t_s`; `processes`: by name the figures PROCESS_FIGURES and `cpu_s`; `shared_memory`: the figures
SHARED_MEMORY_FIGURES; `latency_us`: by stage and quantile, of the lists since the sample before; `counts`: by name, since
the begin of the run."""
import dataclasses
import statistics

import trend

LEAST_SAMPLES = 6  # of the judged part
PROCESS_FIGURES = ("rss_mb", "own_mb", "descriptors", "threads")
SHARED_MEMORY_FIGURES = ("size_mb", "allocated_mb", "files")
QUANTILES = ("p50", "p99")
ROUNDING = 1e-9
# Not shown: the interval is too wide for a statement, as the run is too short or the machine too busy.
MET, MISSED, NOT_SHOWN = "met", "MISSED", "not shown"


@dataclasses.dataclass(frozen=True)
class Bars:
    """Largest growth over the judged part of a run, and largest numbers of events. All are choices but for the zeros."""
    rss_mb: float = 1.0  # pages that are touched for the first time, such as a deeper call; a leak of 100 B a scan is 28 MB
    own_mb: float = 0.5  # of it the memory that no other process or file shares
    descriptors: float = 0.0
    threads: float = 0.0
    size_mb: float = 0.0
    allocated_mb: float = 1.0  # of shared memory: chunks that are used for the first time
    files: float = 0.0
    p50_ratio: float = 0.1  # of the latency at the begin
    p99_ratio: float = 0.3  # the rare long ones depend on the neighbours of the machine
    least_latency_us: float = 50.0  # a growth below this is none, whatever the ratio: the resolution of a short stage
    ends: int = 0  # processes that ended
    lost: int = 0  # scans
    dropped_ratio: float = 0.001  # of the scans
    late_ratio: float = 0.001  # of the track lists, beyond the latency budget


@dataclasses.dataclass(frozen=True)
class Growth:
    what: str
    unit: str
    begin: float  # medians of the first and the last third of the judged part
    end: float
    lower: float  # ends of the 95 % interval of the trend times the duration
    upper: float
    bound: float
    is_counted: bool = True  # exactly; a latency is measured among the noise of the machine

    @property
    def verdict(self):
        """By the trend, and by the medians: a trend does not show a step near the end, medians no slow growth."""
        bound, step = self.bound + ROUNDING, self.end - self.begin
        if self.lower > bound or (self.is_counted and step > bound):
            return MISSED
        return MET if max(self.upper, step) <= bound else NOT_SHOWN

    @property
    def passed(self):
        return self.verdict == MET


@dataclasses.dataclass(frozen=True)
class Number:
    what: str
    value: float
    bound: float

    @property
    def verdict(self):
        return MET if self.value <= self.bound else MISSED

    @property
    def passed(self):
        return self.verdict == MET


def judged_part(samples, warm_up_s):
    return [sample for sample in samples if sample["t_s"] >= warm_up_s]


def growth(what, unit, points, bound, is_counted=True):
    """`points`: (time, value). `bound`: a number, or a function of the value at the begin."""
    times, values = [t for t, _ in points], [v for _, v in points]
    third = max(1, len(values) // 3)
    begin, end = statistics.median(values[:third]), statistics.median(values[-third:])
    of_run = trend.trend_of(times, values)
    duration = times[-1] - times[0]
    return Growth(what, unit, begin, end, of_run.lower * duration, of_run.upper * duration,
                  bound(begin) if callable(bound) else bound, is_counted)


def latency_bound(ratio, least_us):
    return lambda begin: max(ratio * begin, least_us)


def growths(samples, bars):
    """Of the judged part. A process that is absent from a sample has ended, which is a number."""
    found = []
    names = sorted(set.intersection(*(set(sample["processes"]) for sample in samples)))
    for name in names:
        for figure in PROCESS_FIGURES:
            points = [(sample["t_s"], sample["processes"][name][figure]) for sample in samples]
            found.append(growth(f"{name}: {figure}", "", points, getattr(bars, figure)))
    for figure in SHARED_MEMORY_FIGURES:
        points = [(sample["t_s"], sample["shared_memory"][figure]) for sample in samples]
        found.append(growth(f"shared memory: {figure}", "", points, getattr(bars, figure)))
    for stage in samples[0]["latency_us"]:
        for quantile in QUANTILES:
            points = [(sample["t_s"], sample["latency_us"][stage][quantile]) for sample in samples]
            found.append(growth(f"latency, {stage}: {quantile}", "us", points,
                                latency_bound(getattr(bars, f"{quantile}_ratio"), bars.least_latency_us), False))
    return found


def numbers(samples, ends, bars):
    first, last = samples[0]["counts"], samples[-1]["counts"]
    count = {name: last[name] - first[name] for name in last}
    return [Number("processes that ended or began", ends, bars.ends),
            Number("scans lost", count["lost"], bars.lost),
            Number("scans dropped", count["dropped"], bars.dropped_ratio * count["scans"]),
            Number("track lists beyond the latency budget", count["late"], bars.late_ratio * count["track_lists"])]


def is_judgeable(samples, expected_scans):
    """The reason why the samples prove nothing; empty if they do."""
    if len(samples) < LEAST_SAMPLES:
        return f"only {len(samples)} samples after the warm-up, at least {LEAST_SAMPLES} are needed"
    scans = samples[-1]["counts"]["scans"] - samples[0]["counts"]["scans"]
    if scans < 0.95 * expected_scans:
        return f"only {scans} of {expected_scans} scans came"
    return ""
