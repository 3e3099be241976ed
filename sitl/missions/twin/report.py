# SPDX-License-Identifier: BSD-3-Clause
"""What a twin came to: lines for a terminal, and one HTML file without anything from elsewhere."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

import numpy as np

from sitl.core.whole_file import write_whole
from sitl.errors import MissingExtra, OptionError

from ..comparison.report import STYLE
from .agreement import Agreement
from .limits import Verdict
from .twin import MODEL_S, SEGMENT_S, Twin

_MEANING = (
    "Whole flight: from arming to disarming; errors add up. "
    "In step: both from the beginning of each item of the mission, whichever of the two comes to it first. "
    f"Open segments: every {SEGMENT_S:g} s the twin is put into the logged state (position, velocity, attitude, rates, "
    "motors) and flies on by itself, so that errors do not add up. "
    f"Model alone: for {MODEL_S:g} s the motors do what the log's did, whatever the autopilot wants. "
    "Desired: what the autopilot asks for. "
    "RMS: root mean square of twin minus log. VAF: variance accounted for, 100 % when the twin moves exactly as the "
    "log, 0 % when it tells nothing of it; - where what was logged hardly moved. Largest: the largest difference; the "
    "pointer over it shows when."
)


_OWN_STYLE = """header.unsure { border-color: #b8860b; } header.unsure h1 { color: #8a6508; }
header b.verdict { font-size: 17px; } td:first-child { min-width: 150px; }"""
_SHOWN = ("height", "position", "speed")
_EFFECTS = (
    ("height", "greatest height", np.max), ("speed", "greatest speed", np.max),
    ("roll", "largest roll", lambda x: np.max(np.abs(x))), ("pitch", "largest pitch", lambda x: np.max(np.abs(x))),
    ("throttle", "mean throttle output", np.mean), ("current", "mean battery current", np.mean),
    ("voltage", "lowest battery voltage", np.min), ("consumed", "charge drawn", lambda x: x[-1, 0]),
)  # fmt: skip
"""Quantity, what is reported of it, and how it follows from the values."""


def verdict_of(twin: Twin) -> str:
    """Whether the twin flies as the log's vehicle did, in a sentence."""
    flies, count = "flies" if twin.log.kind == "copter" else "drives", len(twin.differences)
    if not count:
        return f"The twin {flies} as the log's vehicle did, as far as these metrics tell"
    return f"The twin {flies} otherwise than the log's vehicle did: {count} difference{'s' * (count > 1)}"


def _sizes(twin: Twin) -> str:
    """How far the two are apart, in a sentence."""
    texts = []
    for part, where in ((twin.whole, "over the whole flight"), (twin.legs, "in step by mission items")):
        found = {one.quantity.name: one for one in part}
        sizes = [
            f"{name} by {_number(found[name].rms, 2)} {found[name].quantity.unit}" for name in _SHOWN if name in found
        ]
        if sizes:
            texts.append(f"{', '.join(sizes)} {where}")
    return f"They differ (RMS) in {'; '.join(texts)}." if texts else ""


def effects(twin: Twin) -> list[tuple[str, str, float, float]]:
    """What a change does: (what, unit, of the twin, of the changed twin), within the time of the log."""
    found = {one.quantity.name: one for one in twin.difference}
    return [
        (title, found[name].quantity.unit, float(of(found[name].logged)), float(of(found[name].flown)))
        for name, title, of in _EFFECTS
        if name in found
    ]


def _number(value: float, digits: int = 3) -> str:
    return "-" if not math.isfinite(value) else f"{value:.{digits}g}"


def _vaf(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return "below 0" if value < 0.0 else f"{min(value, 99.99):.1f}" if value < 99.95 else "100"


def lines(twin: Twin, verdicts: Sequence[Verdict]) -> list[str]:
    """For a terminal: what was not taken over first, then metrics, findings and limits."""
    log = twin.log
    found = [
        f"{log.name}: {log.columns.firmware or log.kind}, flight of {log.span.length:.1f} s; twin on frame {twin.frame}"
    ]
    found.append(f"  {verdict_of(twin)}. {_sizes(twin)}".rstrip())
    found += [f"  note: {note}" for note in twin.notes]
    found += [f"  twin: {note}" for note in twin.went]
    parts = [("whole flight", twin.whole)]
    if twin.legs:
        parts.append(("in step by items", twin.legs))
    if twin.segments:
        parts.append((f"segments of {SEGMENT_S:g} s", twin.segments))
    if twin.difference:
        parts.append(("changed twin - twin", twin.difference))
    width = max((len(one.quantity.title) for one in twin.whole), default=0)
    head = " " * (width + 8)
    found += [head + "".join(f"{title:>22}" for title, _ in parts), head + f"{'RMS':>12}{'VAF [%]':>10}" * len(parts)]
    for one in twin.whole:
        q = one.quantity
        cells = [next((a for a in part if a.quantity.name == q.name), None) for _, part in parts]
        found.append(
            f"{q.title:{width}} {'[' + q.unit + ']':7}"
            + "".join(f"{_number(a.rms):>12}{_vaf(a.vaf):>10}" if a is not None else " " * 22 for a in cells)
        )
    found += [f"  {text}" for text in twin.findings]
    if twin.changed is not None:
        found.append(f"changed: {', '.join(twin.change.words)}")
        found += [f"  changed twin: {note}" for note in twin.went_changed]
        found += [f"  {what:32} {'[' + unit + ']':7}{a:>12.4g} -> {b:.4g}" for what, unit, a, b in effects(twin)]
    found += [f"{'ok' if verdict.ok else 'LIMIT'}: {verdict.words}" for verdict in verdicts]
    return found


def write(twin: Twin, verdicts: Sequence[Verdict], path: str | Path) -> None:
    """Write the report.

    Raises:
        OptionError: it cannot be written.
    """
    write_whole(path, html(twin, verdicts), OptionError, f"report {str(path)!r}")


def html(twin: Twin, verdicts: Sequence[Verdict]) -> str:
    """The report. Without matplotlib it has no pictures, and says so."""
    log = twin.log
    failed = [verdict for verdict in verdicts if not verdict.ok]
    title = f"Twin of {log.name}"
    judged = "unsure" if twin.differences else ""
    parts = [
        f'<header class="{"bad" if failed else judged}"><h1>{escape(title)}</h1>'
        f'<p><b class="verdict">{escape(verdict_of(twin))}.</b></p><p>{escape(_sizes(twin))}</p>',
        f"<p>{len(verdicts) - len(failed)} of {len(verdicts)} limits are kept</p>" if verdicts else "",
        f'<p class="soft">{escape(log.columns.firmware)}, flight {log.number} of {len(log.flights)}, '
        f"{log.span.length:.1f} s from arming; twin on airframe <b>{escape(twin.frame)}</b>; "
        "both are aligned by the moment of arming</p>",
        f"<p><b>Changed:</b> {escape(', '.join(twin.change.words))}</p></header>" if twin.changed else "</header>",
        _list("Limits that are not kept", [verdict.words for verdict in failed]),
        _list("Where model or autopilot differ", twin.findings or ["Nowhere, as far as these metrics tell."]),
        _list("What the twin did otherwise", twin.went),
        _effects(twin),
        *_pictures(twin),
        "<h2>Metrics</h2><section>" + _table(twin) + f'<p class="soft">{_MEANING}</p></section>',
        _list("What was taken over, and what was not", twin.notes),
    ]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}{_OWN_STYLE}</style></head><body><main>\n'
        + "\n".join(part for part in parts if part)
        + "\n</main></body></html>\n"
    )


def _list(heading: str, texts: Iterable[str]) -> str:
    rows = "".join(f"<li>{escape(text)}</li>" for text in texts)
    return f"<h2>{heading}</h2><section><ul>{rows}</ul></section>" if rows else ""


def _effects(twin: Twin) -> str:
    """What the change does, beside what the changed twin says."""
    if twin.changed is None:
        return ""
    rows = "".join(
        f"<tr><td>{escape(what)}</td><td>{unit}</td><td class=n>{_number(before, 4)}</td>"
        f"<td class=n>{_number(after, 4)}</td></tr>"
        for what, unit, before, after in effects(twin)
    )
    head = "<tr><th>within the time of the log</th><th>unit</th><th class=n>twin</th><th class=n>changed twin</th></tr>"
    notes = "".join(f"<li>{escape(note)}</li>" for note in twin.went_changed)
    return f"<h2>What the change does</h2><section><table>{head}{rows}</table><ul>{notes}</ul></section>"


def _table(twin: Twin) -> str:
    parts: list[tuple[str, list[Agreement]]] = [("Whole flight", twin.whole)]
    if twin.legs:
        parts.append(("In step by mission items", twin.legs))
    if twin.segments:
        parts.append((f"Open segments of {SEGMENT_S:g} s", twin.segments))
    if twin.model:
        parts.append((f"Model alone, {MODEL_S:g} s, by the log's motor outputs", twin.model))
    head = "".join(f'<th class=n colspan=3 title="{escape(title)}">{escape(title)}</th>' for title, _ in parts)
    names = "<th class=n>RMS</th><th class=n>largest</th><th class=n>VAF %</th>" * len(parts)
    rows = []
    for one in twin.whole:
        q, cells = one.quantity, ""
        for _, part in parts:
            found = next((a for a in part if a.quantity.name == q.name), None)
            if found is None:
                cells += "<td></td><td></td><td></td>"
                continue
            cells += (
                f"<td class=n>{_number(found.rms)}</td>"
                f'<td class=n title="{found.worst_at:.1f} s after arming">{_number(found.worst)}</td>'
                f"<td class=n>{_vaf(found.vaf)}</td>"
            )
        rows.append(f"<tr><td>{escape(q.title)}</td><td>{escape(q.unit)}</td>{cells}</tr>")
    return (
        f"<table><tr><th></th><th></th>{head}</tr><tr><th>quantity</th><th>unit</th>{names}</tr>{''.join(rows)}</table>"
    )


def _pictures(twin: Twin) -> Iterable[str]:
    try:
        from . import plots

        drawn = [
            ("The path, from above", plots.plan(twin)),
            ("The flight over time", plots.flown(twin)),
            ("Open segments: flown on from the logged state", plots.opened(twin)),
        ]
    except MissingExtra as error:
        yield f"<h2>Pictures</h2><section><p>{escape(str(error))}</p></section>"
        return
    for heading, data in drawn:
        if not data:
            continue
        source = base64.b64encode(data).decode()
        yield f'<h2>{heading}</h2><section><img alt="{heading}" src="data:image/png;base64,{source}"></section>'
