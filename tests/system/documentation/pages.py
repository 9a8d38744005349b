"""What a page of the documentation asks its reader to type: commands with what they print, and files to write.

| in the page | meaning |
|---|---|
| ```sh | each line is a command, a line that ends in \\ goes on in the next; exit code 0 |
| `# exit code N` behind a command | it ends with N instead |
| ```console | commands behind `$ `; the lines below are what is printed, in this order; `…` stands for anything |
| <!-- not executed: REASON --> | the next block is not run; the reason must be one of ALLOWED_REASONS |
| <!-- file: NAME --> | the next block is the content of that file |
| <!-- appended to: NAME --> | the next block is written to the end of that file |

Other blocks (text, toml, mermaid …) are only read. A block without a language is an error, as nobody would run it."""
import dataclasses
import os
import pathlib
import re

ALLOWED_REASONS = (
    "builds the product",
    "builds and runs all tests",
    "needs systemd",
    "needs network interfaces of a vehicle",
    "needs a benchmark that only tests/run builds",
)
READ_ONLY = {"text", "toml", "mermaid", "json", "csv"}

_DIRECTIVE = re.compile(r"^<!--\s*(not executed|file|appended to):\s*(.*?)\s*-->$")
_EXIT_CODE = re.compile(r"#\s*exit code (\d+)\b")


class PageError(ValueError):
    """A page that the test cannot understand."""


@dataclasses.dataclass
class Command:
    line: int
    text: str
    exit_code: int = 0
    output: list = dataclasses.field(default_factory=list)
    not_executed: str = ""  # the reason


@dataclasses.dataclass
class File:
    line: int
    name: str
    text: str
    appended: bool


def _command(line, text):
    found = _EXIT_CODE.search(text)
    return Command(line, text, int(found[1]) if found else 0)


def _commands_of_sh(first, lines):
    text, start = "", first
    for number, row in enumerate(lines, first):
        if not text:
            start = number
        text += row + "\n"
        if row.endswith("\\"):
            continue
        if text.strip() and not text.lstrip().startswith("#"):
            yield _command(start, text.rstrip("\n"))
        text = ""
    if text:
        raise PageError(f"line {start}: the block ends within a command")


def _commands_of_console(first, lines):
    command = None
    for number, row in enumerate(lines, first):
        if row.startswith("$ "):
            if command:
                yield command
            command = _command(number, row[2:])
        elif command is None:
            raise PageError(f"line {number}: a console block begins with '$ '")
        elif command.text.endswith("\\"):
            command = dataclasses.replace(_command(command.line, command.text + "\n" + row))
        else:
            command.output.append(row)
    if command:
        yield command


def steps(text):
    """Commands and Files of a page, in order."""
    rows = text.split("\n")
    kind = value = ""
    index = 0
    while index < len(rows):
        row = rows[index].strip()
        index += 1
        directive = _DIRECTIVE.match(row)
        if directive:
            kind, value = directive[1], directive[2]
            if kind == "not executed" and value not in ALLOWED_REASONS:
                raise PageError(f"line {index}: '{value}' is no allowed reason: {'; '.join(ALLOWED_REASONS)}")
            continue
        if not row.startswith("```"):
            if row and kind:
                raise PageError(f"line {index}: a block is expected below <!-- {kind}: {value} -->")
            continue
        language, first = row[3:].strip(), index + 1
        block = []
        while index < len(rows) and rows[index].strip() != "```":
            block.append(rows[index])
            index += 1
        if index == len(rows):
            raise PageError(f"line {first - 1}: the block does not end")
        index += 1
        if kind in ("file", "appended to"):
            yield File(first, value, "\n".join(block) + "\n", kind == "appended to")
        elif language in ("sh", "console"):
            for command in (_commands_of_sh if language == "sh" else _commands_of_console)(first, block):
                command.not_executed = value if kind else ""
                yield command
        elif language not in READ_ONLY:
            raise PageError(f"line {first - 1}: a block of '{language}'; sh and console are executed, "
                            f"{', '.join(sorted(READ_ONLY))} are only read")
        kind = value = ""
    if kind:
        raise PageError(f"the page ends below <!-- {kind}: {value} -->")


def pattern_of(row):
    """A printed line as a pattern: '…' is anything, the width of blanks does not matter."""
    parts = [r"\s+".join(map(re.escape, part.split())) for part in row.strip().split("…")]
    return re.compile(r"\s*" + r".*?".join(part + (r"\s*" if part else "") for part in parts) + r"$")


def missing_output(wanted, printed):
    """The first wanted line that was not printed behind the one before it; None if all were."""
    rows = iter(printed)
    for want in wanted:
        if want.strip() in ("", "…"):
            continue
        pattern = pattern_of(want)
        if not any(pattern.match(row) for row in rows):
            return want
    return None


OF_THE_SYSTEM = {os.strerror(number) for number in range(1, 134)}
_LITERAL = re.compile(r'"((?:\\.|[^"\\\n])*)"')
_INCLUDE = re.compile(r"^\s*#\s*include\b[^\n]*", re.M)


def literals(source):
    """The string literals of C++ text; neighbours that the compiler joins are one."""
    source = _INCLUDE.sub("", source)
    joined, end = [], None
    for found in _LITERAL.finditer(source):
        text = found[1].replace('\\"', '"')
        if end is not None and not source[end:found.start()].strip():
            joined[-1] += text
        else:
            joined.append(text)
        end = found.end()
    return joined


def messages(text):
    """(line, message) of a page of symptoms: the code in the first column of its tables."""
    for number, row in enumerate(text.split("\n"), 1):
        if not row.startswith("|") or set(row) <= set("|- "):
            continue
        for message in re.findall(r"`([^`]+)`", row.split("|")[1]):
            yield number, message


def unknown_fragment(message, corpus):
    """The first part of the message between its '…' that neither a literal of the program nor the system has."""
    fragments = [fragment.strip(" :") for fragment in message.split("…")]
    for fragment in fragments:
        if fragment and fragment not in OF_THE_SYSTEM and not any(fragment in literal for literal in corpus):
            return fragment
    return None


_LINK = re.compile(r"\]\(([^)\s]+)\)")


def anchors(text):
    """What links to a page may have behind '#': its headings, as GitHub spells them."""
    headings = re.findall(r"^#+\s+(.*)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def dead_links(root, name):
    """(line, link) of each link of the page within the project that leads nowhere."""
    root = pathlib.Path(root)
    for number, row in enumerate(load(root, name).split("\n"), 1):
        for link in _LINK.findall(row):
            file, _, anchor = link.partition("#")
            target = (root / name).parent / file if file else root / name
            if "://" in link:
                continue
            if not target.exists() or (anchor and anchor not in anchors(target.read_text(encoding="utf-8"))):
                yield number, link


def load(root, name):
    return (pathlib.Path(root) / name).read_text(encoding="utf-8")
