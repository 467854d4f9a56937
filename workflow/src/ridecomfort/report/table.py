"""A table with its heading, marks and sources, written as CSV, Markdown, LaTeX and HTML.

The CSV holds the numbers themselves (ten significant digits, empty where there is none); the
other forms hold them as printed, with marks and notes. ``<name>.trace.csv`` says for every group
of cells which file, which variable and which rule they come from.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import groupby

from . import notation

MISSING = "–"

PUBLISHED = "report/published.yaml"
"""The file of the paper's own figures."""

STYLE = (
    "body{font:14px/1.4 system-ui,sans-serif;margin:1rem}h1{font-size:1rem}table{border-collapse:collapse}"
    "th,td{padding:.2rem .6rem;text-align:left;vertical-align:top}th[colspan]{text-align:center}"
    "thead{border-top:1.5px solid;border-bottom:1px solid}tbody{border-bottom:1.5px solid}"
    "td.number{text-align:right;white-space:nowrap}tr.break td{border-top:1px solid #ccc}p{color:#555;margin:.3rem 0}"
)
"""How a table looks that stands alone in a document."""


@dataclass(frozen=True)
class Column:
    """A column: its name in the CSV, its heading from the top line down, its number format; whether it holds the paper's figures."""

    key: str
    heading: tuple[str, ...]
    format: str = ""
    of_paper: bool = False

    @property
    def numeric(self) -> bool:
        return bool(self.format)


class PapersNote(str):
    """A note that is only of use beside the paper's figures."""


@dataclass(frozen=True)
class Source:
    """Where a group of cells comes from: file, variable and the rule between it and the cell."""

    cells: str
    file: str
    variable: str
    rule: str

    @classmethod
    def paper(cls, variable: str, label: str) -> Source:
        """The origin of the paper's own figures: entry of ``published.yaml`` and label of the paper."""
        return cls("paper", PUBLISHED, variable, f"{label} as printed")


@dataclass(frozen=True)
class Table:
    """Rows of raw values (str, int, float or None) under columns.

    ``marks`` puts a sign behind the cell (row, column), ``bold`` prints cells in bold type,
    ``breaks`` are the rows above which a line is drawn.
    """

    name: str
    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple, ...]
    sources: tuple[Source, ...]
    notes: tuple[str, ...] = ()
    marks: Mapping[tuple[int, int], str] = field(default_factory=dict)
    bold: frozenset[tuple[int, int]] = frozenset()
    breaks: tuple[int, ...] = ()

    def __post_init__(self):
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"table {self.name}: a row of {len(row)} cells under {len(self.columns)} columns")

    def value(self, row: int, key: str):
        """The raw value of a cell by row number and column key."""
        return self.rows[row][[column.key for column in self.columns].index(key)]

    def printed(self, row: int, column: int) -> str:
        """The cell as printed, without mark."""
        value = self.rows[row][column]
        if value is None or value != value:
            return MISSING
        if isinstance(value, str):
            return value
        text = _format(value, self.columns[column].format)
        is_nil = not text.strip("-0.")  # rounded to none, it has no sign
        return text.replace("-", "" if is_nil else "−") if text.startswith("-") else text

    def heading_lines(self) -> list[list[tuple[str, int]]]:
        """The lines of the heading; each a list of text and the number of columns that it spans."""
        depth = max(len(column.heading) for column in self.columns)
        padded = [("",) * (depth - len(column.heading)) + column.heading for column in self.columns]
        lines = []
        for level in range(depth):
            upto = groupby(padded, key=lambda heading: heading[: level + 1])
            if level == depth - 1:
                lines.append([(heading[level], 1) for heading in padded])
            else:
                lines.append([(key[level], len(list(group))) for key, group in upto])
        return lines


def to_csv(table: Table) -> str:
    """The numbers, one line a row."""
    return _csv([column.key for column in table.columns], [[_raw(cell) for cell in row] for row in table.rows])


def trace_csv(table: Table) -> str:
    """The origin of every group of cells: cells, file, variable, rule."""
    rows = [
        [notation.plain(text) for text in (source.cells, source.file, source.variable, source.rule)]
        for source in table.sources
    ]
    return _csv(["cells", "file", "variable", "rule"], rows)


def to_markdown(table: Table) -> str:
    """A pipe table with caption, notes and sources below."""
    titles = [" ".join(filter(None, column.heading)) for column in table.columns]
    lines = [f"**{notation.plain(table.caption)}**", ""]
    lines.append(_pipes(notation.plain(title) for title in titles))
    lines.append(_pipes("---:" if column.numeric else ":---" for column in table.columns))
    for row in range(len(table.rows)):
        lines.append(_pipes(_markdown_cell(table, row, column) for column in range(len(table.columns))))
    lines.append("")
    lines += [f"{notation.plain(note)}  " for note in table.notes]
    lines += ["", "Sources:", ""]
    for source in table.sources:
        lines.append(notation.plain(f"- {source.cells}: {source.file}, {source.variable}; {source.rule}"))
    return "\n".join(lines) + "\n"


def to_latex(table: Table) -> str:
    """A booktabs table environment labelled as in the paper (``tab:<name>``)."""
    alignment = "".join("r" if column.numeric else "l" for column in table.columns)
    lines = [r"\begin{table}", r"  \centering", rf"  \caption{{{notation.latex(table.caption)}}}"]
    lines += [rf"  \label{{tab:{table.name}}}", rf"  \begin{{tabular}}{{{alignment}}}", r"    \toprule"]
    for heading in table.heading_lines():
        lines.append("    " + _latex_heading(heading))
    lines.append(r"    \midrule")
    for row in range(len(table.rows)):
        if row in table.breaks:
            lines.append(r"    \midrule")
        cells = (_latex_cell(table, row, column) for column in range(len(table.columns)))
        lines.append("    " + " & ".join(cells) + r" \\")
    lines += [r"    \bottomrule", r"  \end{tabular}"]
    lines += [rf"  \par\smallskip\footnotesize {notation.latex(note)}" for note in table.notes]
    lines.append(r"\end{table}")
    return "\n".join(lines) + "\n"


def to_document(table: Table) -> str:
    """An HTML document of its own: the table with caption, notes and a little style."""
    caption = notation.html(table.caption)
    head = f'<meta charset="utf-8"><title>{notation.html(notation.plain(table.caption))}</title><style>{STYLE}</style>'
    notes = "".join(f"<p>{notation.html(note)}</p>\n" for note in table.notes)
    body = f"<h1>{caption}</h1>\n{to_html(table)}{notes}"
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>{head}</head>\n<body>\n{body}</body>\n</html>\n'


def to_html(table: Table) -> str:
    """The table alone as HTML, for a page that has caption and style."""
    lines = ["<table>", "<thead>"]
    for heading in table.heading_lines():
        cells = "".join(
            f"<th{_span(width)}>{notation.html(text)}</th>" for text, width in heading
        )
        lines.append(f"<tr>{cells}</tr>")
    lines += ["</thead>", "<tbody>"]
    for row in range(len(table.rows)):
        cells = "".join(_html_cell(table, row, column) for column in range(len(table.columns)))
        line = ' class="break"' if row in table.breaks else ""
        lines.append(f"<tr{line}>{cells}</tr>")
    lines += ["</tbody>", "</table>"]
    return "\n".join(lines) + "\n"


WRITERS = {
    ".csv": to_csv,
    ".md": to_markdown,
    ".tex": to_latex,
    ".html": to_document,
    ".trace.csv": trace_csv,
}
"""Every form that a table is written in, by the ending of its file."""


def _format(value, form: str) -> str:
    """The number in its format; ``g`` never prints an exponent for what fits a table."""
    text = format(value, form)
    return f"{float(text):.0f}" if form.endswith("g") and "e+" in text else text


def _csv(header, rows) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def _raw(value) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, str):
        return notation.plain(value)
    return str(int(value)) if float(value).is_integer() else format(float(value), ".10g")


def _pipes(cells) -> str:
    return "| " + " | ".join(str(cell).replace("|", r"\|") for cell in cells) + " |"


def _markdown_cell(table: Table, row: int, column: int) -> str:
    text = notation.plain(table.printed(row, column))
    text = f"**{text}**" if (row, column) in table.bold else text
    return text + table.marks.get((row, column), "")


def _latex_cell(table: Table, row: int, column: int) -> str:
    text = notation.latex(table.printed(row, column))
    text = rf"\textbf{{{text}}}" if (row, column) in table.bold else text
    return text + notation.latex(table.marks.get((row, column), ""))


def _latex_heading(heading) -> str:
    cells, rules, position = [], [], 1
    for text, width in heading:
        text = notation.latex(text)
        cells.append(text if width == 1 else rf"\multicolumn{{{width}}}{{c}}{{{text}}}")
        if width > 1 and text:
            rules.append(rf"\cmidrule(lr){{{position}-{position + width - 1}}}")
        position += width
    return " & ".join(cells) + r" \\" + (" " + " ".join(rules) if rules else "")


def _span(width: int) -> str:
    return f' colspan="{width}"' if width > 1 else ""


def _html_cell(table: Table, row: int, column: int) -> str:
    text = notation.html(table.printed(row, column))
    text = f"<b>{text}</b>" if (row, column) in table.bold else text
    mark = table.marks.get((row, column), "")
    kind = ' class="number"' if table.columns[column].numeric else ""
    return f"<td{kind}>{text}{f'<sup>{mark}</sup>' if mark else ''}</td>"
