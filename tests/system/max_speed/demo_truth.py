"""demo_truth.py BORESIGHT: the demo compares recordings with their truth, faster than real time.

Runs in a /tmp of its own. Exit code 0 if every check passed, 1 if one failed."""
import pathlib
import subprocess
import sys

BORESIGHT = sys.argv[1]
TMP = pathlib.Path("/tmp/demo_truth")
DRIVE = TMP / "drive"
failures = 0


def check(what, is_true, output):
    global failures
    if not is_true:
        failures += 1
        print(f"FAILED  {what}\n{output}")


def demo(*options):
    done = subprocess.run([BORESIGHT, "demo", "--vehicle", "demo", "--out", TMP / "out", "--recording", DRIVE / "radars.pcap",
                           "--recording", DRIVE / "ego.candump.log", *options],
                          capture_output=True, text=True, timeout=60, check=False)
    return done.returncode, done.stdout + done.stderr


def state_that_front_right_is_aligned():
    rows = [row.split(",") for row in (DRIVE / "truth.csv").read_text().splitlines()]
    for row in rows:
        if row[0].startswith("alignment_") and row[1] == "2":
            row[2] = "0"
    (DRIVE / "truth.csv").write_text("".join(",".join(row) + "\n" for row in rows))
    (DRIVE / "truth_sensors.csv").unlink()


subprocess.run([BORESIGHT, "simulate", "--scenario", "demo_drive", "--duration", "20", "--out", DRIVE], check=True,
               capture_output=True)
code, output = demo("--speed", "max", "--truth", DRIVE)
check("no scan is lost at the largest speed", "[ok] every scan came back as a track list" in output, output)
check("the misaligned radar is compared with the truth",
      "[ok] front_right is misaligned in the truth and was reported as MISALIGNED" in output, output)
check("scans are compared with the truth", "[ok] front_left: 400 of 400 sent scans arrived" in output, output)
check("times have no verdict", "latencies, rates and times have no verdict" in output, output)
check("it passes", code == 0, output)

state_that_front_right_is_aligned()
code, output = demo("--speed", "4", "--truth", DRIVE)
check("a radar that is aligned in the truth and reported MISALIGNED fails", code == 1, output)
check("the failed check is named",
      "[FAILED] front_right is within tolerance in the truth and was never reported as MISALIGNED" in output, output)
sys.exit(1 if failures else 0)
