"""Words of the field, and sentences that can be read: what tidy.py asks of docs, comments and strings."""
import pathlib
import re

# Sources as they were once called; capitalised, unlike "report a fault".
FORMER_REPORTS = r"\bReport [A-D]\b"
# Home-made words, each with the field's own in its place. Identifiers in code are not looked at.
WORDS = (
    (r"\bcrooked\w*", "misaligned, mounting error"),
    (r"\btold\b", "classified as, reported, detected, given, distinguished"),
    (r"\bknock(s|ed|ing)?\b", "sudden misalignment, step change"),
    (r"(?<!mirror )(?<!mirrored )(?<!memory )\bimages?\b(?! sensor)", "mirror image, virtual target"),
    (r"\bpieces?\b", "fragments of an extended target, parts, segments"),
    (r"\b(who|what) is new\b", "tentative track, birth"),
    (r"\brealness\b", "1 - ghost probability"),
    (r"\bowners\b", "association"),
    (r"\bflanks?\b", "side"),
    (r"(?<!steering )\bwheels?\b(?![- ](speeds?|radi|ticks?|base|revolution|pulse))", "micro-Doppler, rotating wheels' range rates"),
    (r"\bpost[ -]factum\b", "batch calibration"),
    (r"\bleft out\b", "rejected, with the reason; not included"),
    (r"\bwho drives\b|\bwhat stands\b", "moving object, stationary object"),
    (FORMER_REPORTS, "author and year, as in docs/bibliography.md"),
)
# Openings that hide the subject; asked of docs only.
OPENINGS = re.compile(r"(?:^|[.:;!?]\s+|^[-*|]\s+)(What is|Who is|Of a|Of an|Of the|Nor)\s")
MAX_SENTENCE_WORDS = 40

# Rooms whose code is about to be written anew keep their comments until then; their public names and output do not.
ROOMS_LEFT_ALONE = ("services/ghost_filter/", "tests/unit/ghost_filter/")
# This list itself, its test, and the page that says which source a former name stood for.
FILES_LEFT_ALONE = {"tests/tidy/words.py", "tests/tidy/words_test.py", "LICENSE"}
# (path, words that may stand there)
ALLOWED = {
    ("docs/bibliography.md", "Report [A-D]"),
    ("docs/bibliography.md", "Image"),  # the name of a journal
    ("tests/system/vehicle/run.sh", "image"),  # of a Debian package
    # Former names of keys and options, beside those of today.
    ("docs/CHANGELOG.md", "knock|told|left out|flank|post.factum"),
    ("services/common/runtime/config/former_keys.hpp", "knock|told|left out|flank|post.factum"),
}

CPP = {".cpp", ".hpp"}
WHOLE = {".md", ".toml", ".txt", ".sh", ".service", ".conf", ".idl", ".cmake", ""}
_CPP_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
_PY_TOKEN = re.compile(r'""".*?"""|#[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
_INCLUDE = re.compile(r'^\s*#\s*include\b[^\n]*', re.M)


def prose(path, text):
    """(line, text) of what a reader reads: comments and strings of code, all of a text."""
    if path.suffix in CPP or path.suffix == ".py":
        if path.suffix in CPP:
            text = _INCLUDE.sub("", text)
        token = _CPP_TOKEN if path.suffix in CPP else _PY_TOKEN
        for found in token.finditer(text):
            if not found[0].startswith("'"):
                yield text.count("\n", 0, found.start()) + 1, found[0]
    elif path.suffix in WHOLE:
        yield 1, text


def findings_of_words(path, text):
    name = path.as_posix()
    if name in FILES_LEFT_ALONE or name.startswith(ROOMS_LEFT_ALONE):
        return
    for start, part in prose(path, text):
        for offset, line in enumerate(part.split("\n")):
            for pattern, instead in WORDS:
                found = re.search(pattern, line, 0 if pattern == FORMER_REPORTS else re.I)
                if found and not found[0].isupper() and not any(name == file and re.search(word, found[0]) for file, word in ALLOWED):
                    yield f"{name}:{start + offset}: '{found[0]}': say {instead}"


def sentences(text):
    """(line, sentence) of a page; tables, code and headings are not sentences."""
    text = re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    line = 1
    for block in re.split(r"(\n\s*\n)", text):
        paragraph, at = [], line
        for number, row in enumerate(block.split("\n")):
            starts = re.match(r"\s*([-*+]|\d+\.)\s", row)
            if row.lstrip().startswith(("|", "#", "<", "    ")) or starts:
                if paragraph:
                    yield from _split(at, " ".join(paragraph))
                paragraph = []
            if not row.lstrip().startswith(("|", "#", "<")):
                if not paragraph:
                    at = line + number
                paragraph.append(re.sub(r"^\s*([-*+]|\d+\.)\s+", "", row).strip())
        if paragraph:
            yield from _split(at, " ".join(paragraph))
        line += block.count("\n")


def _split(line, paragraph):
    paragraph = re.sub(r"`[^`]*`", "CODE", re.sub(r"\]\([^)]*\)", "]", paragraph))
    for sentence in re.split(r"(?<=[.!?])\s+(?=[A-Z*_`\[(])", paragraph):
        if sentence.strip():
            yield line, sentence.strip()


def is_page(path):
    name = path.as_posix()
    return path.suffix == ".md" and not name.startswith("services/ghost_filter/")


def findings_of_sentences(path, text):
    if not is_page(path):
        return
    for line, sentence in sentences(text):
        words = len([w for w in sentence.split() if re.search(r"\w", w)])
        if words > MAX_SENTENCE_WORDS:
            yield f"{path.as_posix()}:{line}: a sentence of {words} words, at most {MAX_SENTENCE_WORDS}: {sentence[:60]}…"
        if OPENINGS.search(sentence):
            yield f"{path.as_posix()}:{line}: opens with '{OPENINGS.search(sentence)[1]}': begin with the subject"


def findings(root, files):
    for path in files:
        if path.suffix not in CPP | WHOLE | {".py"}:
            continue
        text = (root / path).read_text(errors="replace")
        yield from findings_of_words(path, text)
        yield from findings_of_sentences(path, text)
