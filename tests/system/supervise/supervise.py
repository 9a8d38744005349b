"""`boresight supervise` as a program: killed and restarted, with processes that hang, with a full disk, with a broken
configuration, and beside a second domain. supervise.py BORESIGHT SOURCE_DIR, in a separate /dev/shm and /tmp."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

BORESIGHT, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TMP = pathlib.Path("/tmp/story")
PATIENCE_S = 15
LIMIT_S = 2.0  # from a fault to a domain that is ready
PAUSES_S = (0, 0.1, 0.3, 0.5, 1, 2)  # from the kill of a supervisor to the start of the next
failures = 0


def check(what, is_true, detail=""):
    global failures
    print(f"{'ok      ' if is_true else 'FAILED  '}{what}{'' if is_true else f': {detail}'}", flush=True)
    failures += not is_true


def until(condition, seconds=PATIENCE_S):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.005)
    return True


class Domain:
    """A running `boresight supervise`; its output is read from a file, so that nothing blocks."""
    count = 0

    def __init__(self, *options, config=SOURCE / "config", logs=TMP / "logs", prefix=()):
        Domain.count += 1
        self.output = TMP / f"output{Domain.count}"
        command = [*prefix, BORESIGHT, "supervise", "--replay", "--vehicle", "demo", "--config", str(config),
                   "--logs", str(logs), *options]
        with self.output.open("wb") as output:
            self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, stderr=output)

    def text(self):
        return self.output.read_text(errors="replace")

    def count_of(self, event):
        return len(re.findall(rf"^[\d.]+ {event}\b", self.text(), re.M))

    def is_ready(self, times=1):
        return until(lambda: self.count_of("domain ready") >= times or self.process.poll() is not None) \
            and self.process.poll() is None

    def pid_of(self, name):
        return int(re.findall(rf"^[\d.]+ spawned {name} (\d+)", self.text(), re.M)[-1])

    def roudi(self):
        """RouDi itself, the child of its wrapper."""
        wrapper = self.pid_of("roudi")
        return int(pathlib.Path(f"/proc/{wrapper}/task/{wrapper}/children").read_text().split()[0])

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(PATIENCE_S)


def check_killed_supervisor():
    domain = Domain()
    check("a domain starts", domain.is_ready(), domain.text())
    for pause_s in PAUSES_S:
        domain.process.kill()
        domain.process.wait()
        time.sleep(pause_s)
        domain = Domain()
        check(f"a supervisor started {pause_s} s after a kill has a domain", domain.is_ready(), domain.text())
        time.sleep(1.5)  # longer than the old guardian lives
        exits = domain.count_of("exited") + domain.count_of("domain restart")
        check("which the old guardian leaves alone", exits == 0 and domain.process.poll() is None, domain.text())
        check("with its memory", {"iceoryx_mgmt"} < set(os.listdir("/dev/shm")), os.listdir("/dev/shm"))
    second = Domain()
    check("a second domain beside it is refused", second.process.wait(PATIENCE_S) == 3 and
          "another domain runs on this machine" in second.text(), second.text())
    check("the first one stops in order", domain.stop() == 0, domain.text())
    check("nothing is left", not os.listdir("/dev/shm"), os.listdir("/dev/shm"))


def check_hung_processes():
    domain = Domain()
    check("a domain starts", domain.is_ready(), domain.text())
    for number, (how, what) in enumerate(((signal.SIGKILL, "killed"), (signal.SIGSTOP, "stopped")), 2):
        time.sleep(1)
        begin = time.monotonic()
        os.kill(domain.roudi(), how)
        ready = domain.is_ready(number)
        check(f"a {what} RouDi costs less than {LIMIT_S} s", ready and time.monotonic() - begin < LIMIT_S,
              f"{time.monotonic() - begin:.3f} s\n{domain.text()}")
    for name in ("tracker", "health"):
        pid = domain.pid_of(name)
        os.kill(pid, signal.SIGSTOP)
        check(f"{name}, stopped, is started again", until(lambda: domain.pid_of(name) != pid, 5), domain.text())
        check("alone", domain.count_of("domain restart") == 2, domain.text())
        spawned = domain.text().rindex(f" spawned {name} ")
        check("and becomes ready", until(lambda: f" ready {name} " in domain.text()[spawned:], 5), domain.text())
    check("the domain stops in order", domain.stop() == 0, domain.text())


def check_full_disk():
    logs = TMP / "small"
    logs.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(logs)], check=True)
    domain = Domain(logs=logs)
    check("a domain starts", domain.is_ready(), domain.text())
    with (logs / "filler").open("wb", 0) as filler:
        try:
            while filler.write(b"x" * 512):
                pass
        except OSError:
            pass
    begin = time.monotonic()
    os.kill(domain.roudi(), signal.SIGKILL)
    check(f"with a full log disk, a killed RouDi costs less than {LIMIT_S} s",
          domain.is_ready(2) and time.monotonic() - begin < LIMIT_S, domain.text())
    pid = domain.pid_of("tracker")
    os.kill(pid, signal.SIGKILL)
    check("and a killed service comes back", until(lambda: domain.pid_of("tracker") != pid), domain.text())
    check("the domain stops in order", domain.stop() == 0, domain.text())
    subprocess.run(["umount", str(logs)], check=True)


def check_full_output():
    with open("/dev/full", "wb") as full:
        process = subprocess.Popen([BORESIGHT, "supervise", "--replay", "--vehicle", "demo", "--config",
                                    str(SOURCE / "config"), "--logs", str(TMP / "logs")],
                                   stdin=subprocess.DEVNULL, stdout=full, stderr=full)
    log = TMP / "logs" / "health.log"
    log.unlink()
    check("without room for its own output, a domain starts",
          until(lambda: log.exists() and "started" in log.read_text()) and process.poll() is None, process.poll())
    process.send_signal(signal.SIGTERM)
    check("and stops in order", process.wait(PATIENCE_S) == 0, process.poll())


def check_relative_folders():
    os.chdir(TMP)
    domain = Domain("--run-dir", "run", logs="relative_logs")
    check("a domain with relative folders starts", domain.is_ready(), domain.text())
    check("in its run directory", (TMP / "run" / "replay.sock").exists(), os.listdir(TMP))
    check("the domain stops in order", domain.stop() == 0, domain.text())


def check_broken_configuration():
    config = TMP / "config"
    shutil.copytree(SOURCE / "config", config)
    file = config / "services" / "ghost_filter.toml"
    whole = file.read_text()
    file.write_text(whole + "\n[nonsense]\nx = 3\n")
    domain = Domain(config=config)
    code = domain.process.wait(PATIENCE_S)
    last = domain.text()[-1000:]
    check("a broken configuration stops the start with exit code 2", code == 2, f"{code}: {last}")
    check("and names service, file and key", "ghost_filter refuses its configuration" in last and str(file) in last
          and "nonsense" in last, last)
    check("nothing is left", not os.listdir("/dev/shm"), os.listdir("/dev/shm"))

    file.write_text(whole)
    domain = Domain(config=config)
    check("the whole configuration starts", domain.is_ready(), domain.text())
    file.write_text(whole + "\n[nonsense]\nx = 3\n")
    os.kill(domain.pid_of("ghost_filter"), signal.SIGTERM)
    check("broken while it runs, the service is given up", until(lambda: domain.count_of("given up") == 1),
          domain.text())
    spawned = domain.count_of("spawned")
    time.sleep(2)
    check("and not tried again", domain.count_of("spawned") == spawned and domain.count_of("domain restart") == 0,
          domain.text())
    file.write_text(whole)
    check("until the file is mended", until(lambda: domain.count_of("spawned") == spawned + 1, 5), domain.text())
    check("the domain stops in order", domain.stop() == 0, domain.text())


def check_two_domains():
    folder = TMP / "second"
    folder.mkdir()
    prefix = [str(SOURCE / "tests/system/isolated"), str(SOURCE), str(pathlib.Path(BORESIGHT).parents[1]), "--"]
    first, second = Domain(), Domain(logs=folder, prefix=prefix)
    for name, domain in (("first", first), ("second", second)):
        check(f"two isolated domains run at once: the {name}", domain.is_ready(), domain.text())
    os.kill(first.roudi(), signal.SIGKILL)
    check("a fault in one", first.is_ready(2), first.text())
    check("leaves the other alone", second.count_of("exited") == 0, second.text())
    check("both stop in order", (first.stop(), second.stop()) == (0, 0), first.text() + second.text())


def main():
    TMP.mkdir()
    for story in (check_killed_supervisor, check_hung_processes, check_full_disk, check_full_output,
                  check_relative_folders, check_broken_configuration, check_two_domains):
        print(f"# {story.__name__}", flush=True)
        story()
    return 1 if failures else 0


sys.exit(main())
