# SPDX-License-Identifier: BSD-3-Clause
"""FLTMODE_GCSBLOCK: modes that ground stations may not choose, on the firmwares' own laws."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.modes import mode_list as copter_table
from sitl.autopilot.copter.modes import set_mode as copter_set_mode
from sitl.autopilot.modes import ModeReason, ModeResult
from sitl.autopilot.rover.modes import mode_list as rover_table
from sitl.autopilot.rover.modes import set_mode as rover_set_mode
from sitl.autopilot.shell_parameters import MODE_BLOCK
from tests.bridge.test_autopilots import ACCEPTED, FAILED, FirmwareBench, copter, long, rover, texts

__all__ = ["copter", "rover"]

COPTER_BITS = {0: 0, 1: 1, 2: 2, 3: 3, 4: 4, 5: 5, 6: 7, 7: 11, 9: 14, 10: 15, 11: 16, 12: 17, 16: 21, 22: 27, 23: 28}
ROVER_BITS = {0: 0, 1: 1, 2: 3, 3: 5, 4: 6, 5: 7, 6: 9, 7: 10, 8: 11, 9: 12, 10: 15, 11: 8}
"""Bit -> number of the mode."""


@pytest.mark.parametrize(
    ("order", "bits"), ((copter_table.GCS_BLOCK, COPTER_BITS), (rover_table.GCS_BLOCK, ROVER_BITS))
)
def test_bits_are_those_of_ardupilot(order: tuple[int, ...], bits: dict[int, int]) -> None:
    assert {bit: order[bit] for bit in bits} == bits
    assert len(set(order)) == len(order)


def test_a_blocked_mode_is_refused_to_ground_stations_only(copter: FirmwareBench) -> None:
    copter.ready()
    copter.vehicle.parameters[MODE_BLOCK] = 1 << 5  # LOITER
    said = "".join(texts(copter, long(176, 1, 5)))
    assert said == "Mode change to LOITER failed: GCS entry disabled (FLTMODE_GCSBLOCK)"
    assert copter.command(176, 1, 5) == FAILED
    assert copter.command(17) == FAILED  # NAV_LOITER_UNLIM
    assert copter.command(176, 1, 2) == ACCEPTED
    assert copter_set_mode.request(copter.vehicle.v, 5, ModeReason.RC) == ModeResult.ACCEPTED
    assert copter.command(176, 1, 5) == ACCEPTED  # it is in that mode


def test_the_way_home_by_the_mission_is_auto(copter: FirmwareBench) -> None:
    copter.ready()
    copter.vehicle.v.autopilot.modes.mission_lands = True
    copter.vehicle.parameters[MODE_BLOCK] = 1 << 3
    assert any("GCS entry disabled" in text for text in texts(copter, long(189)))
    copter.vehicle.parameters[MODE_BLOCK] = 0
    assert not any("GCS entry disabled" in text for text in texts(copter, long(189)))


def test_a_rover_says_it_in_its_own_words(rover: FirmwareBench) -> None:
    rover.ready()
    rover.vehicle.parameters[MODE_BLOCK] = 1 << 9  # SMART_RTL
    said = texts(rover, long(176, 1, 12))
    assert "".join(said) == "Mode change to SRTL denied, GCS entry disabled (FLTMODE_GCSBLOCK)"
    assert rover.command(176, 1, 12) == FAILED
    assert rover_set_mode.request(rover.vehicle.v, 0, ModeReason.GCS) == ModeResult.ACCEPTED
