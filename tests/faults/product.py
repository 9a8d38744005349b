"""The product as a user starts it (`boresight supervise`), its input, and the observers: processes and files.

Everything lies in FOLDER, within namespaces that belong to the campaign alone."""
import csv
import json
import os
import pathlib
import re
import shutil
import signal
import sys
import time
import tomllib

import judge
import records as r

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "system" / "harness"))
from supervised import Output, Supervised, run_checked  # noqa: E402

DDS_DOMAIN = 79
STATE_SIZE, LOGS_SIZE = "256k", "16m"  # of the file systems that faults fill
STATE_WRITING_PERIOD_S = 1.0  # of the alignment memory, so that kills hit its writing
DRIVE_S = 37  # period of the speed of the shipped drive: the loop has no step of speed


class Product(Supervised):
    def __init__(self, source, build, folder):
        super().__init__(build, folder, "demo", DDS_DOMAIN)
        self.source = source
        self.drive = folder / "drive"
        self.wall_clock = folder / "wall_clock"
        self.records = []  # of the observers, not yet taken
        self.signalled = set()  # processes that the campaign itself ended
        self.strangers = set()  # GUIDs of writers
        self.input = self.bus_observer = self.dds_observer = self.reader = None
        self.is_input_held = False
        self.recording = self.drive / "radars.pcap"
        self._prepare()

    def _prepare(self):
        shutil.copytree(self.source / "config", self.config)
        for folder, size in ((self.state, STATE_SIZE), (self.logs, LOGS_SIZE)):
            folder.mkdir()
            run_checked(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder])
        estimator = self.config / "services" / "alignment_estimator.toml"
        text, count = re.subn(r"^period_s = 30\.0", f"period_s = {STATE_WRITING_PERIOD_S}", estimator.read_text(),
                              flags=re.M)
        assert count == 1, "alignment_estimator.toml has another memory.period_s"
        estimator.write_text(text)
        self.step_wall_clock(0)
        self.stepped = {**self.environment, "BORESIGHT_TEST_WALL_CLOCK": str(self.wall_clock),
                        "LD_PRELOAD": str(next(self.bin.parent.glob("tests/system/clock_step/*wall_clock.so")))}
        run_checked([self.bin / "boresight", "simulate", "--scenario", "demo_drive", "--config", self.config,
                     "--duration", str(DRIVE_S), "--out", self.drive])

    def truth(self):
        """Radars beyond their tolerance and well-mounted ones, by the drive's truth and the vehicle file."""
        with (self.drive / "truth.csv").open() as file:
            angle_rad = {(row["quantity"], int(row["radar"])): float(row["value"]) * 0.017453292519943295
                         for row in csv.DictReader(file) if row["quantity"].startswith("alignment_")}
        radars = tomllib.loads(self.vehicle.read_text())["radar"]
        self.senders = {radar["id"]: radar["source"]["sender"] for radar in radars}
        misaligned = []
        for radar in radars:
            for axis in ("yaw", "pitch", "roll"):
                error_rad = angle_rad.get((f"alignment_{axis}", radar["id"]), 0.0)
                if abs(error_rad) > radar["tolerance"][f"{axis}_deg"] * 0.017453292519943295:
                    misaligned.append(radar["id"])
        return judge.Truth({radar["id"]: angle_rad[("alignment_yaw", radar["id"])] for radar in radars}, tuple(misaligned))

    # Processes

    def start(self):
        self.start_supervisor()
        self.start_input()
        observers = self.bin / "faults"
        self.dds_observer = Output([observers / "dds_observer", str(DDS_DOMAIN)], self.environment, self.errors)
        # A diagnosis tool of the product, which must survive everything that a stranger sends.
        self.reader = self.diagnosed()

    def start_supervisor(self):
        super().start_supervisor(self.stepped)

    def start_input(self):
        self.input = self.played([self.recording, self.drive / "ego.candump.log"])

    def _stop_bus_observer(self, at_ns):
        """The domain of the observer ended at `at_ns`."""
        if self.bus_observer:
            self.bus_observer.end(signal.SIGKILL)
            self._take_records(self.bus_observer)
            self.bus_observer = None
        self.records.append({"at_ns": at_ns, "topic": "detached"})

    def _take_records(self, observer):
        for line in observer.take():
            try:
                record = json.loads(line)
                record["at_ns"], record["topic"]
            except (ValueError, KeyError, TypeError):
                continue  # the last line of a killed observer
            self.records.append(record)

    def _take_events(self):
        for at_ns, what, process, _, _ in self.take_events():
            if process == "roudi" and what in ("spawned", "ready", "exited", "hung") or what == "domain restart":
                self._stop_bus_observer(at_ns)
            if process == "roudi" and what == "ready":
                self.bus_observer = Output([self.bin / "faults" / "bus_observer"], self.environment, self.errors)

    def poll(self):
        self._take_events()
        if self.bus_observer:
            self._take_records(self.bus_observer)
        self._take_records(self.dds_observer)
        self.reader.take()
        if not self.is_input_held and not self.input.is_running():
            self.start_input()  # as a service manager does after a failure

    def run_until(self, condition, limit_s):
        """Polls until the condition is true; False after the limit."""
        end = time.monotonic() + limit_s
        while not condition():
            if time.monotonic() > end:
                return False
            self.poll()
            time.sleep(0.004)
        return True

    def run_for(self, seconds):
        self.run_until(lambda: False, seconds)

    def take_records(self):
        self.poll()
        """In the order of arrival; a `detached` comes late."""
        taken, self.records = self.records, []
        return taken

    # What faults do

    def send(self, pid, how):
        """False if there is no such process. One that is to end by it has not crashed."""
        if pid <= 0:
            return False
        if how not in (signal.SIGSTOP, signal.SIGCONT):
            self.signalled.add(pid)
        try:
            os.kill(pid, how)
        except (ProcessLookupError, OverflowError):
            return False
        return True

    def send_to(self, service, how):
        return self.send(self.pids.get(service, 0), how)

    def step_wall_clock(self, seconds):
        # In place, as processes have mapped the file.
        with open(os.open(self.wall_clock, os.O_CREAT | os.O_WRONLY, 0o644), "wb") as file:
            file.write(int(seconds * 1_000_000_000).to_bytes(8, "little", signed=True))

    def own_processes(self):
        """Processes of the product but for tools and input: the supervisors, their guardians, RouDi, the services."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                arguments = (entry / "cmdline").read_bytes().split(b"\0")
            except (OSError, ValueError):
                continue
            if not entry.name.isdigit() or not arguments[0]:
                continue
            name = pathlib.Path(os.fsdecode(arguments[0])).name
            is_service = name.startswith("boresight-") and name != "boresight-replay"
            if is_service or name == "iox-roudi" or b"supervise" in arguments[1:2]:
                found.append(int(entry.name))
        return found

    def cut_power(self):
        """All processes of the product at once; none can tidy up."""
        while processes := self.own_processes():
            for pid in processes:
                self.send(pid, signal.SIGSTOP)  # none may react to another's end
            for pid in processes:
                self.send(pid, signal.SIGKILL)
            self.supervisor.process.poll()
            time.sleep(0.002)
        self._take_events()
        self.pids.clear()
        self._stop_bus_observer(time.monotonic_ns())

    def stop(self):
        """Exit code of the supervisor."""
        for process in (self.reader, self.input, self.dds_observer, self.bus_observer):
            if process:
                process.end(patience_s=2)
        return self.supervisor.end()
