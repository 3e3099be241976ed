# SPDX-License-Identifier: BSD-3-Clause
"""A report: headings, paragraphs, tables and pictures, written as Markdown and as HTML."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..runs.files import write_bytes

_STYLE = """body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;color:#222}
table{border-collapse:collapse;margin:1rem 0;font-size:14px}td,th{padding:.25rem .6rem;border-bottom:1px solid #ddd}
td+td,th+th{text-align:right}img{max-width:100%}code{background:#f3f3f3;padding:0 .2rem}"""


@dataclass(frozen=True)
class Table:
    """A table; the first column is a name, the others are numbers."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]

    def markdown(self) -> str:
        """The document as Markdown."""
        lines = [self.head, ["---", *["---:"] * (len(self.head) - 1)], *self.rows]
        return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)

    def html(self) -> str:
        """The document as HTML."""
        head = "".join(f"<th>{_inline(cell)}</th>" for cell in self.head)
        rows = ("<tr>" + "".join(f"<td>{_inline(cell)}</td>" for cell in row) + "</tr>" for row in self.rows)
        return f"<table>\n<tr>{head}</tr>\n" + "\n".join(rows) + "\n</table>"


@dataclass
class Document:
    """A report as a sequence of blocks, in the order of their addition."""

    title: str
    _markdown: list[str] = field(default_factory=list)
    _html: list[str] = field(default_factory=list)

    def heading(self, text: str) -> None:
        """Add the heading of a section."""
        self._add(f"## {text}", f"<h2>{_inline(text)}</h2>")

    def paragraph(self, text: str) -> None:
        """Add a paragraph; `code` in backquotes."""
        self._add(text, f"<p>{_inline(text)}</p>")

    def points(self, texts: Sequence[str]) -> None:
        """Add a list; nothing when it is empty."""
        if not texts:
            return
        items = "\n".join(f"<li>{_inline(text)}</li>" for text in texts)
        self._add("\n".join(f"- {text}" for text in texts), f"<ul>\n{items}\n</ul>")

    def table(self, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Add a table."""
        made = Table(head, rows)
        self._add(made.markdown(), made.html())

    def picture(self, path: Path, text: str) -> None:
        """Add a picture whose file lies beside the report."""
        self._add(f"![{text}]({path.name})", f'<p><img src="{html.escape(path.name)}" alt="{html.escape(text)}"></p>')

    def _add(self, markdown: str, as_html: str) -> None:
        self._markdown.append(markdown)
        self._html.append(as_html)

    def write(self, folder: Path, name: str = "report") -> Path:
        """Write the Markdown and the HTML; returns the path of the Markdown."""
        markdown = "\n\n".join([f"# {self.title}", *self._markdown]) + "\n"
        title = html.escape(self.title)
        page = (
            f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>{title}</title>\n'
            f"<style>\n{_STYLE}\n</style>\n<h1>{title}</h1>\n" + "\n".join(self._html) + "\n</html>\n"
        )
        write_bytes(folder / f"{name}.html", page.encode())
        write_bytes(folder / f"{name}.md", markdown.encode())
        return folder / f"{name}.md"


def _inline(text: str) -> str:
    """HTML of a line: what stands between backquotes is code."""
    parts = html.escape(text, quote=False).split("`")
    return "".join(f"<code>{part}</code>" if k % 2 else part for k, part in enumerate(parts))
