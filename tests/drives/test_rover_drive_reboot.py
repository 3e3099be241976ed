# SPDX-License-Identifier: BSD-3-Clause
"""INITIAL_MODE at power-on, without a transmitter whose mode switch would say another."""

from __future__ import annotations

from sitl.simulation import Core
from tests.drives.rover_driver import AUTO, LOITER, Driver
from tests.pilots.witness import Item

WAYPOINT = 16
INITIALISING = 16
NO_RADIO = {"SIM_RC_FAIL": 1.0, "FS_THR_ENABLE": 0.0}


def test_a_stored_mission_may_start_with_the_vehicle(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", **NO_RADIO).ready()
    assert d.upload(Item(WAYPOINT, (10.0, 0.0)), Item(WAYPOINT, (10.0, 10.0))) == 0
    d.set_parameter("INITIAL_MODE", AUTO)
    d.simulation.request_reboot()
    d.simulation.advance(5.0)
    assert d.mode == AUTO
    assert d.ap.modes.nav.mission_current == 0  # no place means anything yet
    d.simulation.advance(45.0)
    assert d.mode == AUTO and d.ap.modes.nav.mission_current == 1


def test_a_mode_that_cannot_begin_yet_is_not_entered(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", INITIAL_MODE=float(LOITER), **NO_RADIO)
    d.simulation.advance(1.0)
    assert d.mode == INITIALISING
