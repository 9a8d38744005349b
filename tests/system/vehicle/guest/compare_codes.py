#!/usr/bin/env python3
"""compare_codes.py BEFORE AFTER: prints each trouble code of BEFORE (lines of `boresight dtc list --json`) that AFTER
has lost, or with fewer occurrences or another first freeze frame; exit code 1 then."""
import json
import sys


def read(path):
    with open(path, encoding="utf-8") as lines:
        return {code["code"]: code for code in map(json.loads, lines)}


before, after = read(sys.argv[1]), read(sys.argv[2])
bad = 0 if before else 1
for name, code in before.items():
    now = after.get(name)
    if now is None:
        problem = "is lost"
    elif now["occurrences"] < code["occurrences"]:
        problem = f"occurred {code['occurrences']} times, now {now['occurrences']}"
    elif now["first"]["time_ns"] != code["first"]["time_ns"]:
        problem = "has another first freeze frame"
    else:
        continue
    bad = 1
    print(f"        {name} {code['name']}: {problem}")
print(f"        {len(before)} codes before, {len(after)} after")
sys.exit(bad)
