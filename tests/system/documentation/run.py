#!/usr/bin/env python3
"""run.py SOURCE_DIR BUILD_DIR [PAGE…]: executes every command of README.md and the guides as a reader would, each page in
a clean folder that looks like the checkout: `config`, `docs`, `interfaces`, and the build tree as `build`. Also follows
their links, and looks for the messages of the troubleshooting page in the programs' text. Exit code 1 if a page is not
true."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

import pages

PAGES = ("README.md", "docs/quick-start.md", "docs/test-engineer.md", "docs/integrator.md", "docs/diagnosis-engineer.md",
         "docs/operations.md", "docs/troubleshooting.md", "docs/CHANGELOG.md", "docs/architecture.md", "docs/decisions.md", "docs/dds.md")
WITHOUT_COMMANDS = ("docs/CHANGELOG.md", "docs/architecture.md", "docs/decisions.md", "docs/dds.md")
PAGE_OF_MESSAGES = "docs/troubleshooting.md"
PROGRAMS = ("services", "deploy", "interfaces")
LONGEST_PAGE_S = 90
# Others may publish on the usual domain of this network.
DDS_DOMAIN = "78"
MARK = "@documentation@"


def script_of(steps):
    """One bash for the whole page, so that folders, variables and jobs live on; a mark before and after each command."""
    rows = ["set -m", "exec </dev/null 2>&1"]
    for index, step in enumerate(steps):
        if isinstance(step, pages.File):
            redirect = ">>" if step.appended else ">"
            rows += [f"mkdir -p \"$(dirname '{step.name}')\"", f"cat {redirect} '{step.name}' <<'{MARK}'", step.text + MARK]
        elif not step.not_executed:
            rows += [f"echo '{MARK} begin {index}'", step.text, f"printf '\\n%s\\n' \"{MARK} end {index} $?\""]
    return "\n".join(rows) + "\n"


def results_of(text):
    """{index of a step: (exit code, lines printed)} of all commands that came to their end."""
    found = re.finditer(rf"{MARK} begin (\d+)\n(.*?)\n{MARK} end \1 (\d+)\n", text, re.S)
    return {int(m[1]): (int(m[3]), m[2].split("\n")) for m in found}


def make_folder(folder, source, build):
    """What a reader's commands may use of a checkout."""
    for name in ("config", "docs", "interfaces", "deploy"):
        if (source / name).is_dir():
            shutil.copytree(source / name, folder / name)
    (folder / "build").symlink_to(build)


def end_session(session):
    """What a page left running, in whatever process group."""
    listing = subprocess.run(["ps", "-e", "-o", "pid=,sess="], capture_output=True, text=True, check=True).stdout
    for pid, owner in (map(int, row.split()) for row in listing.splitlines()):
        if owner == session and pid != session:
            try:
                os.kill(pid, signal.SIGTERM)
            except ProcessLookupError:
                pass


def run_page(steps, source, build):
    """What bash printed, marks included."""
    environment = {"PATH": os.environ["PATH"], "LANG": "C.UTF-8", "TERM": "dumb", "BORESIGHT_DDS_DOMAIN": DDS_DOMAIN}
    with tempfile.TemporaryDirectory(prefix="documentation-") as name:
        folder = pathlib.Path(name) / "boresight"
        folder.mkdir()
        make_folder(folder, source, build)
        output = pathlib.Path(name) / "output.txt"
        script = pathlib.Path(name) / "page.sh"
        script.write_text(script_of(steps), encoding="utf-8")
        # Into a file: a job in the background holds a pipe open.
        with output.open("wb") as stream:
            bash = subprocess.Popen(["bash", "--noprofile", "--norc", str(script)], cwd=folder, stdout=stream, stderr=stream,
                                    env={**environment, "HOME": name}, start_new_session=True)
            try:
                bash.wait(timeout=LONGEST_PAGE_S)
            except subprocess.TimeoutExpired:
                bash.kill()
            end_session(bash.pid)
            bash.wait()
        return output.read_text(encoding="utf-8", errors="replace")


def check_page(name, source, build):
    """Prints each command with its result; returns the number of faults."""
    try:
        steps = list(pages.steps(pages.load(source, name)))
    except pages.PageError as error:
        print(f"FAILED  {name}: {error}")
        return 1
    commands = [step for step in steps if isinstance(step, pages.Command)]
    if not commands:
        if name in WITHOUT_COMMANDS:
            return 0
        print(f"FAILED  {name}: no command in it")
        return 1
    printed = run_page(steps, source, build)
    results = results_of(printed)
    faults = 0
    for index, step in enumerate(steps):
        if isinstance(step, pages.File):
            continue
        what = f"{name}:{step.line}"
        text = step.text.split("\n")[0]
        if step.not_executed:
            print(f"        {what}: not executed ({step.not_executed}): {text}")
            continue
        problem = None
        if index not in results:
            problem = f"was not reached or did not end within {LONGEST_PAGE_S} s; bash printed at the end:"
            rows = printed.split("\n")
        else:
            code, rows = results[index]
            missing = pages.missing_output(step.output, rows)
            if code != step.exit_code:
                problem = f"exit code {code}, the page says {step.exit_code}; printed:"
            elif missing is not None:
                problem = f"does not print: {missing}\n        but:"
        print(f"{'FAILED' if problem else 'ok    '}  {what}: {text}")
        if problem:
            faults += 1
            print("        " + problem + "\n        | " + "\n        | ".join(rows[-25:]))
    return faults


def check_messages(source):
    """The messages that the page of symptoms quotes are those of the programs."""
    corpus = []
    for room in PROGRAMS:
        for file in (source / room).rglob("*.[ch]pp"):
            corpus += pages.literals(file.read_text(encoding="utf-8", errors="replace"))
    faults = 0
    quoted = list(pages.messages(pages.load(source, PAGE_OF_MESSAGES)))
    for line, message in quoted:
        fragment = pages.unknown_fragment(message, corpus)
        if fragment is not None:
            print(f"FAILED  {PAGE_OF_MESSAGES}:{line}: no program prints '{fragment}'")
            faults += 1
    print(f"{'ok    ' if quoted and not faults else 'FAILED'}  {PAGE_OF_MESSAGES}: {len(quoted)} messages")
    return faults + (not quoted)


def check_links(source, names):
    dead = [(name, line, link) for name in names for line, link in pages.dead_links(source, name)]
    for name, line, link in dead:
        print(f"FAILED  {name}:{line}: the link {link} leads nowhere")
    return len(dead)


def main(arguments):
    source, build = (pathlib.Path(a).resolve() for a in arguments[:2])
    names = arguments[2:]
    faults = sum(check_page(name, source, build) for name in names or PAGES)
    faults += check_links(source, names or PAGES)
    if not names:
        faults += check_messages(source)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.stdout.reconfigure(line_buffering=True)
    sys.exit(main(sys.argv[1:]))
