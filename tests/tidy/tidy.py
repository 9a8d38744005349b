#!/usr/bin/env python3
"""The project's rules of order, checked: tidy.py SOURCE_DIR [PATH…] prints each violation, only those below the given
paths if there are any, and exits with 1 if there is one."""
import pathlib
import re
import shutil
import subprocess
import sys

import citations
import constants
import words

ALLOWED_TOP_LEVEL = {"CMakeLists.txt", "services", "interfaces", "deploy", "tests", "config", "docs", "README.md",
                     "LICENSE"}
MAX_LINES = 500
SOURCES = {".cpp", ".hpp"}
TEXTS = SOURCES | {".md", ".toml", ".txt", ".sh", ".py", ".cmake", ".service", ".conf", ".idl", ""}

# What a pure room must not know: the middleware, the network, clocks, files, loggers, threads.
IMPURE = re.compile(r"^(iceoryx|fastdds|fastrtps|spdlog|fmt/|CLI/|toml\+\+|pcap|sys/|netinet/|arpa/|linux/|net/|poll\.h|"
                    r"unistd\.h|fcntl\.h|time\.h|signal\.h|pthread|chrono|ctime|thread|mutex|condition_variable|future|"
                    r"filesystem|fstream|iostream|cstdio|stdio\.h|services/common/runtime/)")
PURE_ROOMS = ("interfaces", "services/common/extended_object", "services/common/geometry", "services/common/estimation", "services/common/vehicle", "services/common/e2e", "services/common/someip",
              "services/ingest_gateway/dbc")
PURE_FOLDERS = {"core", "codecs"}
# Printing into a buffer is no input or output, but <format> is not in this compiler yet.
PURE_EXCEPTIONS = {("services/ingest_gateway/codecs/report.cpp", "cstdio")}

# Units that a float of a message may carry, and names that stand for a pure number.
UNIT = re.compile(r"_(m|s|ms|us|ns|hz|rad|radps|radps2pm|mps|mps2|db|dbsm|m2)$")
PURE_NUMBER = re.compile(r"(probability|ratio|skewness|kurtosis|speed_scale(_std)?|covariance|coefficients|sensor_to_vehicle|"
                         r"detections_per_scan|seconds_of_drive|seconds_to_95_percent|drift_per_minute|nees|"
                         r"(angle|range_rate)_noise_scale)$|^values$|"
                         # The unit is that of the field which holds the pair, or depends on the kind of change or finding.
                         r"^(value|std|size|finding_value)$")
FLOAT_FIELD = re.compile(r"^\s*(?:alignas\(\d+\)\s*)?(?:float|double|std::array<float,[^;]*>|DetectionColumn<float>)\s+"
                         r"(\w+)\s*;", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
# Spelled so that the rule does not find itself.
UNFINISHED = re.compile("TO" + r"DO|FIX" + "ME")
CONFLICT = re.compile("<" * 7 + r" |" + ">" * 7 + " ")
MACHINE = re.compile(r"(?<![\w.$}/\"])/" + r"(work|home/\w+)/")


def is_pure(path):
    folders = path.parts[:-1]
    return path.as_posix().startswith(PURE_ROOMS) or (folders[:1] == ("services",) and PURE_FOLDERS & set(folders))


def tracked_files(root):
    """What belongs to the project: what git knows or would add; without git, everything but builds."""
    listing = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
                             capture_output=True, text=True, check=False)
    if listing.returncode == 0:
        names = [name for name in listing.stdout.split("\0") if name]
    else:
        names = [p.relative_to(root).as_posix() for p in root.rglob("*")
                 if p.is_file() and not p.relative_to(root).parts[0].startswith(("build", "."))]
    return sorted(pathlib.Path(name) for name in names if (root / name).is_file())


def reachable_includes(root, path, seen):
    """Every header that `path` includes, directly or through headers of the project, with who includes it."""
    for name in INCLUDE.findall((root / path).read_text(errors="replace")):
        yield path, name
        header = pathlib.Path(name)
        if header not in seen and (root / header).is_file():
            seen.add(header)
            yield from reachable_includes(root, header, seen)


def check_top_level(root, files):
    for name in sorted({f.parts[0] for f in files}):
        if name not in ALLOWED_TOP_LEVEL and not name.startswith("."):
            yield f"{name}: does not belong to the top level"


def check_purity(root, files):
    for path in files:
        if path.suffix not in SOURCES or not is_pure(path):
            continue
        for includer, name in reachable_includes(root, path, {path}):
            if IMPURE.match(name) and (path.as_posix(), name) not in PURE_EXCEPTIONS:
                yield f"{path}: pure, but {includer} includes {name}"


def check_units(root, files):
    for path in files:
        if path.as_posix().startswith("interfaces/messages/") and path.suffix == ".hpp":
            for name in FLOAT_FIELD.findall((root / path).read_text()):
                if not UNIT.search(name) and not PURE_NUMBER.search(name):
                    yield f"{path}: float '{name}' names no unit"


def check_text(root, files):
    for path in files:
        if path.suffix not in TEXTS and path.parts[0] != ".ci":
            continue
        text = (root / path).read_text(errors="replace")
        lines = text.splitlines()
        if path.suffix in SOURCES | {".py", ".sh"} and len(lines) > MAX_LINES:
            yield f"{path}: {len(lines)} lines, at most {MAX_LINES}"
        for number, line in enumerate(lines, 1):
            if UNFINISHED.search(line):
                yield f"{path}:{number}: unfinished work is an issue, not a comment"
            if CONFLICT.match(line):
                yield f"{path}:{number}: mark of a merge conflict"
            if MACHINE.search(line):
                yield f"{path}:{number}: names a folder of one machine"


def check_rooms(root, files):
    names = {f.as_posix() for f in files}
    services = sorted({f.parts[1] for f in files if f.parts[0] == "services" and f.suffix in SOURCES} - {"common"})
    for service in services:
        room = f"services/{service}"
        # The simulator is no process of its own: the command-line tool runs it.
        for needed in ("CMakeLists.txt", "README.md") if service == "simulator" else ("main.cpp", "CMakeLists.txt", "README.md"):
            if f"{room}/{needed}" not in names:
                yield f"{room}: has no {needed}"
        # These have no core: what they compute is in rooms named after it, such as report/ and radar/.
        if service not in ("boresight", "simulator") and not any(name.startswith(f"{room}/core/") for name in names):
            yield f"{room}: has no core/"


def check_format(root, files):
    tool = shutil.which("clang-format")
    sources = [str(root / f) for f in files if f.suffix in SOURCES]
    if tool is None or not sources:
        return
    result = subprocess.run([tool, "--dry-run", "-Werror", "--ferror-limit=1", "--style=file", *sources],
                            capture_output=True, text=True, check=False)
    for name in sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", result.stderr, re.MULTILINE))):
        yield f"{pathlib.Path(name).relative_to(root)}: not formatted (clang-format -i)"


CHECKS = (check_top_level, check_purity, check_units, check_text, check_rooms, check_format, words.findings,
          citations.findings, constants.findings)


def violations(root):
    root = pathlib.Path(root).resolve()
    files = tracked_files(root)
    return [line for check in CHECKS for line in check(root, files)]


if __name__ == "__main__":
    paths = tuple(sys.argv[2:])
    found = [line for line in violations(sys.argv[1]) if not paths or line.startswith(paths)]
    print("\n".join(found) if found else "tidy")
    sys.exit(1 if found else 0)
