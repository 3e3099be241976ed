# SPDX-License-Identifier: BSD-3-Clause
"""A report as a document: its blocks, as HTML and Markdown."""

from __future__ import annotations

import html
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from ..runs.files import write_bytes
from ..runs.folder import RunFolder

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


Floats = npt.NDArray[np.float64]
BLOCK = 200
"""Episodes of the paper's blocks."""


def rewards_of(runs: Sequence[RunFolder]) -> Floats:
    """Rewards of the episodes of runs, shape (runs, episodes); those episodes that all have.

    Raises:
        AgentError: a run has none, or one whose reward is no number.
    """
    rows = [run.episodes.column("reward") for run in runs]
    for run, row in zip(runs, rows):
        if not len(row):
            raise AgentError(f"{run.path} has no episodes yet")
        if not np.isfinite(row).all():
            first = int(np.argmin(np.isfinite(row)))
            raise AgentError(f"{run.path}: the reward of episode {first} is {row[first]}; such runs cannot be compared")
    shortest = min(map(len, rows))
    return np.array([row[:shortest] for row in rows])


def block_means(rewards: Floats, block: int = BLOCK) -> Floats:
    """Means of each ``block`` episodes; the last block may be shorter.

    Args:
        rewards: shape (..., episodes).
        block: episodes.
    """
    starts = range(0, rewards.shape[-1], block)
    return np.stack([rewards[..., start : start + block].mean(axis=-1) for start in starts], axis=-1)


def block_names(episodes: int, block: int = BLOCK) -> list[str]:
    """Names of the blocks of ``block_means``: "0 to 200" are episodes 0 .. 199; the last block may be shorter."""
    return [f"{start} to {min(start + block, episodes)}" for start in range(0, episodes, block)]


def moving_mean(rewards: Floats, window: int) -> Floats:
    """Mean of each episode and those before it, up to ``window`` of them; shape as given."""
    sums = np.concatenate([np.zeros((*rewards.shape[:-1], 1)), np.cumsum(rewards, axis=-1)], axis=-1)
    last = np.arange(1, rewards.shape[-1] + 1)
    first = np.maximum(last - window, 0)
    out: Floats = (sums[..., last] - sums[..., first]) / (last - first)
    return out
