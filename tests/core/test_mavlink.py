# SPDX-License-Identifier: BSD-3-Clause
"""Our names and numbers of MAVLink are those of its dialect."""

from __future__ import annotations

from enum import IntEnum

import pytest
from pymavlink.dialects.v20 import ardupilotmega

from sitl.core import mavlink

BEGIN = {
    mavlink.MavMissionResult: ("MAV_MISSION_RESULT", "MAV_MISSION_"),
    mavlink.MavSysStatus: ("MAV_SYS_STATUS_SENSOR", "MAV_SYS_STATUS_"),
    mavlink.MotorTestThrottleType: ("MOTOR_TEST_THROTTLE_TYPE", "MOTOR_TEST_THROTTLE_"),
}
"""Group of the dialect and what its names begin with, where that is not the group's name."""
OTHER_NAMES = {"FIX_3D": "3D_FIX"}
CHOICES = [kind for kind in vars(mavlink).values() if isinstance(kind, type) and kind.__module__ == mavlink.__name__]


@pytest.mark.parametrize("choice", CHOICES, ids=lambda c: c.__name__)
def test_members_are_those_of_the_dialect(choice: type[IntEnum]) -> None:
    spelled = "".join(f"_{c}" if c.isupper() else c.upper() for c in choice.__name__)[1:]
    group, begin = BEGIN.get(choice, (spelled, f"{spelled}_"))
    numbers = {entry.name: number for number, entry in ardupilotmega.enums[group].items()}
    assert {m.name: numbers[begin + OTHER_NAMES.get(m.name, m.name)] for m in choice} == {m.name: m for m in choice}
