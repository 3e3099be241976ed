# SPDX-License-Identifier: BSD-3-Clause
"""Motor tests of copters (MAV_CMD_DO_MOTOR_TEST): one motor, or several in turn with pauses of half the time."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol, cast

from ...core.constants import NEVER
from ...core.mavlink import MavResult
from ..host import Host
from .service import Service

LONGEST_S = 600.0
MOST = 255
"""Motors that a command can name."""
SPARE_S = 1.0
"""The vehicle is armed so much longer, as another motor follows."""


class Series(NamedTuple):
    """Motors that are tested in turn."""

    motor: int
    """That turns now, or turned before the pause; from 1."""
    in_order: bool
    """Counted clockwise from the front."""
    throttle: float
    each_us: int
    left: int
    """Motors to come."""
    is_resting: bool


class TestsMotors(Protocol):
    """A firmware that tests motors one by one."""

    def test_motor(self, position: int, in_order: bool, throttle: float, seconds: float) -> bool:
        """Turn a motor."""

    def is_testing_motor(self) -> bool:
        """Whether a test is under way."""

    def rest_tested_motor(self) -> None:
        """No throttle, and the test goes on."""


class MotorTestService(Service):
    """The series under way; the vehicle's own law ends the test of its last motor."""

    def __init__(self, bridge: Host) -> None:
        super().__init__(bridge)
        self._autopilot = cast("TestsMotors", bridge.autopilot)
        self._series: Series | None = None

    def snapshot(self) -> Any:
        return (None if self._series is None else tuple(self._series), self.due_us)

    def restore(self, state: Any) -> None:
        series, self.due_us = state
        self._series = None if series is None else Series(*series)

    def begin(self, motor: int, count: int, in_order: bool, throttle: float, seconds: float) -> int:
        """Turn ``count`` motors from ``motor`` (1 ..) on at a throttle 0 .. 1, each so long [s]. The MAV_RESULT."""
        seconds = min(max(seconds, 0.0), LONGEST_S)
        self._series = Series(motor, in_order, throttle, round(seconds * 1e6), min(max(count, 1), MOST) - 1, False)
        return MavResult.ACCEPTED if self._turn() else MavResult.FAILED

    def _turn(self) -> bool:
        series = self._series
        assert series is not None
        seconds = series.each_us * 1e-6
        longer = 0.5 * seconds + SPARE_S if series.left else 0.0
        ok = self._autopilot.test_motor(series.motor, series.in_order, series.throttle, seconds + longer)
        self.bridge.say_pending()
        goes_on = series.left > 0 and self._autopilot.is_testing_motor()
        self.due_us = self.bridge.now_us + series.each_us if goes_on else NEVER
        return bool(ok)

    def service(self, now_us: int) -> None:
        series, autopilot = self._series, self._autopilot
        if series is None or not autopilot.is_testing_motor():  # it was disarmed
            self._series, self.due_us = None, NEVER
        elif not series.is_resting:
            autopilot.rest_tested_motor()
            self._series, self.due_us = series._replace(is_resting=True), now_us + series.each_us // 2
        else:
            self._series = series._replace(motor=series.motor + 1, left=series.left - 1, is_resting=False)
            self._turn()
