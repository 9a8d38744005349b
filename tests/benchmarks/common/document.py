"""Replaces the tables of a document, between its marks, by those that a benchmark's --markdown wrote."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
REGION = re.compile(r"<!-- begin: ([\w ]+) -->\n(.*?)<!-- end: \1 -->", re.DOTALL)


PROFILES = ("ideal", "series_77ghz")  # radar profiles shown side by side; bars are judged on the first


REAL_CAR = " + real car"  # ends the name of drives with --real-car


def results_of(folder, profile):
    """The files of the runs with a radar profile, each with its content. REAL_CAR may follow the profile."""
    results = [(file, json.loads(file.read_text())) for file in sorted(folder.rglob("bars.json"))]
    return [(file, result) for file, result in results if result["profile"] == profile]


def read_results(folder):
    """Returns the curves and the Markdown tables by name; rows of several tables of bars are joined in order."""
    curves, regions = [], {}
    for file, result in results_of(folder, PROFILES[0]):
        curves += result["curves"]
        for name, body in REGION.findall(file.with_suffix(".md").read_text()):
            if name == "bars" and name in regions:
                body = regions[name] + "".join(body.splitlines(keepends=True)[2:])
            regions[name] = body
    return curves, regions


def read_tables(folder, profile):
    """The tables by name, each a list of rows; a row is a dictionary by column. Empty first cells repeat the row above."""
    tables = {}
    for _, result in results_of(folder, profile):
        for table in result["tables"]:
            rows = [dict(zip(table["header"], row)) for row in table["rows"]]
            first = table["header"][0]
            for above, row in zip(rows, rows[1:]):
                row[first] = row[first] or above[first]
            tables[table["name"]] = rows
    return tables


def side_by_side(folder, table, key, columns, keep=lambda row: True):
    """One Markdown table with a column for each radar profile. `columns`: by shown title, columns of the benchmark's table,
    which share a cell."""
    rows = {profile: {row[key]: row for row in read_tables(folder, profile).get(table, []) if keep(row)} for profile in PROFILES}
    lines = [[key] + [f"{title}: {profile}" for title in columns for profile in PROFILES]]
    lines.append(["---"] * len(lines[0]))
    for name in rows[PROFILES[0]]:
        lines.append([name] + [" / ".join(rows[profile].get(name, {}).get(column, "—") for column in cell)
                               for cell in columns.values() for profile in PROFILES])
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def run_profiles(command, options, results):
    """Runs a benchmark once for each radar profile, in folders of their names. `options`: by profile, which REAL_CAR may
    follow, a list of runs with their options."""
    for profile, runs in options.items():
        for number, words in enumerate(runs):
            folder = results / profile / str(number)
            folder.mkdir(parents=True, exist_ok=True)
            car = ["--real-car"] if profile.endswith(REAL_CAR) else []
            subprocess.run([*command, "--profile", profile.removesuffix(REAL_CAR), *car, *words, "--json", str(folder / "bars.json"), "--markdown",
                            str(folder / "bars.md")], check=True)


def machine():
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    commit = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--match=", "--dirty= with uncommitted changes"],
                            capture_output=True, text=True, check=False).stdout.strip()
    return f"Measured at commit {commit or 'unknown'}; CPU times on {model.group(1) if model else 'an unknown processor'}.\n"


def rewrite(document, regions, whole=True):
    """Replaces the tables. If they are those of the `whole` document, states where they were measured. Reports on stderr the
    tables that the document does not show, and places without a new table."""
    if whole:
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
