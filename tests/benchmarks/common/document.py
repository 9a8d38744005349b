"""Replaces the tables of a document, between its marks, by those that a benchmark's --markdown wrote."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
REGION = re.compile(r"<!-- begin: ([\w ]+) -->\n(.*?)<!-- end: \1 -->", re.DOTALL)


def read_results(folder):
    """Returns the curves and the Markdown tables by name; rows of several tables of bars are joined in order."""
    curves, regions = [], {}
    for file in sorted(folder.rglob("bars.json")):
        curves += json.loads(file.read_text())["curves"]
        for name, body in REGION.findall(file.with_suffix(".md").read_text()):
            if name == "bars" and name in regions:
                body = regions[name] + "".join(body.splitlines(keepends=True)[2:])
            regions[name] = body
    return curves, regions


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"], capture_output=True, text=True,
                            check=False).stdout.strip()
    return f"Measured at commit {commit or 'unknown'}; CPU times on {model.group(1) if model else 'an unknown processor'}.\n"


def rewrite(document, regions):
    """Replaces the tables. Reports on stderr the tables that the document does not show, and places without a new table."""
    regions = {**regions, "measured": machine()}
    text = document.read_text()
    marks = {name for name, _ in REGION.findall(text)}
    where = document.relative_to(ROOT)
    for name in sorted(set(regions) - marks):
        print(f"not shown in {where}: table '{name}'", file=sys.stderr)
    for name in sorted(marks - set(regions)):
        print(f"unchanged in {where}, not measured: '{name}'", file=sys.stderr)
    document.write_text(REGION.sub(
        lambda found: f"<!-- begin: {found[1]} -->\n{regions.get(found[1], found[2])}<!-- end: {found[1]} -->", text))
