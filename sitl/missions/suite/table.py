# SPDX-License-Identifier: BSD-3-Clause
"""Results of a suite as lines, as JUnit XML, and as an HTML index of the reports."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from ..comparison.junit import Case as JunitCase
from ..comparison.junit import write as write_junit
from .result import FAILED, Result

_HEADS = ("place [m]", "cross [m]", "height [m]", "delay [s]", "energy [%]")


def head(width: int) -> str:
    """First line of the table; ``width``: length of the longest name."""
    return f"{'mission':{width}}  {'':9}  " + "  ".join(_HEADS) + "   time [s]  wall [s]"


def line(result: Result, width: int) -> str:
    """Line of a result, with the differences below it."""
    values = [f"{value:{len(name)}.2f}" for value, name in zip(result.figures.values(), _HEADS, strict=False)]
    values += [" " * len(name) for name in _HEADS[len(values) :]]
    found = f"{result.name:{width}}  {result.status:9}  " + "  ".join(values)
    found += f"  {result.simulated:9.1f}  {result.wall:8.2f}"
    for text in (result.words, result.note, f"report: {result.report}" if result.report else ""):
        found += f"\n    {text}" if text else ""
    return found


def summary(results: Sequence[Result], wall: float) -> str:
    """Last line of the table; ``wall``: wall time [s]."""
    bad = sum(not result.ok for result in results)
    simulated = sum(result.simulated for result in results)
    good = f"{len(results) - bad} of {len(results)} as they should be"
    return f"{good}: {simulated / 60.0:.0f} simulated minutes in {wall:.1f} s"


def write(folder: Path, suite: str, results: Sequence[Result]) -> Path:
    """Write junit.xml and index.html; gives the path of the page."""
    folder.mkdir(parents=True, exist_ok=True)
    cases = [
        JunitCase(
            suite,
            result.name,
            result.wall,
            failure=result.words if not result.ok and result.status != FAILED else "",
            error=result.words if result.status == FAILED else "",
            output=result.note,
        )
        for result in results
    ]
    write_junit(folder / "junit.xml", cases)
    path = folder / "index.html"
    path.write_text(_page(folder, suite, results), encoding="utf-8")
    return path


def _page(folder: Path, suite: str, results: Sequence[Result]) -> str:
    from ..comparison.report import STYLE

    bad = sum(not result.ok for result in results)
    title = f"{len(results) - bad} of {len(results)} missions fly like golden"
    heads = "".join(f"<th class=n>{name}</th>" for name in _HEADS)
    rows = []
    for result in sorted(results, key=lambda result: (result.ok, result.name)):
        name = escape(result.name)
        if result.report:
            name = (
                f'<a href="{escape(Path(result.report).resolve().relative_to(folder.resolve()).as_posix())}">{name}</a>'
            )
        values = [f'<td class="n">{value:.2f}</td>' for value in result.figures.values()]
        values += ["<td></td>"] * (len(_HEADS) - len(values))
        rows.append(
            f'<tr class="{"" if result.ok else "bad"}"><td class="mark">{"&#10003;" if result.ok else "&#10007;"}</td>'
            f"<td>{name}</td>{''.join(values)}<td class=where>{escape(result.words or result.note)}</td></tr>"
        )
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(suite)}: {title}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body><main>'
        f'<header class="{"bad" if bad else ""}"><h1>{title}</h1>'
        f'<p class="soft"><code>{escape(suite)}</code></p></header>'
        f"<h2>Missions</h2><section><table><tr><th></th><th>mission</th>{heads}<th>what differs</th></tr>"
        + "\n".join(rows)
        + "</table></section></main></body></html>\n"
    )
