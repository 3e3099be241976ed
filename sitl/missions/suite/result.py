# SPDX-License-Identifier: BSD-3-Clause
"""Result of one flight of a suite."""

from __future__ import annotations

from dataclasses import dataclass, field

OK, DIFFERS, NO_GOLDEN, FAILED = "ok", "DIFFERS", "NO GOLDEN", "ERROR"
KEPT, WRITTEN, REPLACED = "kept", "written", "replaced"
"""What was done with golden, when it may be updated."""
SHOWN = ("position.max", "cross_track.max", "altitude.max", "delay.max", "energy.max")
"""Figures of the table."""


@dataclass(frozen=True)
class Result:
    """One line of the table."""

    name: str
    status: str
    words: str = ""
    """Differences, or why nothing could be compared."""
    simulated: float = 0.0
    """Simulated time [s]."""
    wall: float = 0.0
    """Wall time [s]."""
    figures: dict[str, float] = field(default_factory=dict)
    """``SHOWN`` -> value in its own unit."""
    recording: str = ""
    """Path of the flight's recording, if it was kept."""
    report: str = ""
    """Path of its report."""
    note: str = ""

    @property
    def ok(self) -> bool:
        """Whether the flight is as expected."""
        return self.status in (OK, KEPT, WRITTEN, REPLACED)
