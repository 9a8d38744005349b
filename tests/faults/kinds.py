"""How each kind of plan.KINDS is injected.

A function takes the product and the arguments of the injection. It begins the fault and returns `Lasting`: how the fault
ends, which the campaign calls after the injection's duration, or None if the fault is momentary."""
import dataclasses
import os
import pathlib
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable

import bad_input
import plan
import product as product_module
import state

START_LIMIT_S = 10.0
BAD_INPUT_S = 10.0  # longer than the fault lasts
WRITE_WAIT_S = 1.5  # longer than the writing period of the alignment memory


@dataclasses.dataclass
class Lasting:
    end: Callable[[], list] = list  # ends the fault; returns findings, in words
    is_excused: bool = False  # until the end nothing can work: no input, or no service that may start
    useless_radar: int = 0  # until the end this radar's lists are of no use


def kill(product, service):
    product.send_to(service, signal.SIGKILL)


def terminate(product, service):
    product.send_to(service, signal.SIGTERM)


def crash(product, service, **arguments):
    product.send_to(service, getattr(signal, arguments["signal"]))


def stop(product, service):
    pid = product.pids.get(service, 0)
    product.send(pid, signal.SIGSTOP)
    product.signalled.add(pid)  # the supervisor will end it
    return Lasting(lambda: product.send(pid, signal.SIGCONT) and [] or [])


def kill_while_starting(product, service, again_after_ms):
    for wait_ms in again_after_ms:
        old = product.pids.get(service, 0)
        product.send(old, signal.SIGKILL)
        product.run_until(lambda: product.pids.get(service, old) != old, START_LIMIT_S)
        product.run_for(wait_ms / 1000)
    product.send_to(service, signal.SIGKILL)


def kill_all_services(product):
    for service in plan.SERVICES:
        product.send_to(service, signal.SIGKILL)


def kill_roudi(product, process):
    product.signalled.update({product.pids.get("roudi", 0), product.roudi()})
    product.send(product.roudi() if process == "roudi" else product.pids.get("roudi", 0), signal.SIGKILL)


def stop_roudi(product):
    pid = product.roudi()
    product.signalled.update({product.pids.get("roudi", 0), pid})
    product.send(pid, signal.SIGSTOP)
    return Lasting(lambda: product.send(pid, signal.SIGCONT) and [] or [])


def kill_supervisor(product):
    product.supervisor.end(signal.SIGKILL)
    product.poll()
    product.signalled.update(product.pids.values())
    product.pids.clear()

    def start():
        product.start_supervisor()
        return []
    return Lasting(start, is_excused=True)


def stop_input(product):
    process = product.input.process
    process.send_signal(signal.SIGSTOP)
    return Lasting(lambda: process.send_signal(signal.SIGCONT) or [], is_excused=True)


def kill_input(product):
    product.is_input_held = True
    product.input.end(signal.SIGKILL)

    def start():
        product.is_input_held = False
        return []
    return Lasting(start, is_excused=True)


def hog(product, busy_per_core):
    processes = [subprocess.Popen(["sh", "-c", "while :; do :; done"], start_new_session=True)
                 for _ in range(busy_per_core * len(os.sched_getaffinity(0)))]

    def end():
        for process in processes:
            process.kill()
            process.wait()
        return []
    return Lasting(end)


def clock_step(product, step_s):
    product.step_wall_clock(step_s)
    return Lasting(lambda: product.step_wall_clock(0) or [])


def stranger_samples(product):
    radar = min(product.truth().misaligned)
    forever_s = 60
    stranger = product_module.Output([product.bin / "faults" / "dds_stranger", str(product_module.DDS_DOMAIN), str(radar),
                                      str(forever_s)], product.environment, product.errors)

    def take():
        product.strangers.update(stranger.take())
        return bool(product.strangers)

    product.run_until(take, START_LIMIT_S)

    def end():
        take()
        was_running = stranger.is_running()
        stranger.end(signal.SIGKILL)
        return [] if was_running else ["the stranger itself has ended: no fault was injected"]
    return Lasting(end)


def stranger_bytes(product, seed):
    first_port = 7400 + 250 * product_module.DDS_DOMAIN  # by the standard's port mapping
    script = pathlib.Path(__file__).with_name("stranger_bytes.py")
    process = subprocess.Popen([sys.executable, "-B", script, str(first_port), str(seed)], start_new_session=True)

    def end():
        process.kill()
        process.wait()
        return []
    return Lasting(end)


def _play(product, recording):
    product.is_input_held = True
    product.input.end(signal.SIGKILL)
    product.recording = recording
    product.start_input()
    product.is_input_held = False


def _bad_recording(product, damage, radar):
    return product.folder / f"{damage}_{radar}.pcap"


def prepare_bad_input(product, damage, radar):
    recording = _bad_recording(product, damage, radar)
    if not recording.exists():
        whole = (product.drive / "radars.pcap").read_bytes()
        recording.write_bytes(bad_input.damaged(whole, damage, product.senders[radar], BAD_INPUT_S))


def bad_input_(product, damage, radar):
    _play(product, _bad_recording(product, damage, radar))

    def end():
        _play(product, product.drive / "radars.pcap")
        return []
    # A few wrong bits in a list may leave it of use; empty and frozen lists are of none.
    return Lasting(end, useless_radar=0 if damage == "damaged" else radar)


def _fill(folder):
    filler = pathlib.Path(folder) / "filler"
    with filler.open("wb", 0) as file:
        for block in (1 << 20, 4096, 64):
            try:
                while file.write(b"x" * block):
                    pass
            except OSError:
                pass
    return filler


def _full(product, folder, killed, is_excused=False):
    filler = _fill(folder)
    if killed == "roudi":
        kill_roudi(product, "roudi")
    else:
        product.send_to(killed, signal.SIGKILL)

    def end():
        filler.unlink()
        return []
    return Lasting(end, is_excused)


def full_state(product, killed):
    return _full(product, product.state, killed)


def full_logs(product, killed):
    return _full(product, product.logs, killed)


def full_shared_memory(product, killed):
    # RouDi cannot make its memory anew before there is room.
    return _full(product, "/dev/shm", killed, is_excused=killed == "roudi")


def power_cut(product, memory, after_ms, within_write):
    """Kills everything at once, with half of the cuts while a state file is written, and starts anew. `memory`: whether
    /dev/shm and the sockets in /tmp are lost as on an ECU, or stay as on a desk."""
    if within_write:
        product.run_until(lambda: any(product.state.glob("*.tmp")), WRITE_WAIT_S)
    else:
        product.run_for(after_ms / 1000)
    product.cut_power()
    lost = [what for what in state.losses(product) if "rejected" not in what]
    if memory == "cleared":
        for path in pathlib.Path("/dev/shm").iterdir():
            path.unlink()
        for path in pathlib.Path("/tmp").iterdir():
            if path.is_socket() or path.suffix == ".lock":
                path.unlink()
        shutil.rmtree(product.run, ignore_errors=True)
    product.start_supervisor()
    return Lasting(lambda: [f"after the cut: {what}" for what in lost])


def broken_configuration(product, service, damage):
    file = product.config / "services" / f"{service}.toml"
    if damage == "vehicle_emptied":
        file = product.vehicle
    whole = file.read_bytes()
    if damage == "syntax":
        file.write_bytes(whole + b"\nx = = 3\n")
    elif damage == "unknown_key":
        file.write_bytes(whole + b"\n[nonsense]\nx = 3\n")
    elif damage == "vehicle_emptied":
        file.write_bytes(b"")
    else:
        file.unlink()
        if damage == "folder":
            file.mkdir()
    begin = len(product.events)
    log = product.logs / f"{service}.log"
    log_begin = log.stat().st_size if log.exists() else 0
    product.send_to(service, signal.SIGTERM)

    def end():
        product.poll()
        refused = any(what == "exited" and process == service and detail == "exit code 2"
                      for _, what, process, _, detail in product.events[begin:])
        text = log.read_bytes() if log.exists() else b""
        text = text[log_begin:] if len(text) >= log_begin else text  # a rotated log begins anew
        if file.is_dir():
            file.rmdir()
        file.write_bytes(whole)
        findings = [] if refused else [f"{service} did not refuse its configuration with exit code 2 ({damage})"]
        if refused and str(file).encode() not in text:
            findings.append(f"{service} refused its configuration without naming {file.name} ({damage})")
        return findings
    return Lasting(end, is_excused=service in plan.DATA_PATH)


FUNCTIONS = {name: globals()[name] for name in plan.KINDS if name != "bad_input"} | {"bad_input": bad_input_}
# What takes long and is done before the fault begins.
PREPARATIONS = {"bad_input": prepare_bad_input}
