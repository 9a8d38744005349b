"""Named numeric constants of the tracker: there are few, and none is a tuning value.

A tuning value is a configuration parameter with its unit, its key and its origin. A constant in the code is a
mathematical constant, a unit, a capacity, or a guard that keeps a logarithm or a division finite.

What counts, at any scope:
- a `constexpr` or `constinit` variable whose initialiser holds a number,
- a `const` variable whose initialiser is made of numbers and other constants alone,
- an enumerator with a number of an unnamed enumeration (those of a named one are states),
- a macro that is a number.
Functions, parameters and members that configuration replaces do not count. Nor do names of infinity, of a type's limit
or of an enumerator: they hold no number."""
import re

MAX_CONSTANTS = 60
ROOM = "services/tracker/"
SOURCES = {".cpp", ".hpp"}

NUMBER = re.compile(r"(?<![\w.])(?:0[xXbB][\da-fA-F']+|(?:\d[\d']*\.?[\d']*|\.\d[\d']*)(?:[eE][+-]?\d+)?)[fFlLuUzZ]*(?!\w)")
# What an initialiser made of constants may hold beside numbers: types, casts, mathematical constants, other constants.
CONSTANT_WORD = re.compile(r"\b(?:std::(?:numbers::\w+|array|vector|initializer_list|size_t|u?int\d+_t)|(?:static_cast)|Real|"
                           r"double|float|int|long|unsigned|bool|auto|size_t|u?int\d+_t|true|false|"
                           r"(?:\w+::)*k[A-Z]\w*)\b")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![\da-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
TEMPLATE_ARGUMENTS = re.compile(r"(?<=\w)<[^<>;{}()=]*>")
QUALIFIER = re.compile(r"\bconst(expr|init)?\b")
NAME = re.compile(r"(\w+)\s*(?:\[[^\]]*\]\s*)*$")
MACRO = re.compile(r"^[ \t]*#[ \t]*define[ \t]+(\w+)[ \t]+([^\n]+)$", re.MULTILINE)
UNNAMED_ENUMERATION = re.compile(r"\benum\s*(?::\s*[\w:]+\s*)?\{([^}]*)\}")
ENUMERATOR = re.compile(r"(\w+)\s*=\s*([^,]+)")
OPEN, CLOSE = "([{", ")]}"


def blanked(match):
    """As many lines, but no text."""
    return " " + "\n" * match.group().count("\n")


def code_of(text):
    text = NOT_CODE.sub(blanked, text)
    before = None
    while before != text:
        before, text = text, TEMPLATE_ARGUMENTS.sub(blanked, text)
    return text


def end_of(text, start, stops):
    """Index of the first of `stops` outside brackets, or of the bracket that closes around `start`."""
    depth = 0
    for i in range(start, len(text)):
        if depth == 0 and text[i] in stops:
            return i
        if text[i] in OPEN:
            depth += 1
        elif text[i] in CLOSE:
            depth -= 1
            if depth < 0:
                return i
    return len(text)


def is_constant(initialiser, is_constexpr):
    if NUMBER.search(initialiser) is None or initialiser.lstrip().startswith("["):
        return False
    return is_constexpr or re.search(r"\w", NUMBER.sub(" ", CONSTANT_WORD.sub(" ", initialiser))) is None


def variables(code, start):
    """Name, initialiser and end of each variable of the declaration that goes on at `start`."""
    while True:
        at = end_of(code, start, "=;,{(")
        name = NAME.search(code, start, at)
        if at == len(code) or name is None or code[at] not in "={(":
            return
        if code[at] == "=":
            end = end_of(code, at + 1, ",;")
            initialiser = code[at + 1:end]
        else:
            end = end_of(code, at + 1, "") + 1
            initialiser = code[at + 1:end - 1]
            after = end_of(code, end, ",;{=")
            # Anything between the bracket and the end of the declaration makes it a function.
            if after == len(code) or code[after] not in ",;" or code[end:after].strip():
                return
            end = after
        if end == len(code) or code[end] not in ",;":
            return
        yield name.group(1), name.start(1), initialiser
        if code[end] == ";":
            return
        start = end + 1


def constants(text):
    """Line and name of each named numeric constant of a source text."""
    code = code_of(text)
    found = set()
    for qualifier in QUALIFIER.finditer(code):
        is_constexpr = qualifier.group(1) is not None
        for name, at, initialiser in variables(code, qualifier.end()):
            if is_constant(initialiser, is_constexpr):
                found.add((code.count("\n", 0, at) + 1, name))
    for macro in MACRO.finditer(code):
        if is_constant(macro.group(2), False):
            found.add((code.count("\n", 0, macro.start(1)) + 1, macro.group(1)))
    for enumeration in UNNAMED_ENUMERATION.finditer(code):
        for enumerator in ENUMERATOR.finditer(enumeration.group(1)):
            if NUMBER.search(enumerator.group(2)):
                at = enumeration.start(1) + enumerator.start(1)
                found.add((code.count("\n", 0, at) + 1, enumerator.group(1)))
    return sorted(found)


def findings(root, files):
    found = [f"{path}:{line} {name}" for path in files if path.as_posix().startswith(ROOM) and path.suffix in SOURCES
             for line, name in constants((root / path).read_text(errors="replace"))]
    if len(found) > MAX_CONSTANTS:
        yield f"{ROOM}: {len(found)} named numeric constants, at most {MAX_CONSTANTS}: " + ", ".join(found)
