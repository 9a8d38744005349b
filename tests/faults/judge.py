"""Judges one fault by the observers' records. Pure.

Bars are in `Bars`; README.md states what each figure means."""
import dataclasses

import records as r


@dataclasses.dataclass(frozen=True)
class Bars:
    """Limits of a campaign, with their origin. s."""
    report_validity_s: float = 0.5  # deadline of health_report in the catalogue
    sample_validity_s: float = 2.0  # of a sample on DDS: two of its periods
    detection_s: float = 0.5  # from the last scan or track list to the verdict: README of health, Pipeline
    bad_input_s: float = 5.0  # from the begin of useless input to the verdict: the 2 to 5 s
    yaw_error_rad: float = 0.0131  # 0.75°, half of the tolerance: an estimate farther from the truth is lost (choice)
    recovery_s: float = 30.0  # choice: the longest delay between two starts is 5 s
    outage_p99_s: float = 2.0
    data_path_kill_p99_s: float = 1.0
    roudi_s: float = 2.0


@dataclasses.dataclass(frozen=True)
class Truth:
    yaw_rad: dict  # of every radar: actual minus nominal
    misaligned: tuple  # radars beyond their tolerance

    @property
    def radars(self):
        return sorted(self.yaw_rad)

    @property
    def well_mounted(self):
        return [radar for radar in self.radars if radar not in self.misaligned]


@dataclasses.dataclass(frozen=True)
class Window:
    """Time of one fault, ns. Records before `begin_ns` are context. `excused`: intervals in which the fault itself
    withholds the input or leaves no service that could work; `useless`: (begin, end, radar) of useless input."""
    begin_ns: int
    end_ns: int
    excused: tuple = ()
    useless: tuple = ()


def _clipped_ns(window, begin_ns, end_ns):
    return max(0, min(end_ns, window.end_ns) - max(begin_ns, window.begin_ns))


def _seconds(ns):
    return round(ns / r.SECOND_NS, 3)


def _reports(records, bars):
    validity_ns = int(bars.report_validity_s * r.SECOND_NS)
    return r.valid_until(r.of(records, "health_report", "detached"), validity_ns)


def _verdicts(records, bars, strangers):
    """(radar, verdict, reason, begin, end) in shared memory and on DDS."""
    for report, begin, end in _reports(records, bars):
        for radar, verdict, reason in report.get("radars", ()):
            yield radar, verdict, reason, begin, end
    validity_ns = int(bars.sample_validity_s * r.SECOND_NS)
    samples = [s for s in r.of(records, "dds_sensor") if s["writer"] not in strangers]
    for radar in {s["radar"] for s in samples}:
        of_radar = [s for s in samples if s["radar"] == radar]
        for sample, begin, end in r.valid_until(of_radar, validity_ns):
            yield radar, sample["verdict"], sample["reason"], begin, end


def _is_within(at_ns, intervals):
    return any(begin < at_ns < end for begin, end in intervals)


def _lists_withheld(records, limit_ns, until_ns):
    """Intervals in which scans come, and have come for longer than `limit_ns`, without any track list."""
    scans_ns = [record["at_ns"] for record in r.of(records, "radar_scan")]
    for begin, end in r.silences(records, "track_list", 0, until_ns):
        unanswered = [at for at in scans_ns if begin < at < end]
        if unanswered and unanswered[0] + limit_ns < unanswered[-1]:
            yield unanswered[0] + limit_ns, unanswered[-1]


def false_verdicts(records, truth, window, bars, strangers=()):
    """Seconds, by what is false. A verdict that was false when it was published counts until the next one, or until it
    is no longer valid."""
    detection_ns = int(bars.detection_s * r.SECOND_NS)
    bad_input_ns = int(bars.bad_input_s * r.SECOND_NS)
    silent = {radar: r.silences(records, "radar_scan", detection_ns, window.end_ns, radar) for radar in truth.radars}
    for begin, end, radar in window.useless:
        silent[radar] = [*silent[radar], (begin + bad_input_ns, end)]
    ns = {"available_misaligned": 0, "available_silent": 0, "misaligned": 0, "pipeline_available": 0}
    for radar, verdict, reason, begin, end in _verdicts(records, bars, strangers):
        held_ns = _clipped_ns(window, begin, end)
        if radar in truth.misaligned and verdict == r.AVAILABLE:
            ns["available_misaligned"] += held_ns
        elif radar in silent and verdict == r.AVAILABLE and _is_within(begin, silent[radar]):
            ns["available_silent"] += held_ns
        if radar in truth.well_mounted and reason == r.MISALIGNED:
            ns["misaligned"] += held_ns
    no_tracks = list(_lists_withheld(records, detection_ns, window.end_ns))
    for report, begin, end in _reports(records, bars):
        if r.AVAILABLE in (report.get("pipeline"), report.get("overall")) and _is_within(begin, no_tracks):
            ns["pipeline_available"] += _clipped_ns(window, begin, end)
    return {name: _seconds(value) for name, value in ns.items()}


def outage_s(records, window):
    """Longest time without any track list, less the excused parts."""
    times = [record["at_ns"] for record in r.of(records, "track_list")]
    return _seconds(r.longest_gap_ns(times, window.begin_ns, window.end_ns, window.excused))


def lost_alignment(records, truth, window, bars):
    """Radars with an estimate that is not the stored one."""
    return sorted({e["radar"] for e in r.of(records, "alignment_estimate")
                   if window.begin_ns < e["at_ns"] <= window.end_ns
                   and abs(e["yaw_rad"] - truth.yaw_rad[e["radar"]]) > bars.yaw_error_rad})


def last_estimates(records):
    """Yaw and its standard deviation of each radar, rad."""
    return {e["radar"]: (e["yaw_rad"], e["yaw_std_rad"]) for e in r.of(records, "alignment_estimate")}


def is_good(records, truth, now_ns, not_before_ns=0, within_s=0.4):
    """Whether the product works as before any fault: every radar has track lists, and health reports the truth. Only
    records of the last `within_s` count, and none before `not_before_ns`."""
    since_ns = max(not_before_ns, now_ns - int(within_s * r.SECOND_NS))
    last_report = None
    tracked = set()
    for record in reversed(records):
        if record["at_ns"] < since_ns:
            break
        if record["topic"] == "track_list":
            tracked.add(record["radar"])
        elif record["topic"] == "health_report" and last_report is None:
            last_report = record
    if last_report is None or tracked < set(truth.radars):
        return False
    wanted = {radar: (r.AVAILABLE, r.NORMAL) for radar in truth.well_mounted}
    wanted |= {radar: (r.AVAILABLE_REDUCED, r.MISALIGNED) for radar in truth.misaligned}
    reported = {radar: (verdict, reason) for radar, verdict, reason in last_report["radars"]}
    return (reported == wanted and last_report["pipeline"] == r.AVAILABLE
            and all(condition in (r.ALIVE, r.RESTARTED) for condition in last_report["services"]))
