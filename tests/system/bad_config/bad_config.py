"""bad_config.py BINARIES SOURCE_DIR: each mutation of mutations.py through the real services' --check.

A service must end within the time limit with exit code 2, and its message must name the file, the line, the key and what
is allowed. Exit code 0 if every check passed, 1 if one failed."""
import concurrent.futures
import os
import pathlib
import re
import resource
import shutil
import socket
import subprocess
import sys
import tempfile

import mutations

BINARIES = pathlib.Path(sys.argv[1])
SOURCE = pathlib.Path(sys.argv[2])
TIME_LIMIT_S = 5
MEMORY_LIMIT_BYTES = 4 << 30  # of addresses: an endless file must not be read to its end
MAX_MESSAGE_BYTES = 20_000
# The allowed values in a message.
ALLOWED = re.compile(r"allowed: |must |known here: |already used|not valid TOML|is missing|neither an IPv4 nor an IPv6|"
                     r"is the port of service discovery|this profile needs ")


def environment():
    kept = {name: value for name, value in os.environ.items() if not name.startswith("BORESIGHT_")}
    return {**kept, "BORESIGHT_RUNTIME_DIR": "/tmp"}


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT_BYTES, MEMORY_LIMIT_BYTES))


def check(folder, service, vehicle):
    """Exit code (None: not ended in time) and output of SERVICE --check."""
    command = [BINARIES / f"boresight-{service}", "--config", folder, "--check"]
    if service != "replay":
        command += ["--vehicle", vehicle]
    try:
        done = subprocess.run(command, capture_output=True, timeout=TIME_LIMIT_S, env=environment(), preexec_fn=limit_memory)
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, (done.stdout + done.stderr).decode("utf8", "replace")


def make_folder(parent):
    folder = pathlib.Path(tempfile.mkdtemp(dir=parent))
    for name in ("vehicle", "services", "mappings", "radar_profiles"):
        shutil.copytree(SOURCE / "config" / name, folder / name)
    return folder


def put_special(path, kind):
    path.unlink()
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "socket":
        with socket.socket(socket.AF_UNIX) as made:
            made.bind(str(path))
    elif kind == "folder":
        path.mkdir()
    elif kind == "large":
        with path.open("wb") as file:
            file.truncate(1 << 40)  # a hole: endless for who reads it
    elif kind == "link to itself":
        path.symlink_to(path)
    elif kind != "absent":
        path.symlink_to(kind)  # a device


def judge(mutation, path, changed_line, exit_code, text):
    """What is wrong with a service's answer to a mutation; empty if nothing is."""
    if exit_code is None:
        return f"no end within {TIME_LIMIT_S} s"
    if mutation.expected is None:
        return "" if exit_code == 0 else f"exit code {exit_code} for an allowed file"
    if exit_code != 2:
        return f"exit code {exit_code}"
    if len(text) > MAX_MESSAGE_BYTES or re.search(r"[\x00-\x09\x0b-\x1f]", text):
        return f"a message of {len(text)} bytes, or with control characters"
    if mutation.special:
        return "" if f"{path}: cannot be read: " in text and mutation.expected in text else "other message"
    for found in re.finditer(rf"^(?:.*: )?{re.escape(str(path))}:(\d+): (.*)$", text, re.M):
        if found[2].startswith(mutation.expected) and (changed_line is None or int(found[1]) == changed_line):
            return "" if ALLOWED.search(found[2]) else "the message does not name what is allowed"
    return f"no message at line {changed_line} that begins with '{mutation.expected}'"


def run(parent, mutation):
    folder = make_folder(parent)
    path = folder / mutation.file
    changed_line = None
    if mutation.special:
        put_special(path, mutation.special)
    else:
        before = path.read_bytes()
        after = mutation.change(before)
        assert after != before, f"{mutation.name} changes nothing"
        path.write_bytes(after)
        if mutation.at_change:
            old, new = before.split(b"\n"), after.split(b"\n")
            changed_line = next(i for i, line in enumerate(new) if i >= len(old) or line != old[i]) + 1
    failures = []
    for service in mutation.services:
        exit_code, text = check(folder, service, mutation.vehicle)
        problem = judge(mutation, path, changed_line, exit_code, text)
        if problem:
            failures.append(f"FAILED  {mutation.name}, {service}: {problem}\n        {text[:600]}")
    shutil.rmtree(folder)
    return failures


with tempfile.TemporaryDirectory() as parent, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    results = list(pool.map(lambda mutation: run(parent, mutation), mutations.ALL))
for failure in (failure for failures in results for failure in failures):
    print(failure)
print(f"{len(mutations.ALL)} mutations, {sum(len(m.services) for m in mutations.ALL)} runs")
sys.exit(1 if any(results) else 0)
