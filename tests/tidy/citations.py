"""Citations that resolve: what tidy.py asks of sources, links and equation numbers."""
import pathlib
import re

BIBLIOGRAPHY = pathlib.Path("docs/bibliography.md")
ALGORITHMS = pathlib.Path("docs/algorithms")
INDEX = ALGORITHMS / "README.md"
READ = {".cpp", ".hpp", ".py", ".sh", ".md", ".toml", ".txt", ".cmake", ".service", ".conf", ".idl", ""}
# These hold citations that are wrong on purpose.
FILES_LEFT_ALONE = {pathlib.Path("tests/tidy/citations_test.py"), pathlib.Path("tests/tidy/citations.py"), pathlib.Path("LICENSE")}

_NAME = r"[A-ZÀ-Ý][a-zà-ÿ]+"
_NAMES = rf"{_NAME}(?:(?:,\s+and\s+|,\s+|\s+and\s+|\s+&\s+){_NAME})*"
# "Huber 1964", "Nelder and Mead (1965)", "Steele, Lea, Flood 2014", "Ester et al. 1996"
_AUTHOR_YEAR = re.compile(rf"\b({_NAMES})(?:\s+et\s+al\.)?,?\s+\(?((?:19|20)\d\d)\b(?![.,]?\d|\s*[-–…×])")
_ET_AL = re.compile(rf"\b({_NAME})\s+et\s+al\.")
_STANDARD = re.compile(r"\b(?:PRS_|SWS_)[A-Za-z0-9]+|\b(?:ISO|IEEE|SAE|RFC) (?:J?\d[\d.]*[A-Z]*\d*[A-Z]*)\b")
_ARXIV = re.compile(r"\barXiv[: ]+(\d{4}\.\d{4,5})")
# Capitalised words that stand before a year and are no authors.
_NO_AUTHORS = set("""January February March April May June July August September October November December
    Since Until In From To Of By Before After About Over Under At Every Each Only First Last Of Table Figure Debian Ubuntu Port""".split())

_EQUATION = r"\([A-Z]?\d+\)"
_EQUATIONS = rf"{_EQUATION}(?:\s*(?:[–…,-]|and)?\s*{_EQUATION})*"
_PAGE_MENTION = re.compile(rf"\bdocs/algorithms/([\w-]+\.md)\b(?:[,:]?\s+({_EQUATIONS}))?")
_SOURCE_EQUATIONS = rf"(?:'s)?(?:,?\s+§[\d.]*\d)?[,:]?\s+({_EQUATIONS})"
_DEFINED = re.compile(r"\s{2,}\(([A-Z]?\d+)\)\s*$", re.M)
_LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+(?:\([^()\s]*\)[^()\s]*)*)(?:\s+\"[^\"]*\")?\)")
_PREFIXED = re.compile(r"\(([A-Z]\d+)\)")


def without_markers(path, text):
    """The text with comment markers at line starts blanked, so that a citation may go over lines; offsets stay."""
    if path.suffix in {".cpp", ".hpp", ".idl"}:
        return re.sub(r"^[ \t]*//[/!]?<?", lambda m: " " * len(m[0]), text, flags=re.M)
    if path.suffix in {".py", ".sh", ".toml", ".txt", ".cmake", ".service", ".conf", ""}:
        return re.sub(r"^[ \t]*#+", lambda m: " " * len(m[0]), text, flags=re.M)
    return text


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def names_in(text):
    return [n for n in re.findall(_NAME, text) if n not in {"Et", "And"}]


def expanded(equations):
    """'(22)(23)', '(29)–(32)': the numbers, ranges filled in."""
    numbers = []
    tokens = re.findall(rf"{_EQUATION}|[–…-]", equations)
    for i, token in enumerate(tokens):
        if token in "–…-":
            continue
        letter, number = re.fullmatch(r"\(([A-Z]?)(\d+)\)", token).groups()
        if i > 1 and tokens[i - 1] in "–…-" and numbers:
            before = int(re.sub(r"\D", "", numbers[-1]))
            numbers += [f"{letter}{n}" for n in range(before + 1, int(number))]
        numbers.append(f"{letter}{number}")
    return numbers


class Bibliography:
    def __init__(self, text):
        self.text = text
        self.entries = []  # (names, year)
        self.first_names = set()
        for row in text.split("\n"):
            if not row.startswith("| **"):
                continue
            cell = row.split("|")[1]
            year = re.search(r"\b(?:19|20)\d\d\b", cell)
            names = names_in(cell.replace("**", ""))
            self.first_names.update(names)
            if year:
                self.entries.append((set(names), year[0]))

    def has(self, names, year):
        return any(set(names) <= entry and year == of for entry, of in self.entries)


class Pages:
    """docs/algorithms: the equations that each page defines, and by whose numbers."""
    def __init__(self, root):
        self.defined = {p.name: _DEFINED.findall(p.read_text()) for p in sorted((root / ALGORITHMS).glob("*.md"))}
        self.index = []  # (line, page, numbers, source)
        index = root / INDEX
        for line, row in enumerate(index.read_text().split("\n") if index.is_file() else [], 1):
            cells = [c.strip() for c in row.split("|")]
            page = re.match(r"\[[^\]]*\]\(([\w-]+\.md)\)", cells[1]) if len(cells) >= 6 else None
            if page:
                self.index.append((line, page[1], expanded(cells[3]), cells[4]))

    def of_source(self, source):
        return {n for _, page, numbers, by in self.index if by == source for n in numbers if n in self.defined.get(page, ())}

    def sources(self):
        return {by for _, _, _, by in self.index if re.search(r"(?:19|20)\d\d$", by)}


def findings_of_sources(path, text, bibliography):
    if path == BIBLIOGRAPHY:
        return
    for found in _AUTHOR_YEAR.finditer(text):
        names = [n for n in names_in(found[1]) if n not in _NO_AUTHORS]
        if names and not bibliography.has(names, found[2]):
            yield found.start(), f"'{' '.join(found[0].split())}' has no entry in {BIBLIOGRAPHY}"
    for found in _ET_AL.finditer(text):
        if found[1] not in bibliography.first_names:
            yield found.start(), f"'{found[1]} et al.' has no entry in {BIBLIOGRAPHY}"
    for found in _STANDARD.finditer(text):
        if found[0] not in bibliography.text:
            yield found.start(), f"'{found[0]}' has no entry in {BIBLIOGRAPHY}"
    for found in _ARXIV.finditer(text):
        if found[1] not in bibliography.text:
            yield found.start(), f"arXiv {found[1]} has no entry in {BIBLIOGRAPHY}"


def findings_of_equations(text, pages):
    for found in _PAGE_MENTION.finditer(text):
        page = found[1]
        if page not in pages.defined:
            yield found.start(), f"there is no docs/algorithms/{page}"
            continue
        for number in expanded(found[2] or ""):
            if number not in pages.defined[page]:
                yield found.start(), f"docs/algorithms/{page} has no equation ({number})"
    for source in sorted(pages.sources()):
        known = pages.of_source(source)
        pattern = r"\s+".join(re.escape(word) for word in source.split())
        for found in re.finditer(pattern + _SOURCE_EQUATIONS, text):
            for number in expanded(found[1]):
                if number not in known:
                    yield found.start(), f"equation ({number}) of {source} stands in no page of docs/algorithms"


def findings_of_pages(path, text, pages):
    """Of the pages themselves: the index is true, and no number is defined twice or nowhere."""
    if path == INDEX:
        for line, page, numbers, _ in pages.index:
            for number in numbers:
                if number not in pages.defined.get(page, ()):
                    yield _offset(text, line), f"the index lists ({number}) for {page}, which does not define it"
    elif path.parent == ALGORITHMS:
        listed = {n for _, page, numbers, _ in pages.index if page == path.name for n in numbers}
        seen = set()
        for found in _DEFINED.finditer(text):
            if found[1] not in listed:
                yield found.start(1), f"({found[1]}) is not listed in {INDEX}"
            if found[1] in seen:
                yield found.start(1), f"({found[1]}) is defined twice"
            seen.add(found[1])
    if path.parent == ALGORITHMS:
        everywhere = {n for numbers in pages.defined.values() for n in numbers}
        for found in _PREFIXED.finditer(text):
            if found[1] not in everywhere:
                yield found.start(), f"({found[1]}) is defined in no page"


def _offset(text, line):
    return len("\n".join(text.split("\n")[:line - 1])) + (1 if line > 1 else 0)


def blanked(pattern, text):
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m[0]), text, flags=re.S | re.M)


def headings(text):
    """The anchors that a page's headings get."""
    anchors = set()
    for title in re.findall(r"^#{1,6}\s+(.+?)\s*#*\s*$", blanked(r"^[ \t]*```.*?^[ \t]*```", text), re.M):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        anchor = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        number, unique = 0, anchor
        while unique in anchors:
            number += 1
            unique = f"{anchor}-{number}"
        anchors.add(unique)
    anchors.update(re.findall(r"<a\s+(?:name|id)=\"([^\"]+)\"", text))
    return anchors


def findings_of_links(root, path, text):
    plain = blanked(r"`[^`\n]*`", blanked(r"^[ \t]*```.*?^[ \t]*```", text))
    # A link's text may be code; its target may not.
    for found in _LINK.finditer(blanked(r"^[ \t]*```.*?^[ \t]*```", text)):
        target = found[1]
        if not plain[found.end() - 1] == ")" or re.match(r"[a-z][a-z0-9+.-]*:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (root / path.parent / name) if name else root / path
        if not file.exists():
            yield found.start(), f"link to {target}: no such file"
        elif anchor and file.suffix == ".md" and anchor not in headings(file.read_text()):
            yield found.start(), f"link to {target}: no such heading"


def findings_of_places(root, text):
    for found in re.finditer(r"`([\w.-]+/[\w./-]+)`", text):
        if not (root / found[1]).exists():
            yield found.start(), f"{found[1]} does not exist"


def findings(root, files):
    bibliography = Bibliography((root / BIBLIOGRAPHY).read_text() if (root / BIBLIOGRAPHY).is_file() else "")
    pages = Pages(root)
    for path in files:
        if path.suffix not in READ or path in FILES_LEFT_ALONE:
            continue
        raw = (root / path).read_text(errors="replace")
        text = without_markers(path, raw)
        found = list(findings_of_sources(path, text, bibliography))
        found += findings_of_equations(text, pages)
        found += findings_of_pages(path, raw, pages)
        if path.suffix == ".md":
            found += findings_of_links(root, path, raw)
        if path == BIBLIOGRAPHY:
            found += findings_of_places(root, raw)
        for offset, words in sorted(found):
            yield f"{path.as_posix()}:{line_of(raw, offset)}: {words}"
