# SPDX-License-Identifier: BSD-3-Clause
"""AUTO of the rover waits for a command of its own: one that was written before it was entered is not begun."""

from __future__ import annotations

from sitl.autopilot.rover.modes import auto
from tests.autopilot.rover.modes.driven_rover import Rover


def test_a_command_from_before_is_not_begun_again() -> None:
    rover = Rover()
    modes = rover.ap.modes
    modes.nav.command_count, modes.mission_count = 4, 3
    assert auto.start(rover.v) == 0
    assert modes.auto.command == 4
