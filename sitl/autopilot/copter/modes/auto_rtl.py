# SPDX-License-Identifier: BSD-3-Clause
"""AUTO_RTL: AUTO jumps to the nearest return path of the mission, or else to its nearest landing sequence.

AUTO flies it: AUTO_RTL is what clients are sent meanwhile (``modes.shown``), until the mission leaves that part.
``set_mode.go_back`` enters it, ``mission/returning.py`` looks for the part.
"""

from __future__ import annotations

from ....core.kernels import law
from ..state import Vehicle
from . import auto
from .mode import CopterMode


@law
def run(v: Vehicle) -> None:
    """One tick, of AUTO."""
    auto.run(v)


MODE = CopterMode(
    number=auto.AUTO_RTL,
    name="AUTO_RTL",
    title="AUTO RTL",
    run=run,
    start=auto.start,
    needs_position=True,
    autonomous=True,
    arms_at_any_throttle=True,
    may_arm=auto.may_arm,
    is_landing=auto.is_landing,
    is_taking_off=auto.is_taking_off,
)
