"""commands.py BORESIGHT SOURCE_DIR: every command with --help, an unknown option, a missing input, a full disk, and Ctrl-C.

Runs in a /tmp of its own. Exit code 0 if every check passed, 1 if one failed."""
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

BORESIGHT = sys.argv[1]
TMP = pathlib.Path("/tmp/command_line")
DRIVE = TMP / "drive"
TABLES = TMP / "tables"
FULL = TMP / "full"  # a file system without room
# Others may publish on the usual domain of this network.
os.environ["BORESIGHT_DDS_DOMAIN"] = str(100 + os.getpid() % 100)

COMMANDS = ("align", "calibrate plate", "calibrate reflectors", "catalogue", "decode", "demo", "diagnostics", "dtc clear", "dtc list",
            "dtc show", "dtc table", "fit-evidence", "gospa", "monitor", "record", "report", "run", "score", "simulate", "supervise", "track",
            "vehicle list", "vehicle use")
# Commands whose input is not there: exit code 3, and the message names the input.
MISSING_INPUT = (
    "align --recording ABSENT --vehicle demo",
    "align --drive ABSENT --ego ABSENT --vehicle alignment_drive",
    "align --drive TABLES/drive.csv --ego TABLES/ego.csv --vehicle alignment_drive --truth ABSENT",
    "calibrate plate --table ABSENT",
    "calibrate plate --recording ABSENT --tilts ABSENT --vehicle demo --radar 1",
    "calibrate reflectors --table ABSENT --vehicle demo --radar 1",
    "decode --profile ars548 --csv ABSENT",
    "decode --vehicle demo --check ABSENT",
    "demo --recording ABSENT --vehicle demo",
    "dtc list --state ABSENT --vehicle demo",
    "fit-evidence ABSENT --vehicle demo",
    "gospa ABSENT ABSENT",
    "report ABSENT --vehicle demo",
    "run ABSENT --vehicle demo --out OUT",
    "run --detections ABSENT --ego TABLES/ego.csv --vehicle alignment_drive --out OUT",
    "score ABSENT --truth DRIVE",
    "score DRIVE --truth ABSENT",
    "report LIVE --vehicle demo --truth ABSENT",
    "track --measurements ABSENT --params ABSENT --out OUT",
    "track --measurements ABSENT --tracker srukf --out OUT",
)
# A wrong command line or configuration: exit code 2, and the message contains the second text.
USAGE = (
    ("", "a command is missing"),
    ("foo", "unknown command 'foo'"),
    ("decod", "did you mean 'decode'?"),
    ("calibrate plat", "did you mean 'plate'?"),
    ("align --vehicel demo", "did you mean '--vehicle'?"),
    ("align --recording x --vehicle dem", "did you mean 'demo'?"),
    ("align --recording x --vehicle ./absent.toml", "./absent.toml: no such file"),
    ("align --recording x --vehicle demo --config /absent", "configuration: /absent"),
    ("calibrate reflectors --table x --vehicle absent --radar 1", "names there: alignment_drive, "),
    ("decode --vehicle absent --csv x", "names there: alignment_drive, "),
    ("decode --vehicle demo --csv --check x", "--csv, --ego and --check"),
    ("demo --vehicle absent", "names there: alignment_drive, "),
    ("diagnostics --domain 999", "--domain"),
    ("dtc show C1D0", "is no trouble code"),
    ("dtc clear", "no secret"),
    ("dtc clear --key /absent", "/absent: "),
    ("fit-evidence DRIVE --vehicle demo --json", "only one result can go to standard output"),
    ("fit-evidence DRIVE --vehicle absent", "names there: alignment_drive, "),
    ("fit-evidence DRIVE --vehicle demo --statistics absent", "absent.toml"),
    ("gospa x y --base root", "--base"),
    ("monitor --vehicle absent", "names there: alignment_drive, "),
    ("record --vehicle absent --out x", "names there: alignment_drive, "),
    ("record --out x", "nothing to record"),
    ("report LIVE --vehicle absent", "names there: alignment_drive, "),
    ("run --vehicle demo --out OUT", "give either recordings, or --detections and --ego"),
    ("run x --vehicle absent --out OUT", "names there: alignment_drive, "),
    ("score DRIVE --truth DRIVE --limit a=1", "--limit needs --junit"),
    ("score DRIVE --truth DRIVE --junit OUT --limit a", "allowed is NAME=MAX"),
    ("score DRIVE --truth DRIVE --vehicle absent", "names there: alignment_drive, "),
    ("simulate --scenario absent --out OUT", "known: aligned_drive"),
    ("simulate --vehicle absent --out OUT", "names there: alignment_drive, "),
    ("simulate --vehicle demo --config RECORD --out OUT", "is a file; give the folder"),
    ("supervise --vehicle absent", "names there: alignment_drive, "),
    ("track --measurements x --params y --out z --tracker absent", "--tracker"),
    ("track --measurements x --out z", "--params is required for the tracker pmbm"),
    ("track --measurements x --params y --out z --tracker srukf", "--params is an option of pmbm and phd"),
    ("track --measurements x --params y --out z --figure f.svg", "--figure is an option of the filters kalman, ekf"),
    ("track --measurements x --out z --tracker ukf --step 0", "--step"),
    ("track --measurements x --out z --tracker ukf --sigma-points 1 2 -6", "--sigma-points: ALPHA² · (6 + KAPPA) must be positive"),
    ("catalogue --roudi --markdown", "--markdown"),
    ("vehicle", "a command is missing"),
    ("vehicle use", "vehicle is required"),
    ("vehicle use absent", "names there: alignment_drive, "),
    ("vehicle use alignment_drive", "ego.source: is missing"),
    ("vehicle list --config /absent", "/absent/vehicle: holds no vehicle"),
    ("demo --vehicle PIPE", "it is a pipe; must be a regular file"),
    ("simulate --scenario PIPE --out OUT", "it is a pipe; must be a regular file"),
)
# An output without room: exit code 3, and the message names the file and the cause.
NO_ROOM = (
    ("align --drive TABLES/drive.csv --ego TABLES/ego.csv --vehicle alignment_drive --json /dev/full", "/dev/full"),
    ("align --drive TABLES/drive.csv --ego TABLES/ego.csv --vehicle alignment_drive --plot FULL/plot.svg", "FULL/plot.svg"),
    ("align --drive TABLES/drive.csv --ego TABLES/ego.csv --vehicle alignment_drive > /dev/full", "standard output"),
    ("calibrate plate --table PLATE --json /dev/full", "/dev/full"),
    ("calibrate plate --table PLATE > /dev/full", "standard output"),
    ("calibrate reflectors --table REFLECTORS --vehicle demo --radar 1 --json FULL/r.json", "FULL/r.json"),
    ("catalogue > /dev/full", "standard output"),
    ("decode --profile ars548 --csv DRIVE/radars.pcap > /dev/full", "standard output"),
    ("decode --profile ars548 --csv DRIVE/radars.pcap --out FULL/rows.csv", "FULL/rows.csv"),
    ("decode --profile ars548 --check DRIVE/radars.pcap > /dev/full", "standard output"),
    ("demo --out FULL/demo", "FULL/demo"),
    ("fit-evidence DRIVE --vehicle demo --out FULL/radar.toml", "FULL/radar.toml"),
    ("fit-evidence DRIVE --vehicle demo --json FULL/fit.json", "FULL/fit.json"),
    ("fit-evidence DRIVE --vehicle demo > /dev/full", "standard output"),
    ("report LIVE --vehicle demo --out FULL/report.html", "FULL/report.html"),
    ("run DRIVE/radars.pcap DRIVE/ego.candump.log --vehicle demo --out FULL/run", "FULL/run/"),
    ("simulate --duration 5 --out FULL/drive", "FULL/drive/"),
    ("simulate --alignment-drive city --duration 5 --out FULL/tables", "FULL/tables/"),
    ("simulate --list > /dev/full", "standard output"),
    ("supervise --vehicle demo --logs /proc/absent", "/proc/absent"),
    ("track --measurements ONE_OBJECT --tracker srukf --out FULL/estimates.csv", "FULL/estimates.csv"),
    ("track --measurements ONE_OBJECT --tracker srukf --out - > /dev/full", "standard output"),
)

failures = 0


def check(what, is_true, detail=""):
    global failures
    if not is_true:
        failures += 1
        print(f"FAILED  {what}\n        {detail}")


def paths(text):
    for name, path in (("ABSENT", TMP / "absent.pcap"), ("TABLES", TABLES), ("DRIVE", DRIVE), ("FULL", FULL),
                       ("RECORD", TMP / "record.txt"), ("LIVE", TMP / "live"), ("PLATE", TMP / "plate.csv"), ("OUT", TMP / "unused"),
                       ("REFLECTORS", TMP / "reflectors.csv"), ("ONE_OBJECT", TMP / "one_object.csv"), ("PIPE", TMP / "pipe"), ("MINE", TMP / "mine")):
        text = re.sub(rf"\b{name}\b", str(path), text)
    return text


def run(arguments):
    return subprocess.run(f"{BORESIGHT} {paths(arguments)}", shell=True, cwd=TMP, capture_output=True, text=True, timeout=30)


def expect(arguments, exit_code, *texts):
    done = run(arguments)
    said = f"exit code {done.returncode}\n{done.stdout[-500:]}{done.stderr[-1500:]}"
    check(f"boresight {arguments}: exit code {exit_code}", done.returncode == exit_code, said)
    for text in texts:
        check(f"boresight {arguments}: prints '{text}'", paths(text) in done.stdout + done.stderr, said)
    return done


def prepare():
    TMP.mkdir()
    FULL.mkdir()
    (TMP / "plate.csv").write_text("tilt_deg,amplitude_db,azimuth_deg\n" + "".join(
        f"{tilt},{30 - tilt * tilt + 0.1 * (scan % 3)},{0.01 * (scan % 5)}\n" for tilt in range(-3, 4) for scan in range(20)))
    (TMP / "reflectors.csv").write_text("x_m,y_m,z_m,range_m,azimuth_deg\n" + "".join(
        f"{10 + 3 * i},8,0.6,{10 + 3 * i},{10 - 0.1 * i}\n" for i in range(12)))
    (TMP / "one_object.csv").write_text("k,range,azimuth_rad,radial_speed\n" + "".join(
        f"{k},{150 - 0.5 * k},0.01,-10\n" for k in range(200)))
    (TMP / "record.txt").write_text("")
    os.mkfifo(TMP / "pipe")
    (TMP / "live").mkdir()
    (TMP / "live/monitor.jsonl").write_text("")
    expect(f"simulate --duration 3 --out {DRIVE}", 0, "simulated 3.0 s", f"{DRIVE}/truth.csv")
    expect(f"simulate --alignment-drive city --duration 5 --out {TABLES}", 0)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", FULL], check=True)
    with (FULL / "filler").open("wb", buffering=0) as filler:
        try:
            while True:
                filler.write(b"x" * 4096)
        except OSError:
            pass


def check_help():
    for command in COMMANDS:
        done = expect(f"{command} --help", 0, f"Usage: boresight {command}", "Exit codes:", "  130  ", f"\n  boresight {command}")
        first = done.stdout.split("\n")[0]
        check(f"{command} --help begins with a sentence", re.fullmatch(r"[A-Z]\w+s .*\.", first), first)
        expect(f"{command} --no-such-option", 2, "unknown option '--no-such-option'")
        expect(f"{command} --help > /dev/full", 3, "standard output: cannot be written: No space left on device")
    reference = pathlib.Path(sys.argv[2], "services/boresight/README.md").read_text()
    for command in COMMANDS:
        section = reference.split(f"\n## {command.split()[0]}\n")[1].split("\n## ")[0]
        for option in re.findall(r"^ +(?:-\w,)?(--[\w-]+)", run(f"{command} --help").stdout, re.M):
            check(f"README names {command} {option}", option == "--help" or re.search(rf"{option}\b", section))
    everything = run("--help").stdout
    for command in COMMANDS:
        check(f"--help lists {command}", command.split()[0] in everything)
    expect("--version", 0, "boresight ")


def check_errors():
    for arguments in MISSING_INPUT:
        expect(arguments, 3, "absent.pcap: No such file or directory")
    expect("record --interface absent0 --out OUT", 3, "absent0: no such interface")
    for arguments, text in USAGE:
        expect(arguments, 2, text)
    before = sorted(FULL.rglob("*"))
    for arguments, file in NO_ROOM:
        done = expect(arguments, 3, file, "" if "/proc/" in file else "No space left on device")
        check(f"{arguments}: no message of success", "simulated" not in done.stdout and "report:" not in done.stdout)
    expect("monitor --vehicle demo --record RECORD/run", 3, "RECORD/run", "Not a directory")
    left = [path for path in FULL.rglob("*") if path not in before and path.is_file() and path.stat().st_size > 0]
    check("a full disk keeps no file", not left, left)
    check("nothing was made by wrong command lines", not (TMP / "unused").exists())


def check_findings():
    (TMP / "cut.pcap").write_bytes((DRIVE / "radars.pcap").read_bytes()[:-40])
    expect("decode --profile ars548 --check DRIVE/radars.pcap", 0, "SOUND")
    expect(f"decode --profile ars548 --check {TMP}/cut.pcap", 1, "DAMAGED")
    (TMP / "few.csv").write_text("t,radar,range,az,el,vr\n")
    expect(f"align --drive {TMP}/few.csv --ego TABLES/ego.csv --vehicle alignment_drive", 1, "there is no detection")
    (TMP / "bowl.csv").write_text("tilt_deg,amplitude_db,azimuth_deg\n" + "".join(
        f"{tilt},{10 + tilt * tilt},0\n" for tilt in range(-3, 4) for _ in range(10)))
    expect(f"calibrate plate --table {TMP}/bowl.csv", 1, "the run failed")
    expect(f"calibrate reflectors --table REFLECTORS --vehicle demo --radar 3", 1)
    expect("report LIVE --vehicle demo --out page.html", 1)
    expect("track --measurements ONE_OBJECT --tracker fast_srukf --out filtered.csv --figure filtered.svg", 0,
           "fast_srukf: 199 estimates", "no true states")
    (TMP / "wrong.csv").write_text("k,range,azimuth_rad,radial_speed\n0,50,0,1\n1,50,left,1\n")
    expect(f"track --measurements {TMP}/wrong.csv --tracker ekf --out wrong_out.csv", 3,
           "wrong.csv:3: azimuth_rad: read \"left\", allowed is a number")
    (TMP / "narrow.csv").write_text("k,range,azimuth_rad\n0,50,0\n")
    expect(f"track --measurements {TMP}/narrow.csv --tracker ekf --out wrong_out.csv", 3,
           "narrow.csv:1: the header lacks the column radial_speed")
    check("a wrong table writes no estimates", not (TMP / "wrong_out.csv").exists())
    expect("diagnostics --seconds 0.2", 1, "nothing was received")
    expect("demo --config /absent --config /also_absent", 2, "configuration: /also_absent")


def check_vehicle():
    source = pathlib.Path(sys.argv[2], "config")
    for folder in ("services", "mappings", "radar_profiles"):
        shutil.copytree(source / folder, TMP / "mine" / folder)
    (TMP / "mine/vehicle").mkdir()
    gateway = [pathlib.Path(BORESIGHT).parent / "boresight-ingest_gateway", "--config", TMP / "mine", "--check"]

    def expect_service(exit_code, text):
        done = subprocess.run(gateway, capture_output=True, text=True, timeout=10, env={"PATH": os.environ["PATH"]})
        said = done.stdout + done.stderr
        check(f"gateway: exit code {exit_code}, '{text}'", done.returncode == exit_code and text in said, said)

    expect_service(2, "mine/vehicle: holds no vehicle; choose one by 'boresight vehicle use NAME|FILE'")
    expect(f"vehicle use {source}/vehicle/demo.toml --config MINE", 0, "vehicle demo: MINE/vehicle/demo.toml, 4 radars")
    expect_service(0, "valid")
    os.umask(0o077)
    expect(f"vehicle use {source}/vehicle/example_mixed.toml --config MINE", 0, "7 radars")
    os.umask(0o022)
    check("other users can read a chosen vehicle", (TMP / "mine/vehicle/example_mixed.toml").stat().st_mode & 0o777 == 0o644)
    done = expect("vehicle list --config MINE", 0)
    stars = [line for line in done.stdout.splitlines() if line.startswith("*")]
    check("vehicle list marks the chosen one only", len(stars) == 2 and stars[0].startswith("* example_mixed "), done.stdout)
    # Whatever is refused, the choice stays.
    for file, problem in (("alignment_drive.toml", "ego.source: is missing"), ("absent.toml", "no such file")):
        expect(f"vehicle use {source}/vehicle/{file} --config MINE", 2, problem)
    (TMP / "other").mkdir()
    (TMP / "other/demo.toml").write_text((source / "vehicle/demo.toml").read_text() + "# changed\n")
    expect(f"vehicle use {TMP}/other/demo.toml --config MINE", 2, "differs from")
    check("a refused file is not copied", sorted(p.name for p in (TMP / "mine/vehicle").iterdir()) == ["demo.toml", "example_mixed.toml"])
    check("a refused file is not chosen", os.readlink(TMP / "mine/vehicle.toml") == "vehicle/example_mixed.toml")
    expect("vehicle use demo --config MINE", 0, "vehicle demo")
    (TMP / "mine/vehicle/demo.toml").unlink()
    expect_service(2, "mine/vehicle/demo.toml does not exist; choose one by")
    (TMP / "mine/vehicle.toml").unlink()
    expect_service(0, "valid")
    shutil.copy(source / "vehicle/demo.toml", TMP / "mine/vehicle")
    expect_service(2, "holds several vehicles, and none is chosen; choose one by")


def interrupt(arguments, after_s=0.5, number=signal.SIGINT, exit_code=130, feed=None, ready=None):
    """Starts a command, whose standard input stays open after `feed`, and ends it by a signal."""
    process = subprocess.Popen([BORESIGHT, *paths(arguments).split()], cwd=TMP, stdin=subprocess.PIPE,
                               stdout=open(TMP / "stdout", "wb"), stderr=open(TMP / "stderr", "wb"))
    if feed:
        process.stdin.write(feed)
        process.stdin.flush()
    end = time.monotonic() + 10
    while ready and not ready() and time.monotonic() < end and process.poll() is None:
        time.sleep(0.02)
    time.sleep(after_s)
    was_running = process.poll() is None
    process.send_signal(number)
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    output, errors = (TMP / "stdout").read_text(), (TMP / "stderr").read_text()
    check(f"{arguments}: {number.name} ends it with {exit_code}", was_running and process.returncode == exit_code,
          f"running: {was_running}, exit code {process.returncode}\n{output[-300:]}{errors[-800:]}")
    return output, errors


def check_interrupts():
    rows, _ = interrupt("decode --profile ars548 --csv -", feed=(DRIVE / "radars.pcap").read_bytes())
    columns = {row.count(",") for row in rows.splitlines()}
    check("decode: Ctrl-C leaves complete rows", rows.endswith("\n") and len(columns) == 1 and rows.count("\n") > 100, columns)
    interrupt("decode --profile ars548 --csv - --out rows.csv", feed=(DRIVE / "radars.pcap").read_bytes())
    drive = (TABLES / "drive.csv").read_bytes()
    expect("simulate --duration 20 --out long_drive", 0)
    interrupt(f"align --drive - --ego {TABLES}/ego.csv --vehicle alignment_drive --json align.json", feed=drive)
    interrupt("align --method batch_calibration --drive TABLES/drive.csv --ego TABLES/ego.csv --vehicle alignment_drive "
              "--json align.json")
    interrupt("calibrate plate --table - --json plate.json", feed=b"tilt_deg,amplitude_db,azimuth_deg\n1,2,3\n")
    interrupt("fit-evidence long_drive --vehicle demo --out fitted.toml", after_s=0.2)
    interrupt("simulate --duration 36000 --out interrupted")
    interrupt("simulate --duration 36000 --out interrupted", number=signal.SIGTERM, exit_code=143)
    interrupt("simulate --alignment-drive city --duration 36000 --out interrupted")
    (TMP / "long").mkdir()
    (TMP / "long/monitor.jsonl").write_bytes(b"x\n" * 20_000_000)
    interrupt("report long --vehicle demo --out interrupted.html", after_s=0.2)
    (TMP / "long/monitor.jsonl").unlink()
    interrupt("monitor --vehicle demo --record monitor_run")
    interrupt("diagnostics")
    interrupt("supervise --vehicle demo --replay --logs logs")
    interrupt("supervise --vehicle demo --replay --logs logs", number=signal.SIGTERM, exit_code=0)
    for name in ("rows.csv", "align.json", "fitted.toml", "plate.json", "interrupted", "interrupted.html"):
        check(f"Ctrl-C leaves no {name}", not (TMP / name).exists())
    check("Ctrl-C leaves no temporary file", not list(TMP.glob("*.partial*")), list(TMP.glob("*.partial*")))


def check_record():
    def started():
        return b"Ctrl-C ends" in (TMP / "stderr").read_bytes()

    def send(megabytes):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for _ in range(int(megabytes * 100)):
                sender.sendto(b"x" * 10_000, ("127.0.0.1", 42107))
                time.sleep(0.0005)

    if run("record --interface lo --duration 0.01 --out probe.pcap").returncode != 0:
        print("skipped: no permission to record")
        return
    options = ["--interface", "lo", "--filter", "udp dst port 42107"]
    words = " ".join(options[:2])
    output, _ = interrupt(f"record {words} --out whole.pcap", ready=started)
    check("record: Ctrl-C ends it as asked", "Ctrl-C after" in output, output)
    expect("decode --profile ars548 --csv whole.pcap", 0)
    process = subprocess.Popen([BORESIGHT, "record", *options, "--out", FULL / "full.pcap", "--duration", "5"],
                               stderr=open(TMP / "stderr", "wb"))
    while not started() and process.poll() is None:
        time.sleep(0.02)
    send(2)
    process.wait(10)
    errors = (TMP / "stderr").read_text()
    check("record: a full disk is exit code 3", process.returncode == 3, errors)
    check("record: a full disk is named", f"{FULL}/full.pcap: No space left on device" in errors, errors)
    check("record: a full disk leaves only a .partial file", not (FULL / "full.pcap").exists())


prepare()
for step in (check_help, check_errors, check_findings, check_vehicle, check_interrupts, check_record):
    begin = time.monotonic()
    step()
    print(f"{step.__name__}: {time.monotonic() - begin:.1f} s")
subprocess.run(["umount", FULL], check=False)
sys.exit(1 if failures else 0)
