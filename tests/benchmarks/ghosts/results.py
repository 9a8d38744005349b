"""What the programs wrote: tables, curves, and the bars in the tables."""
import json

import document


class Results:
    def __init__(self, folder):
        self.tables, self.curves, self.regions = [], [], {}
        for file in sorted(folder.glob("*.json")):
            content = json.loads(file.read_text())
            self.tables += content["tables"]
            self.curves += content["curves"]
        for file in sorted(folder.glob("*.md")):
            self.regions |= dict(document.REGION.findall(file.read_text()))


def judged(tables):
    """(table, row) of each figure with a bar; a row is a dictionary by column."""
    for table in tables:
        for cells in table["rows"]:
            row = dict(zip(table["header"], cells))
            if row.get("result", "—") != "—":
                yield table, row


def verdict(tables):
    """Number of bars that are met, and the list of the others, as Markdown."""
    rows = list(judged(tables))
    count = {result: sum(row["result"] == result for _, row in rows) for result in ("met", "missed", "no data")}
    lines = [f"{count['met']} of {count['met'] + count['missed']} bars met, {count['no data']} without data."
             + (" Missed:" if count["missed"] else "")]
    if count["missed"]:
        lines.append("")
    of_table = {}
    for table, row in rows:
        if row["result"] == "missed":
            of_table.setdefault(table["name"], []).append(row)
    for name, missed in of_table.items():
        what = next(iter(missed[0]))
        measured = next(column for column in ("all drives", "evidence", "measured") if column in missed[0])
        lines.append(f"- {name}: " + "; ".join(f"{row[what]} {row[measured]} ({row['bar']})" for row in missed))
    return "\n".join(lines) + "\n"
