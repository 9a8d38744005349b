"""Compares the worked examples of a document with what a script makes of the document's text, or puts them in."""
import pathlib
import re
import sys


def dump(data):
    return "".join(f"{at:04x}  {data[at:at + 16].hex(' ')}\n" for at in range(0, len(data), 16))


def run(examples):
    """The script's main: arguments DOCUMENT [--write]; exits with 1 if an example differs."""
    write = "--write" in sys.argv
    path = pathlib.Path([argument for argument in sys.argv[1:] if argument != "--write"][0])
    text = path.read_text(encoding="utf-8")
    wrong = 0
    for name, data in examples.items():
        block = re.compile(rf"(<!-- example: {re.escape(name)} -->\n```\n).*?(```\n)", re.DOTALL)
        found = block.search(text)
        if not found:
            sys.exit(f"{path}: no example \"{name}\"")
        wanted = found.group(1) + dump(data) + found.group(2)
        if found.group(0) != wanted:
            wrong += 1
            print(f"{path}: example \"{name}\" is not what the definition gives")
        text = text.replace(found.group(0), wanted)
    if write:
        path.write_text(text, encoding="utf-8")
    elif wrong:
        sys.exit(1)
