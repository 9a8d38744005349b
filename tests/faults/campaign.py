"""campaign.py --source DIR --build DIR [--out DIR] [--seed N] [--count N] [--only K] [--kinds A,B]: see README.md.

Runs within namespaces of its own; `run` makes them. Exit code 0 if every bar is met, 1 if not, 3 if the product did not
reach the state from which faults are injected."""
import argparse
import json
import os
import pathlib
import random
import shutil
import sys
import time

import judge
import kinds
import plan
import product as product_module
import records as r
import report
import state

BASELINE_LIMIT_S = 90.0  # the shipped drive shows the misalignment after 15 s
CONTEXT_NS = 3 * r.SECOND_NS  # records kept from before a fault: verdicts and scans that still count
SETTLED_S = 0.3  # for which everything must be good
WATCHED_S = 0.5  # after a fault at least, as some act late
POLL_S = 0.02
FOLDER = pathlib.Path("/tmp/campaign")


def busy_ticks():
    """Ticks of all cores that were not idle since the start of the machine."""
    fields = [int(x) for x in pathlib.Path("/proc/stat").read_text().splitlines()[0].split()[1:9]]
    return sum(fields) - fields[3] - fields[4]


class Load:
    def __init__(self):
        self._begin = (time.monotonic(), busy_ticks())

    def busy_cores(self):
        elapsed_s = time.monotonic() - self._begin[0]
        return (busy_ticks() - self._begin[1]) / os.sysconf("SC_CLK_TCK") / max(elapsed_s, 1e-3)


class Campaign:
    def __init__(self, options):
        self.options = options
        self.product = product_module.Product(options.source, options.build, FOLDER)
        self.truth = self.product.truth()
        self.bars = judge.Bars()
        self.records = []
        self.results = []
        self.judged_until_ns = time.monotonic_ns()
        self.events_seen = 0
        self.lost_radars = []
        self.file = (options.out / "faults.jsonl").open("w")

    def _take(self):
        self.records = r.of_live_domains(self.records + self.product.take_records())

    def wait_until_good(self, limit_s):
        """Time since the call after which everything was good, for SETTLED_S and by records of that time; None after
        the limit."""
        begin_ns = time.monotonic_ns()
        begin = good_since = time.monotonic()
        while time.monotonic() < begin + limit_s:
            self._take()
            if not judge.is_good(self.records, self.truth, time.monotonic_ns(), begin_ns):
                good_since = time.monotonic()
            elif time.monotonic() >= max(good_since + SETTLED_S, begin + WATCHED_S):
                return good_since - begin
            time.sleep(POLL_S)
        return None

    def begin(self):
        """Starts the product; True if it reports the misalignment and has stored it."""
        self.product.start()
        end = time.monotonic() + BASELINE_LIMIT_S
        while time.monotonic() < end:
            if self.wait_until_good(2.0) is not None and not state.losses(self.product):
                self.product.run_for(1.0)
                self._take()
                self.judged_until_ns = time.monotonic_ns()
                self.product.poll()
                self.events_seen = len(self.product.events)
                return True
        return False

    def _inject(self, fault):
        """Runs the fault's timeline. Returns findings, excused intervals, and those of useless input."""
        findings, excused, useless, running = [], [], [], []
        begin = time.monotonic()
        steps = [(injection.at_s, 0, injection) for injection in fault.injections]
        while steps or running:
            due = steps + [(i.at_s + i.duration_s, 1, (i, lasting, at_ns)) for i, lasting, at_ns in running]
            at_s, is_end, what = min(due, key=lambda step: step[:2])
            self.product.run_for(max(0.0, begin + at_s - time.monotonic()))
            if not is_end:
                steps = [step for step in steps if step[2] is not what]
                at_ns = time.monotonic_ns()
                lasting = kinds.FUNCTIONS[what.kind](self.product, **what.arguments)
                if lasting:
                    running.append((what, lasting, at_ns))
                continue
            running = [entry for entry in running if entry[0] is not what[0]]
            _, lasting, at_ns = what
            findings += lasting.end()
            if lasting.is_excused:
                excused.append((at_ns, time.monotonic_ns()))
            if lasting.useless_radar:
                useless.append((at_ns, time.monotonic_ns(), lasting.useless_radar))
        return findings, excused, useless

    def _crashes(self):
        """Processes that ended by themselves: by a signal that neither the campaign nor the supervisor's watchdog sent,
        or with an exit code that is neither 0 nor a refused configuration. Also those that the watchdog ended without
        a reason."""
        events = self.product.events[self.events_seen:]
        self.events_seen = len(self.product.events)
        hung = {pid for _, what, _, pid, _ in self.product.events if what == "hung"}
        ends_with_domain = any(what == "domain restart" or process == "roudi" and what == "exited"
                               for _, what, process, _, _ in events)
        for _, what, process, pid, detail in events:
            if what == "hung" and pid not in self.product.signalled and not ends_with_domain:
                yield f"{process} was ended although nothing had stopped it: {detail}"
            if what != "exited" or pid in self.product.signalled or pid in hung:
                continue
            by_fatal_signal = any(f"signal {number} " in detail for number in (4, 6, 7, 8, 11))
            if by_fatal_signal or not ends_with_domain and detail not in ("exit code 0", "exit code 2"):
                yield f"{process} ended by itself: {detail}"
        if not self.product.reader.is_running():
            yield f"the diagnosis tool ended: {self.product.reader.process.returncode}"
        if not self.product.dds_observer.is_running():
            yield f"the DDS observer ended: {self.product.dds_observer.process.returncode}"

    def run_fault(self, fault):
        for injection in fault.injections:
            if injection.kind in kinds.PREPARATIONS:
                kinds.PREPARATIONS[injection.kind](self.product, **injection.arguments)
        self.product.run_for(fault.pause_s)
        self._take()
        load = Load()
        begin_ns = time.monotonic_ns()
        findings, excused, useless = self._inject(fault)
        good_after_s = self.wait_until_good(self.bars.recovery_s)
        self._take()
        end_ns = time.monotonic_ns()
        window = judge.Window(begin_ns, end_ns, tuple(excused), tuple(useless))
        # Verdicts are judged without a gap between two faults.
        verdicts = judge.Window(self.judged_until_ns, end_ns, tuple(excused), tuple(useless))
        self.judged_until_ns = end_ns
        lost = state.losses(self.product)
        lost_radars = judge.lost_alignment(self.records, self.truth, window, self.bars)
        lost += [f"alignment of radar {radar}" for radar in lost_radars if radar not in self.lost_radars]  # each loss once
        self.lost_radars = lost_radars
        result = {
            "seed": self.options.seed, "number": fault.number, "group": fault.group(), "text": fault.text(),
            "injections": [vars(injection) for injection in fault.injections],
            "busy_cores": round(load.busy_cores(), 2), "recovered": good_after_s is not None,
            "recovered_after_s": good_after_s and round(good_after_s, 3),
            "outage_s": judge.outage_s(self.records, window),
            "false_s": judge.false_verdicts(self.records, self.truth, verdicts, self.bars, self.product.strangers),
            "lost_states": lost, "findings": findings + list(self._crashes()),
            "yaw_rad": judge.last_estimates(self.records),
            "state": "" if good_after_s is not None else self._state(),
        }
        self.results.append(result)
        self.file.write(json.dumps(result) + "\n")
        self.file.flush()
        wrong = [text for _, texts in report.failures([result], self.bars, self.options.times) for text in texts]
        print(f"{fault.number:>5}  {fault.text()}: outage {result['outage_s']:.2f} s, restored "
              f"{result['recovered_after_s']} s{''.join('; ' + text for text in wrong)}", flush=True)
        if wrong:
            self._keep(fault, begin_ns)
        self.records = [record for record in self.records if record["at_ns"] > end_ns - CONTEXT_NS]
        return result

    def _state(self):
        reports = r.of(self.records, "health_report")
        return f"last report {json.dumps(reports[-1]) if reports else 'none'}; processes {self.product.pids}"

    def _keep(self, fault, begin_ns):
        """Records, events and the ends of the logs of a fault with findings."""
        folder = self.options.out / f"fault_{fault.number}"
        folder.mkdir(exist_ok=True)
        with (folder / "records.jsonl").open("w") as file:
            file.writelines(json.dumps(record) + "\n" for record in self.records)
        with (folder / "events.txt").open("w") as file:
            file.writelines(f"{(at_ns - begin_ns) / r.SECOND_NS:.3f} {what} {process} {pid} {detail}\n"
                            for at_ns, what, process, pid, detail in self.product.events[-100:])
        for log in self.product.logs.glob("*.log"):
            (folder / log.name).write_bytes(log.read_bytes()[-20_000:])

    def restart(self):
        """After a fault that was not recovered from: as an operator who restarts everything, and who deletes the stored
        states if that does not help. True if one of the two helped."""
        for is_last in (False, True):
            self.product.cut_power()
            for path in pathlib.Path("/dev/shm").iterdir():
                path.unlink()
            if is_last:
                for path in self.product.state.iterdir():
                    path.unlink()
            self.product.start_supervisor()
            if self.wait_until_good(BASELINE_LIMIT_S if is_last else self.bars.recovery_s) is not None:
                break
        else:
            return False
        self.product.run_until(lambda: not state.losses(self.product), BASELINE_LIMIT_S)
        self.records = []
        self.judged_until_ns = time.monotonic_ns()
        list(self._crashes())
        return True

    def run(self, numbers):
        load = Load()
        chosen = self.options.kinds.split(",") if self.options.kinds else None
        for number in numbers:
            result = self.run_fault(plan.draw(self.options.seed, number, chosen))
            if not result["recovered"] and not self.restart():
                print("neither a restart nor deleting the stored states helps: the campaign ends here", flush=True)
                break
        text = report.text(self.results, self.bars, self.options.seed,
                           (load.busy_cores(), os.cpu_count(), os.getloadavg()[1]), self.options.times)
        (self.options.out / "report.txt").write_text(text + "\n")
        print("\n" + text, flush=True)
        exit_code = self.product.stop()
        if exit_code != 0:
            print(f"the supervisor ended with exit code {exit_code}")
        return exit_code == 0 and all(bar["passed"] for bar in report.judge(self.results, self.bars, self.options.times))


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="tests/run faults", description="Injects faults drawn from a seed and judges them.")
    parser.add_argument("--source", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--build", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--out", type=pathlib.Path, help="folder for the results; default: faults in the build folder")
    parser.add_argument("--seed", type=int, help="of the draws; default: another one each time, which is printed")
    parser.add_argument("--count", type=int, default=60, help="number of faults (%(default)s)")
    parser.add_argument("--first", type=int, default=0, help="number of the first fault (%(default)s)")
    parser.add_argument("--only", type=int, help="injects this fault of the seed alone")
    parser.add_argument("--kinds", help="draws only these kinds, separated by commas: other faults than without")
    parser.add_argument("--no-times", dest="times", action="store_false",
                        help="states the bars of outages without judging them: for a machine that is not quiet")
    options = parser.parse_args(arguments)
    unknown = set((options.kinds or "").split(",")) - {"", *plan.KINDS}
    if unknown:
        parser.error(f"unknown kinds {', '.join(sorted(unknown))}; known: {', '.join(plan.KINDS)}")
    if options.seed is None:
        options.seed = random.SystemRandom().randrange(1_000_000)
    options.out = (options.out or options.build / "faults").absolute()
    return options


def main():
    options = options_of(sys.argv[1:])
    options.out.mkdir(parents=True, exist_ok=True)
    for folder in options.out.glob("fault_*"):  # of an earlier campaign
        shutil.rmtree(folder)
    FOLDER.mkdir()
    campaign = Campaign(options)
    print(f"seed {options.seed}; misaligned {campaign.truth.misaligned}; results in {options.out}", flush=True)
    if not campaign.begin():
        print(f"the product did not reach its normal state: {campaign._state()}\n{state.losses(campaign.product)}")
        campaign.product.stop()
        return 3
    numbers = [options.only] if options.only is not None else range(options.first, options.first + options.count)
    return 0 if campaign.run(numbers) else 1


if __name__ == "__main__":
    sys.exit(main())
