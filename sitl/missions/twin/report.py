# SPDX-License-Identifier: BSD-3-Clause
"""What a twin came to: lines for a terminal, and one HTML file without anything from elsewhere."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

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


def _number(value: float, digits: int = 3) -> str:
    return "-" if not math.isfinite(value) else f"{value:.{digits}g}"


def _vaf(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return "below 0" if value < 0.0 else f"{min(value, 99.99):.1f}" if value < 99.95 else "100"


def lines(twin: Twin, verdicts: Sequence[Verdict]) -> list[str]:
    """For a terminal: what was not taken over first, then figures, findings and limits."""
    log = twin.log
    found = [
        f"{log.name}: {log.columns.firmware or log.kind}, flight of {log.span.length:.1f} s; twin on frame {twin.frame}"
    ]
    found += [f"  note: {note}" for note in twin.notes]
    found += [f"  twin: {note}" for note in twin.went]
    parts = [("whole flight", twin.whole)]
    if twin.legs:
        parts.append(("in step by items", twin.legs))
    if twin.segments:
        parts.append((f"segments of {SEGMENT_S:g} s", twin.segments))
    if twin.difference:
        parts.append(("changed twin - twin", twin.difference))
    head = f"{'':40}" + "".join(f"{title:>22}" for title, _ in parts)
    found += [head, f"{'':40}" + f"{'RMS':>12}{'VAF [%]':>10}" * len(parts)]
    for one in twin.whole:
        q = one.quantity
        cells = [next((a for a in part if a.quantity.name == q.name), None) for _, part in parts]
        found.append(
            f"{q.title:32} {'[' + q.unit + ']':7}"
            + "".join(f"{_number(a.rms):>12}{_vaf(a.vaf):>10}" if a is not None else " " * 22 for a in cells)
        )
    found += [f"  {text}" for text in twin.findings]
    if twin.changed is not None:
        found.append(f"changed: {', '.join(twin.change.words)}")
        found += [f"  changed twin: {note}" for note in twin.went_changed]
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
    if verdicts:
        result = f"{len(verdicts) - len(failed)} of {len(verdicts)} limits are kept"
    else:
        result = "No limits were given: figures only"
    parts = [
        f'<header class="{"bad" if failed else ""}"><h1>{escape(title)}</h1><p>{escape(result)}</p>',
        f'<p class="soft">{escape(log.columns.firmware)}, flight {log.number} of {len(log.flights)}, '
        f"{log.span.length:.1f} s from arming; twin on airframe <b>{escape(twin.frame)}</b>; "
        "both are aligned by the moment of arming</p>",
        f"<p><b>Changed:</b> {escape(', '.join(twin.change.words))}</p></header>" if twin.changed else "</header>",
        _list("Limits that are not kept", [verdict.words for verdict in failed]),
        _list("Where model or autopilot differ", twin.findings or ["Nowhere, as far as these figures tell."]),
        _list("What was taken over, and what was not", twin.notes),
        _list("What the twin did otherwise", twin.went),
        _list("What the changed twin did", twin.went_changed),
        "<h2>Figures</h2><section>" + _table(twin) + f'<p class="soft">{_MEANING}</p></section>',
        *_pictures(twin),
    ]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body><main>\n'
        + "\n".join(part for part in parts if part)
        + "\n</main></body></html>\n"
    )


def _list(heading: str, texts: Iterable[str]) -> str:
    rows = "".join(f"<li>{escape(text)}</li>" for text in texts)
    return f"<h2>{heading}</h2><section><ul>{rows}</ul></section>" if rows else ""


def _table(twin: Twin) -> str:
    parts: list[tuple[str, list[Agreement]]] = [("Whole flight", twin.whole)]
    if twin.legs:
        parts.append(("In step by mission items", twin.legs))
    if twin.segments:
        parts.append((f"Open segments of {SEGMENT_S:g} s", twin.segments))
    if twin.model:
        parts.append((f"Model alone, {MODEL_S:g} s, by the log's motor outputs", twin.model))
    if twin.difference:
        parts.append(("Changed twin from twin", twin.difference))
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

        drawn = [("The way, from above", plots.plan(twin)), ("The flight over time", plots.flown(twin))]
        if twin.segments:
            drawn.append(("Open segments: flown on from the logged state", plots.opened(twin)))
    except MissingExtra as error:
        yield f"<h2>Pictures</h2><section><p>{escape(str(error))}</p></section>"
        return
    for heading, data in drawn:
        source = base64.b64encode(data).decode()
        yield f'<h2>{heading}</h2><section><img alt="{heading}" src="data:image/png;base64,{source}"></section>'
