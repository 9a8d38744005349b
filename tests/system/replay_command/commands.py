"""commands.py REPLAY SOURCE_DIR: exit codes and messages of boresight-replay for valid and invalid command lines.

Runs in a separate /tmp. Exit code 0 if every check passed, 1 if one failed."""
import os
import pathlib
import subprocess
import sys

REPLAY, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
TMP = pathlib.Path("/tmp/replay_command")
GATEWAY = TMP / "runtime"  # without a gateway

# (command line, exit code, part of the message)
CASES = (
    ("--help", 0, "Exit codes:"),
    ("--version", 0, "boresight-replay "),
    ("--check LOG", 0, "configuration is valid"),
    ("--check --config CONFIG LOG", 0, "configuration is valid"),
    ("--unknown LOG", 2, "--unknown"),
    ("", 2, "no recording given"),
    ("--config LOG LOG", 2, "is a file; give the folder"),
    ("--config ABSENT LOG", 2, "ABSENT"),
    ("--config WRONG_KEY LOG", 2, "replay.toml:1: someip.first_prot: unknown key; similar: 'first_port'"),
    ("--route 224.0.2.2 LOG", 2, "must be RECORDED=LOCAL"),
    ("--synthetic 10", 2, "only with --via someip"),
    ("--via someip --vehicle absent --interface lo --address 127.0.0.1 LOG", 2, "names there: "),
    ("--via someip --vehicle demo --interface lo --address 127.0.0.1 --step 1 LOG", 2, "subscriptions would expire"),
    ("ABSENT", 3, "ABSENT"),
    ("--wait 0 LOG", 3, "no gateway listens"),
)


def main():
    GATEWAY.mkdir(parents=True)
    (TMP / "drive.log").write_text("(1.000000) can0 123#0102\n")
    (TMP / "config/services").mkdir(parents=True)
    (TMP / "config/services/replay.toml").write_text("someip.first_prot = 30600\n")
    places = {"LOG": str(TMP / "drive.log"), "ABSENT": str(TMP / "absent"), "CONFIG": str(SOURCE / "config"),
              "WRONG_KEY": str(TMP / "config")}
    failed = 0
    for line, code, message in CASES:
        words = [places.get(word, word) for word in line.split()]
        result = subprocess.run([REPLAY, *words], capture_output=True, text=True, timeout=20, check=False,
                                env={**os.environ, "BORESIGHT_RUNTIME_DIR": str(GATEWAY)})
        output = result.stdout + result.stderr
        if result.returncode != code or places.get(message, message) not in output:
            failed += 1
            print(f"boresight-replay {line}: exit code {result.returncode}, expected {code} with '{message}':\n{output}")
    sys.exit(1 if failed else 0)


main()
