# SPDX-License-Identifier: BSD-3-Clause
"""How one flight of a suite went."""

from __future__ import annotations

from dataclasses import dataclass, field

OK, DIFFERS, NO_GOLDEN, FAILED = "ok", "DIFFERS", "NO GOLDEN", "ERROR"
KEPT, WRITTEN, REPLACED = "kept", "written", "replaced"
"""What became of golden, when it may be updated."""
SHOWN = ("position.max", "cross_track.max", "altitude.max", "delay.max", "energy.max")
"""Figures of the table."""


@dataclass(frozen=True)
class Result:
    """One line of the table."""

    name: str
    status: str
    words: str = ""
    """What differs, or why there is nothing to compare."""
    simulated: float = 0.0
    """[s]"""
    wall: float = 0.0
    """[s]"""
    figures: dict[str, float] = field(default_factory=dict)
    """``SHOWN`` -> value in its own unit."""
    recording: str = ""
    """Path of the flight's recording, if it was kept."""
    report: str = ""
    """Path of its report."""
    note: str = ""

    @property
    def ok(self) -> bool:
        """Whether there is nothing to complain of."""
        return self.status in (OK, KEPT, WRITTEN, REPLACED)
