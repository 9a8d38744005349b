"""What the kernel knows of the product's processes and of its shared memory, and what its monitor counts."""
import json
import os
import pathlib

TICKS_PER_S = os.sysconf("SC_CLK_TCK")
MEGABYTE = 1e6
BUCKETS_PER_DECADE = 20  # of the latency histogram: services/common/estimation/latency_histogram.hpp
LATENCY_BUDGET_US = 50_000  # pipeline.latency_budget_s of health.toml


def name_of(arguments):
    """Of a process of the product; empty for others. `boresight` has several commands."""
    name = pathlib.Path(arguments[0]).name
    if name == "boresight":
        return f"boresight {arguments[1]}" if len(arguments) > 1 else name
    return name if name.startswith("boresight-") or name == "iox-roudi" else ""


def named_processes():
    """Process number by name. The guardian of the supervisor has the same command line, and a larger number."""
    found = {}
    for pid in sorted(int(entry.name) for entry in pathlib.Path("/proc").iterdir() if entry.name.isdigit()):
        try:
            arguments = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        name = name_of(arguments)
        if name:
            found[f"{name}, guardian" if name in found else name] = pid
    return found


def figures_of(pid):
    """Resident memory by the page tables, as the kernel's own counters are off by some pages for each core."""
    folder = pathlib.Path(f"/proc/{pid}")
    kilobytes = {}
    for line in (folder / "smaps_rollup").read_text().splitlines()[1:]:
        name, value = line.split(":")
        kilobytes[name] = int(value.split()[0])
    fields = (folder / "stat").read_text().rpartition(")")[2].split()  # from the third field on
    return {"rss_mb": kilobytes["Rss"] * 1024 / MEGABYTE, "own_mb": kilobytes["Anonymous"] * 1024 / MEGABYTE,
            "descriptors": len(os.listdir(folder / "fd")), "threads": int(fields[17]),
            "cpu_s": (int(fields[11]) + int(fields[12])) / TICKS_PER_S}


def processes():
    """Figures by name, and the process numbers by name. A process that ends meanwhile is absent."""
    figures, pids = {}, {}
    for name, pid in named_processes().items():
        try:
            figures[name] = figures_of(pid)
            pids[name] = pid
        except (OSError, KeyError, ValueError):
            continue
    return figures, pids


def shared_memory():
    files = [entry.stat() for entry in pathlib.Path("/dev/shm").iterdir()]
    return {"files": len(files), "size_mb": sum(f.st_size for f in files) / MEGABYTE,
            "allocated_mb": sum(f.st_blocks * 512 for f in files) / MEGABYTE}


def quantile_us(counts, share):
    """Of a histogram {bucket: number}, with the lists of a bucket spread evenly over its logarithm."""
    wanted, seen = share * sum(counts.values()), 0
    for bucket in sorted(counts):
        if counts[bucket] and seen + counts[bucket] >= wanted:
            return 10 ** ((bucket + (wanted - seen) / counts[bucket]) / BUCKETS_PER_DECADE)
        seen += counts[bucket]
    return 0.0


def of_edge(us):
    """The first bucket whose durations are all at least this long, within a bucket's width of 12 %."""
    return next(bucket for bucket in range(200) if 10 ** (bucket / BUCKETS_PER_DECADE) >= us)


class Monitor:
    """Reads lines of `boresight monitor --json`. Counts are since the begin of the monitor."""

    def __init__(self):
        self.snapshot = None
        self._buckets = {}

    def read(self, lines):
        for line in reversed(lines):
            try:
                self.snapshot = json.loads(line)
                return
            except ValueError:
                continue  # the last line may be cut

    def counts(self):
        faults = [service["faults"] for service in self.snapshot["services"]]
        total = dict(self.snapshot["latency_us"]["total"]["buckets"])
        return {"scans": sum(radar["scans"] for radar in self.snapshot["radars"]),
                "track_lists": self.snapshot["track_lists"],
                "lost": sum(f.get("input lost", 0) for f in faults), "dropped": sum(f.get("input dropped", 0) for f in faults),
                "late": sum(n for bucket, n in total.items() if bucket >= of_edge(LATENCY_BUDGET_US)),
                "restarts": sum(service["restarts"] for service in self.snapshot["services"])}

    def latency_us(self):
        """p50 and p99 of each stage, of the track lists since the last call."""
        found = {}
        for stage, histogram in self.snapshot["latency_us"].items():
            now = {bucket: count for bucket, count in histogram["buckets"]}
            before = self._buckets.get(stage, {})
            counts = {bucket: count - before.get(bucket, 0) for bucket, count in now.items()}
            self._buckets[stage] = now
            found[stage] = {"p50": quantile_us(counts, 0.5), "p99": quantile_us(counts, 0.99)}
        return found
