"""The product as a user starts it, `boresight supervise`, on a machine of its own (tests/system/own_machine)."""
import os
import pathlib
import re
import signal
import subprocess
import threading

SECOND_NS = 1_000_000_000
EVENT = re.compile(r"^([\d.]+) (spawned|ready|exited|hung|given up|start failed|domain restart|domain ready|stopped) "
                   r"(\S+) (\d+) ?(.*)$")


class Output:
    """A process with the lines of its standard output, read by a thread."""

    def __init__(self, command, environment, errors):
        self.lines = []
        self._lock = threading.Lock()
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=errors,
                                        env=environment, text=True, errors="replace", start_new_session=True)
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.process.stdout:
            with self._lock:
                self.lines.append(line.rstrip("\n"))

    def take(self):
        with self._lock:
            taken, self.lines = self.lines, []
        return taken

    def is_running(self):
        return self.process.poll() is None

    def end(self, how=signal.SIGTERM, patience_s=8):
        """Exit code; after `patience_s` the process is killed."""
        if self.is_running():
            self.process.send_signal(how)
        try:
            return self.process.wait(patience_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            return self.process.wait()


def run_checked(command, **options):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, **options)


class Supervised:
    """`config`, `state`, `logs` and `run` are folders in `folder`; the configuration has the vehicle `vehicle`."""

    def __init__(self, build, folder, vehicle, dds_domain):
        self.bin, self.folder = build / "bin", folder
        self.config, self.state, self.logs, self.run = (folder / name for name in ("config", "state", "logs", "run"))
        self.vehicle_name = vehicle
        self.vehicle = self.config / "vehicle" / f"{vehicle}.toml"
        self.errors = (folder / "errors.txt").open("ab")
        self.events = []  # (time in ns, what, process, pid, detail) of all supervisors
        self.pids = {}
        self.environment = {**os.environ, "BORESIGHT_RUNTIME_DIR": str(self.run), "STATE_DIRECTORY": str(self.state),
                            "BORESIGHT_DDS_DOMAIN": str(dds_domain)}
        self.supervisor = None

    def start_supervisor(self, environment=None):
        self.supervisor = Output([self.bin / "boresight", "supervise", "--config", self.config, "--vehicle",
                                  self.vehicle_name, "--logs", self.logs, "--run-dir", self.run, "--replay"],
                                 environment or self.environment, self.errors)

    def played(self, recordings):
        """A process that plays the recordings to the gateway, again and again."""
        return Output([self.bin / "boresight-replay", "--loop", "100000", *recordings], self.environment, self.errors)

    def diagnosed(self):
        """A diagnosis tool of the product on DDS."""
        return Output([self.bin / "boresight", "diagnostics", "--all", "--json"], self.environment, self.errors)

    def take_events(self):
        """The new events of the supervisor; `pids` follows them."""
        taken = []
        for line in self.supervisor.take():
            found = EVENT.match(line)
            if not found:
                continue
            what, process, pid = found[2], found[3], int(found[4])
            taken.append((int(float(found[1]) * SECOND_NS), what, process, pid, found[5]))
            if what == "spawned":
                self.pids[process] = pid
            elif what == "exited" and self.pids.get(process) == pid:
                del self.pids[process]
        self.events += taken
        return taken

    def roudi(self):
        """RouDi itself, the child of its wrapper; 0 if there is none."""
        wrapper = self.pids.get("roudi", 0)
        try:
            children = pathlib.Path(f"/proc/{wrapper}/task/{wrapper}/children").read_text().split()
        except OSError:
            return 0
        return int(children[0]) if children else 0
