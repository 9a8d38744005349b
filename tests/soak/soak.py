"""soak.py --source DIR --build DIR [--minutes N] [--period S] [--warm-up S] [--out DIR]: see README.md.

Runs on a machine of its own; `run` makes it. Exit code 0 if every bar is met, 1 if one is not, 3 if the run proves
nothing: the product did not start, or scans did not come."""
import argparse
import csv
import dataclasses
import json
import os
import pathlib
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "system" / "harness"))
import judge  # noqa: E402
import report  # noqa: E402
import sampler  # noqa: E402
from supervised import Output, Supervised, run_checked  # noqa: E402

FOLDER = pathlib.Path("/tmp/soak")
DDS_DOMAIN = 80
VEHICLE = "bench"
RECORDING_S = 28  # choice: after it, the vehicles of both directions are where they were, and it takes 160 MB
SCANS_PER_S = 8 * 20
START_LIMIT_S = 60.0
LONGEST_PERIOD_S = 10.0
SAMPLES = 60  # of a short run (choice: an interval needs some tens)
LONGEST_WARM_UP_S = 300.0  # choice: the estimator's windows and the levels of the radars are learnt
WARM_UP_SHARE = 0.25  # of a shorter run


class Soak(Supervised):
    def __init__(self, source, build):
        super().__init__(build, FOLDER, VEHICLE, DDS_DOMAIN)
        for folder in (self.state, self.logs):
            folder.mkdir()
        run_checked([self.bin / "soak" / "load", source / "config", FOLDER, str(RECORDING_S)])
        run_checked([self.bin / "boresight", "simulate", "--config", source / "config", "--scenario", "straight_rail",
                     "--vehicle", "demo", "--duration", str(RECORDING_S), "--out", FOLDER / "ego"])
        self.monitor = sampler.Monitor()
        self.tools = []

    def start(self):
        """False if no track lists come."""
        self.start_supervisor()
        self.screen = Output([self.bin / "boresight", "monitor", "--json", "--config", self.config, "--vehicle", VEHICLE],
                             self.environment, self.errors)
        self.tools = [self.screen, self.diagnosed(), self.played([FOLDER / "radars.pcap", FOLDER / "ego" / "ego.candump.log"])]
        end = time.monotonic() + START_LIMIT_S
        while time.monotonic() < end:
            time.sleep(0.5)
            self.monitor.read(self.screen.take())
            if self.monitor.snapshot and self.monitor.snapshot["track_lists"] > SCANS_PER_S:
                self.monitor.latency_us()
                return True
        return False

    def sample(self, begin):
        self.monitor.read(self.screen.take())
        for tool in self.tools[1:]:
            tool.take()
        self.take_events()
        figures, pids = sampler.processes()
        return {"t_s": time.monotonic() - begin, "processes": figures, "pids": pids,
                "shared_memory": sampler.shared_memory(), "latency_us": self.monitor.latency_us(),
                "counts": self.monitor.counts(), "load_average": os.getloadavg()[0]}

    def run_for(self, seconds, period_s):
        samples, begin = [], time.monotonic()
        for k in range(1, int(seconds / period_s) + 1):
            time.sleep(max(0.0, begin + k * period_s - time.monotonic()))
            samples.append(self.sample(begin))
            last = samples[-1]
            print(f"{last['t_s']:7.0f} s: {last['counts']['track_lists']} track lists, total latency p50 "
                  f"{last['latency_us']['total']['p50']:.0f} us, p99 {last['latency_us']['total']['p99']:.0f} us", flush=True)
        return samples

    def stop(self):
        codes = [tool.end(patience_s=3) for tool in self.tools]
        return [*codes, self.supervisor.end()]


def changed_processes(samples):
    """Number of processes that ended or began between two samples."""
    return sum(len(set(a["pids"].items()) ^ set(b["pids"].items())) for a, b in zip(samples, samples[1:]))


def write_samples(samples, folder):
    """samples.jsonl with everything, and samples.csv: one row a sample and figure."""
    with (folder / "samples.jsonl").open("w") as file:
        file.writelines(json.dumps(sample) + "\n" for sample in samples)
    with (folder / "samples.csv").open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["t_s", "group", "name", "figure", "value"])
        for sample in samples:
            for group in ("processes", "latency_us"):
                for name, figures in sample[group].items():
                    rows.writerows([round(sample["t_s"], 3), group, name, figure, value] for figure, value in figures.items())
            for group in ("shared_memory", "counts"):
                rows.writerows([round(sample["t_s"], 3), group, "", figure, value] for figure, value in sample[group].items())


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="tests/run soak", description="Runs the product under full load and judges its trends.")
    parser.add_argument("--source", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--build", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--minutes", type=float, default=30.0, help="length of the run (%(default)s)")
    parser.add_argument("--period", type=float, metavar="S",
                        help=f"between two samples; default: {LONGEST_PERIOD_S:.0f}, less for a short run")
    parser.add_argument("--warm-up", type=float, metavar="S",
                        help=f"not judged; default: a quarter of the run, at most {LONGEST_WARM_UP_S:.0f}")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the results; default: soak in the build folder")
    options = parser.parse_args(arguments)
    options.out = (options.out or options.build / "soak").absolute()
    if options.period is None:
        options.period = min(LONGEST_PERIOD_S, 60 * options.minutes / SAMPLES)
    if options.warm_up is None:
        options.warm_up = min(LONGEST_WARM_UP_S, WARM_UP_SHARE * 60 * options.minutes)
    if options.period <= 0 or (60 * options.minutes - options.warm_up) / options.period < judge.LEAST_SAMPLES:
        parser.error(f"fewer than {judge.LEAST_SAMPLES} samples would be judged: a longer run or a shorter period is needed")
    return options


def main():
    options = options_of(sys.argv[1:])
    options.out.mkdir(parents=True, exist_ok=True)
    FOLDER.mkdir()
    soak = Soak(options.source, options.build)
    if not soak.start():
        print(f"no track lists within {START_LIMIT_S:.0f} s; processes {soak.pids}")
        soak.stop()
        for log in [FOLDER / "errors.txt", *soak.logs.glob("*.log")]:
            (options.out / log.name).write_bytes(log.read_bytes()[-20_000:])
        return 3
    samples = soak.run_for(60 * options.minutes, options.period)
    write_samples(samples, options.out)
    for log in soak.logs.glob("*.log"):
        (options.out / log.name).write_bytes(log.read_bytes()[-20_000:])
    codes = soak.stop()
    judged = judge.judged_part(samples, options.warm_up)
    problem = judge.is_judgeable(judged, SCANS_PER_S * (judged[-1]["t_s"] - judged[0]["t_s"]) if judged else 0)
    if problem:
        print(f"the run proves nothing: {problem}")
        return 3
    bars = judge.Bars()
    growths = judge.growths(judged, bars)
    numbers = judge.numbers(judged, changed_processes(judged), bars)
    text = report.text(growths, numbers, judged)
    loads = [sample["load_average"] for sample in judged]
    text += (f"\n{options.minutes:g} minutes, the first {options.warm_up:.0f} s not judged; {len(judged)} samples; {os.cpu_count()} "
             f"cores, load average {min(loads):.1f} … {max(loads):.1f}")
    print("\n" + text, flush=True)
    (options.out / "report.txt").write_text(text + "\n")
    passed = all(found.passed for found in [*growths, *numbers])
    result = {"passed": passed, "minutes": options.minutes, "warm_up_s": options.warm_up, "exit_codes": codes,
              "findings": [{**dataclasses.asdict(found), "passed": found.passed} for found in [*growths, *numbers]]}
    (options.out / "result.json").write_text(json.dumps(result, indent=1) + "\n")
    if any(codes):
        print(f"a process did not end in order: exit codes {codes}")
    return 0 if passed and not any(codes) else 1


if __name__ == "__main__":
    sys.exit(main())
