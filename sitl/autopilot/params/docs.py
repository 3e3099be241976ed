# SPDX-License-Identifier: BSD-3-Clause
"""The documentation pages of the parameters, made from the tables."""

from __future__ import annotations

from .parameter import stored
from .parm_files import format_value
from .table import Table


def page(firmware: str, table: Table) -> str:
    """A firmware's table as Markdown, one section a prefix."""
    lines = [
        f"# Parameters of the {firmware}",
        "",
        f"Made by `sitl params --vehicle {firmware} --markdown` from `sitl/autopilot/params/` and",
        f"`sitl/autopilot/{firmware}/parameters/`. Names and defaults are ArduPilot's;",
        "the range is what the firmware accepts.",
    ]
    section = ""
    for p in table.with_effect:
        prefix = p.name.split("_", 1)[0]
        if prefix != section:
            section = prefix
            lines += ["", f"## {prefix}", "", "| name | default | range | unit | meaning |", "|---|---|---|---|---|"]
        default = format_value(p, stored(p, p.default))
        lines.append(f"| {p.name} | {default} | {p.low:g} .. {p.high:g} | {p.unit} | {p.doc} |")
    read = [p for p in table if p.doc and not p.has_effect]
    if read:
        lines += ["", "## Outputs and camera", "", "| name | default | type | meaning |", "|---|---|---|---|"]
        lines += [f"| {p.name} | {format_value(p, stored(p, p.default))} | {p.kind} | {p.doc} |" for p in read]
    others = [p for p in table if not p.has_effect and not p.doc]
    if others:
        lines += [
            "", "## Without effect", "",
            "ArduPilot's other parameters have no effect in this simulator. They are kept, sent, saved and loaded; who",
            "sets one is told so. Those of a group that is switched off are not in the list that clients get; they",
            "are read and set by name all the same.",
            "", "| name | default | type | in the list with |", "|---|---|---|---|",
        ]  # fmt: skip
        lines += [f"| {p.name} | {format_value(p, stored(p, p.default))} | {p.kind} | {p.shown_by} |" for p in others]
    return "\n".join(lines) + "\n"
