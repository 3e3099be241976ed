# SPDX-License-Identifier: BSD-3-Clause
"""How far the mission is: MISSION_CURRENT."""

from __future__ import annotations

from ..dialect import message
from .builder import Build, Builder, Context
from .units import uint16

M = "autopilot.modes."
NO_MISSION, NOT_STARTED, ACTIVE, PAUSED, COMPLETE = 1, 2, 3, 4, 5


def mission_current(context: Context) -> Build:
    """MISSION_CURRENT: number of the item, number of items without home, state."""
    read = context.fields(
        M + "number", M + "nav.mission_state", M + "nav.mission_current",
        "autopilot.params.MIS.TOTAL",
    )  # fmt: skip
    pack, auto = message("MISSION_CURRENT").pack, context.profile.auto

    def build() -> bytes:
        mode, state, seq, total = read()
        if total <= 1.0:
            shown = NO_MISSION
        elif state == 2:
            shown = COMPLETE
        elif state == 1:
            shown = ACTIVE
        else:
            shown = PAUSED if seq > 0 else NOT_STARTED
        return pack(uint16(seq), uint16(total - 1.0), shown, 1 if mode == auto else 0)

    return build


BUILDERS: dict[str, Builder] = {"MISSION_CURRENT": mission_current}
