"""Records of the observers as the judge reads them. Pure: lists of dictionaries in, intervals and gaps out.

A record has `at_ns` (CLOCK_MONOTONIC), `topic`, and the fields that the observers print. The observer in shared memory
prints `attached` when it begins; the campaign adds `detached` when it ends it."""

SECOND_NS = 1_000_000_000

# As in interfaces/messages/health_report.hpp.
AVAILABLE, AVAILABLE_REDUCED, NOT_AVAILABLE = 0, 1, 2
NORMAL, MISALIGNED = 0, 1
ALIVE, DEGRADED, SILENT, RESTARTED = 1, 2, 3, 4


def of(records, *topics):
    return [record for record in records if record["topic"] in topics]


def of_live_domains(records):
    """In the order of time, without what the observer in shared memory read between `detached` and `attached`: no user
    of the product sees what a process writes there into the memory of a dead domain."""
    kept, is_attached = [], True
    for record in sorted(records, key=lambda record: record["at_ns"]):
        if record["topic"] in ("attached", "detached"):
            is_attached = record["topic"] == "attached"
        elif not is_attached and not record["topic"].startswith("dds_"):
            continue
        kept.append(record)
    return kept


def valid_until(reports, validity_ns):
    """(report, begin, end) of each: it holds until the next one comes, but no longer than its validity."""
    for report, after in zip(reports, [*reports[1:], None]):
        end = report["at_ns"] + validity_ns
        yield report, report["at_ns"], end if after is None else min(end, after["at_ns"])


def silences(records, topic, limit_ns, until_ns, radar=None):
    """Intervals (begin, end) in which `topic` has not come for longer than `limit_ns`, while the observer was attached.
    `radar`: of this radar only."""
    found = []
    last_ns = None  # unknown: not attached
    for record in [*records, {"at_ns": until_ns, "topic": "detached"}]:
        is_wanted = record["topic"] == topic and (radar is None or record["radar"] == radar)
        if not is_wanted and record["topic"] not in ("attached", "detached"):
            continue
        if last_ns is not None and record["at_ns"] > last_ns + limit_ns:
            found.append((last_ns + limit_ns, record["at_ns"]))
        last_ns = None if record["topic"] == "detached" else record["at_ns"]
    return found


def overlap_ns(begin_ns, end_ns, intervals):
    return sum(max(0, min(end_ns, end) - max(begin_ns, begin)) for begin, end in intervals)


def longest_gap_ns(times_ns, from_ns, until_ns, excused):
    """Longest time without a record between `from_ns` and `until_ns`, less the excused part of each gap. A gap begins
    with the last record before `from_ns`."""
    before = [at for at in times_ns if at <= from_ns]
    marks = [before[-1] if before else from_ns, *[at for at in times_ns if from_ns < at <= until_ns], until_ns]
    return max(end - begin - overlap_ns(begin, end, excused) for begin, end in zip(marks, marks[1:]))
