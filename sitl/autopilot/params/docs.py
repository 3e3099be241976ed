# SPDX-License-Identifier: BSD-3-Clause
"""The documentation page of the parameters, made from the table."""

from __future__ import annotations

from .files import format_value
from .table import TABLE, stored


def page() -> str:
    """The table as Markdown, one section a prefix."""
    lines = [
        "# Parameters",
        "",
        "Made by `sitl params --markdown` from `sitl/autopilot/params/groups/`. Names and defaults are ArduPilot's;",
        "the range is what the firmware accepts.",
    ]
    section = ""
    for p in TABLE:
        prefix = p.name.split("_", 1)[0]
        if prefix != section:
            section = prefix
            lines += ["", f"## {prefix}", "", "| name | default | range | unit | meaning |", "|---|---|---|---|---|"]
        default = format_value(p.name, stored(p, p.default))
        lines.append(f"| {p.name} | {default} | {p.low:g} .. {p.high:g} | {p.unit} | {p.doc} |")
    return "\n".join(lines) + "\n"
