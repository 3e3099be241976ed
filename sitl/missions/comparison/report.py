# SPDX-License-Identifier: BSD-3-Clause
"""Reports of comparisons, and as JUnit XML."""

from __future__ import annotations

import base64
import math
from dataclasses import dataclass
from html import escape
from pathlib import Path
from xml.etree import ElementTree as xml

from sitl.core.whole_file import write_whole
from sitl.errors import MissingExtra, OptionError

from . import scene, words
from .compare import Comparison, Metric
from .events import SHIFTED, Event


@dataclass(frozen=True)
class Case:
    """One test."""

    suite: str
    name: str
    seconds: float = 0.0
    """Wall time [s]."""
    failure: str = ""
    """Description of the failure; "": it passed."""
    error: str = ""
    """Reason why it could not be run; "": it was run."""
    output: str = ""
    """Further output."""


def cases_of(comparison: Comparison) -> list[Case]:
    """A case for each metric that is judged."""
    found = []
    for metric in comparison.metrics:
        if metric.is_judged:
            value, limit = words.number(metric.value, metric.unit), words.number(metric.limit, metric.unit)
            text = f"{metric.title}: {value}, {limit} allowed. {metric.words}".strip()
            found.append(Case(comparison.new.name, metric.name, 0.0, "" if metric.ok else text, output=text))
    return found


def junit_write(path: str | Path, cases: list[Case]) -> None:
    """Write a file; cases of the same suite must stand together."""
    root = xml.Element("testsuites", name="sitl mission")
    for name in dict.fromkeys(case.suite for case in cases):
        mine = [case for case in cases if case.suite == name]
        suite = xml.SubElement(
            root,
            "testsuite",
            name=name,
            tests=str(len(mine)),
            failures=str(sum(bool(case.failure) for case in mine)),
            errors=str(sum(bool(case.error) for case in mine)),
            time=f"{sum(case.seconds for case in mine):.3f}",
        )
        for case in mine:
            _add(suite, case)
    xml.indent(root)
    content = xml.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"
    write_whole(path, content, OptionError, f"report {path}")


def _add(suite: xml.Element, case: Case) -> None:
    element = xml.SubElement(suite, "testcase", classname=case.suite, name=case.name, time=f"{case.seconds:.3f}")
    for tag, text in (("failure", case.failure), ("error", case.error)):
        if text:
            xml.SubElement(element, tag, message=_plain(text.splitlines()[0])).text = _plain(text)
    if case.output:
        xml.SubElement(element, "system-out").text = _plain(case.output)


def _plain(text: str) -> str:
    """A text without characters that XML cannot contain."""
    return "".join(c if c in "\t\n\r" or " " <= c <= "\ud7ff" or "\ue000" <= c <= "\ufffd" else "?" for c in text)


HTML, JUNIT = "report.html", "junit.xml"
STYLE = """
:root { color-scheme: light; --ink: #1c2430; --soft: #5d6b7c; --line: #dfe4ea; --good: #1e7d46; --bad: #b8321f; }
* { box-sizing: border-box; }
body { margin: 0; font: 15px/1.5 system-ui, "Segoe UI", Roboto, sans-serif; color: var(--ink); background: #f4f6f8; }
main { max-width: 1080px; margin: 0 auto; padding: 28px 20px 60px; }
header { border-radius: 10px; padding: 20px 26px; background: #fff; border-left: 10px solid var(--good);
  box-shadow: 0 1px 3px #0002; }
header.bad { border-color: var(--bad); }
h1 { font-size: 24px; margin: 0 0 6px; color: var(--good); }
header.bad h1 { color: var(--bad); }
h2 { font-size: 17px; margin: 34px 0 10px; }
p { margin: 4px 0; } .soft { color: var(--soft); } code { font-size: 13px; word-break: break-all; }
section { background: #fff; border-radius: 10px; box-shadow: 0 1px 3px #0002; padding: 14px 18px; overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 14px; }
th { text-align: left; color: var(--soft); font-weight: 600; font-size: 12.5px; }
th, td { padding: 5px 10px; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; }
td.n { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
th.n { text-align: right; } td.where { color: var(--soft); }
tr.bad td { background: #fdf1ef; } tr.bad td.n.value { color: var(--bad); font-weight: 700; }
.mark { font-weight: 700; color: var(--good); } tr.bad .mark { color: var(--bad); }
tr.idle .mark { color: var(--soft); }
.bar { display: inline-block; width: 84px; height: 7px; border-radius: 4px; background: #e8ecf0; vertical-align: 1px; }
.bar i { display: block; height: 7px; border-radius: 4px; background: var(--good); }
tr.bad .bar i { background: var(--bad); }
img { width: 100%; height: auto; display: block; } ul { margin: 6px 0; padding-left: 20px; }
"""


def lines(comparison: Comparison, everything: bool = False) -> list[str]:
    """The comparison for a terminal: verdict, then metrics (those beyond their limits, or all)."""
    found = [("OK: " if comparison.ok else "DIFFERS: ") + comparison.headline]
    if comparison.ok and comparison.first_trace is not None:
        found.append(f"  first difference at all: {comparison.first_trace.words}")
    for metric in comparison.metrics:
        if everything or not metric.ok:
            mark = " " if metric.ok else "!"
            value, limit = words.number(metric.value, metric.unit), words.number(metric.limit, metric.unit)
            found.append(f"  {mark} {metric.title:28} {value:>10}  allowed {limit:>9}  {metric.words}".rstrip())
    if comparison.advice:
        found.append(f"  {comparison.advice}")
    return found + [f"  note: {note}" for note in comparison.notes]


def report_write(comparison: Comparison, folder: str | Path, title: str = "") -> Path:
    """Write report.html and junit.xml into a folder; gives the path of the report. Of flights that differ it has a
    scene, too: flights.html, where the extra ``view`` is installed.

    Without matplotlib the report has no pictures, and says so.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    junit_write(folder / JUNIT, cases_of(comparison))
    path = folder / HTML
    shown = None if comparison.ok else scene.write(comparison, folder)
    text = html(comparison, title, shown.name if shown is not None else "")
    write_whole(path, text, OptionError, f"report {path}")
    return path


def html(comparison: Comparison, title: str = "", shown: str = "") -> str:
    """The report as HTML; ``shown``: a file beside it with the scene of both flights."""
    new, golden = comparison.new, comparison.golden
    title = title or Path(new.name).name
    verdict = "Flies like the golden flight" if comparison.ok else "Does not fly like the golden flight"
    failed = len(comparison.failed)
    judged = sum(metric.is_judged for metric in comparison.metrics)
    summary = f"{judged - failed} of {judged} metrics within tolerance <b>{escape(comparison.tolerance.name)}</b>"
    first = comparison.first or comparison.first_trace
    label = "First divergence" if comparison.first else "First difference at all, within tolerance"
    parts = [
        f'<header class="{"" if comparison.ok else "bad"}"><h1>{verdict}</h1>',
        f"<p><b>{label}:</b> {escape(first.words)}</p>" if first else "<p>No difference beyond rounding.</p>",
        f'<p class="soft">{summary}; {escape(comparison.pair.new.kind)}, {comparison.pair.new.t[-1]:.1f} s</p>',
        f'<p class="soft">new <code>{escape(new.name)}</code><br>',
        f"golden <code>{escape(golden.name)}</code></p>",
        f'<p><a href="{escape(shown)}">Both flights in one scene</a></p></header>' if shown else "</header>",
        _notes(comparison),
        "<h2>Metrics</h2><section><table><tr><th></th><th>metric</th><th class=n>value</th><th class=n>allowed</th>"
        "<th></th><th>where</th></tr>",
        *(_row(metric) for metric in comparison.metrics),
        "</table></section>",
        _pictures(comparison),
        "<h2>What happened</h2><section><table><tr><th></th><th class=n>golden</th><th class=n>new</th>"
        "<th class=n>shift</th><th>event</th></tr>",
        *(_event(comparison, event) for event in comparison.events),
        "</table></section>",
    ]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}: {verdict.lower()}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body><main>\n'
        + "\n".join(parts)
        + "\n</main></body></html>\n"
    )


def _notes(comparison: Comparison) -> str:
    if not comparison.notes:
        return ""
    return (
        "<h2>What is known of the two</h2><section><ul>"
        + "".join(f"<li>{escape(note)}</li>" for note in comparison.notes)
        + "</ul></section>"
    )


def _row(metric: Metric) -> str:
    state, mark = ("", "&#10003;") if metric.ok else ("bad", "&#10007;")
    if not metric.is_judged:
        state, mark = "idle", "&middot;"
    fraction = min(metric.value / metric.limit, 1.0) if metric.limit > 0.0 else float(not metric.ok)
    bar = ""
    if math.isfinite(metric.limit):
        bar = f'<span class="bar"><i style="width:{100.0 * fraction:.0f}%"></i></span>'
    value, limit = words.number(metric.value, metric.unit), words.number(metric.limit, metric.unit)
    return (
        f'<tr class="{state}"><td class="mark">{mark}</td><td>{escape(metric.title)}</td>'
        f'<td class="n value">{value}</td><td class="n">{limit}</td><td>{bar}</td>'
        f'<td class="where">{escape(metric.words)}</td></tr>'
    )


def _event(comparison: Comparison, event: Event) -> str:
    limit = comparison.tolerance.limit(f"{event.kind}.time")
    difference = event.difference(limit)
    is_bad = bool(difference) and math.isfinite(limit)
    times = [f"{t:.2f} s" if t is not None else "-" for t in (event.golden, event.new)]
    shift = f"{event.shift:+.2f} s" if event.golden is not None and event.new is not None else escape(difference)
    note = " (at another time)" if difference == SHIFTED else f" ({difference})" if difference else ""
    return (
        f'<tr class="{"bad" if is_bad else ""}"><td class="mark">{"&#10007;" if is_bad else "&#10003;"}</td>'
        f'<td class="n">{times[0]}</td><td class="n">{times[1]}</td><td class="n value">{shift}</td>'
        f"<td>{escape(event.what)}{escape(note)}</td></tr>"
    )


def _pictures(comparison: Comparison) -> str:
    try:
        from . import plots

        drawn = [
            ("The path, from above", plots.plan(comparison)),
            ("What differs", plots.differing(comparison)),
            ("What was flown", plots.flown(comparison)),
        ]
    except MissingExtra as error:
        return f"<h2>Pictures</h2><section><p>{escape(str(error))}</p></section>"
    return "".join(
        f"<h2>{heading}</h2><section>"
        f'<img alt="{heading}" src="data:image/png;base64,{base64.b64encode(data).decode()}"></section>'
        for heading, data in drawn
    )
