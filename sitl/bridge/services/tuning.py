# SPDX-License-Identifier: BSD-3-Clause
"""Knobs of the transmitter that change parameters in flight (TUNE, TUNE2).

https://ardupilot.org/copter/docs/common-transmitter-tuning.html
"""

from __future__ import annotations

from ...core.border import RC_INPUTS
from ...core.constants import NEVER
from ..host import Host
from .service import StatefulService

EVERY_US = 300_000
KNOBS = {219: "TUNE", 220: "TUNE2"}
"""RCn_OPTION of a knob, and the parameters of what it does."""
WAYPOINT_SPEED = 10
"""TUNE: no parameter, the speed of legs from now on."""
TUNED: dict[int, tuple[str, ...]] = {
    1: ("ATC_ANG_RLL_P", "ATC_ANG_PIT_P"), 3: ("ATC_ANG_YAW_P",),
    4: ("ATC_RAT_RLL_P", "ATC_RAT_PIT_P"), 5: ("ATC_RAT_RLL_I", "ATC_RAT_PIT_I"),
    21: ("ATC_RAT_RLL_D", "ATC_RAT_PIT_D"), 6: ("ATC_RAT_YAW_P",), 26: ("ATC_RAT_YAW_D",), 56: ("ATC_RAT_YAW_FLTE",),
    46: ("ATC_RAT_PIT_P",), 47: ("ATC_RAT_PIT_I",), 48: ("ATC_RAT_PIT_D",),
    49: ("ATC_RAT_RLL_P",), 50: ("ATC_RAT_RLL_I",), 51: ("ATC_RAT_RLL_D",),
    14: ("PSC_POSZ_P",), 7: ("PSC_VELZ_P",), 34: ("PSC_ACCZ_P",), 35: ("PSC_ACCZ_I",), 36: ("PSC_ACCZ_D",),
    12: ("PSC_POSXY_P",), 22: ("PSC_VELXY_P",), 28: ("PSC_VELXY_I",), 60: ("LOIT_SPEED",), 39: ("CIRCLE_RATE",),
    25: ("ACRO_RP_RATE",), 40: ("ACRO_Y_RATE",), 45: ("ATC_INPUT_TC",), 55: ("MOT_YAW_HEADROOM",),
    58: ("SID_MAGNITUDE",), 59: ("PSC_ANGLE_MAX",),
}  # fmt: skip
"""TUNE -> the parameters that the knob sets; other numbers set none."""


class TuningService(StatefulService):
    """The knobs."""

    kept = ("_speed", "due_us")

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._values = bridge.vehicle.parameters
        self._speed: float | None = None
        """Of legs [m/s], as last set."""
        self._find_due()

    def parameter_changed(self, name: str) -> None:
        if name in KNOBS.values() or name.endswith("_OPTION"):
            self._find_due()

    def _find_due(self) -> None:
        has_knobs = "TUNE" in self._values.table and any(self._values[name] > 0.0 for name in KNOBS.values())
        is_fitted = has_knobs and any(self._channel(option) for option in KNOBS)
        self.due_us = (self.bridge.now_us // EVERY_US + 1) * EVERY_US if is_fitted else NEVER

    def _channel(self, option: int) -> int:
        """The channel of a knob; 0 none."""
        found = [n for n in range(1, RC_INPUTS + 1) if self._values[f"RC{n}_OPTION"] == option]
        return found[0] if found else 0

    def service(self, now_us: int) -> None:
        self._find_due()
        rc = self.bridge.vehicle.v.autopilot.rc
        for option, name in KNOBS.items():
            channel, tuned = self._channel(option), int(self._values[name])
            low, high = self._values[f"{name}_MIN"], self._values[f"{name}_MAX"]
            if channel == 0 or low == high:
                continue
            pulse = int(rc.channels[channel - 1])
            if pulse > 0 and rc.receiver_ok:
                self._tune(tuned, low + (high - low) * self._share(channel, pulse))

    def _share(self, channel: int, pulse: int) -> float:
        """Where a knob is, from 0 to 1."""
        least, most = self._values[f"RC{channel}_MIN"], self._values[f"RC{channel}_MAX"]
        share = min(max((pulse - least) / (most - least), 0.0), 1.0) if most > least else 0.0
        return 1.0 - share if self._values[f"RC{channel}_REVERSED"] else share

    def _tune(self, tuned: int, value: float) -> None:
        if tuned == WAYPOINT_SPEED:
            speed = max(0.01 * value, 0.0)
            if speed != self._speed and self.bridge.autopilot.change_speed(0, speed):
                self._speed = speed
            return
        for name in TUNED.get(tuned, ()):
            before = self._values[name]
            self._values[name] = value
            if self._values[name] != before:
                self.bridge.autopilot.parameter_changed(name)
