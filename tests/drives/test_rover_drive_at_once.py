# SPDX-License-Identifier: BSD-3-Clause
"""A mission begun in the second in which the filter takes to GPS: the rover keeps its position, by the true state."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sitl import Simulation
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.mission.mission import Mission
from sitl.client import Client
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd

HOME = (-353632620, 1491652370)
CORNERS = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]


def square():
    """A square of 20 m, north and east of home."""
    places = [add_offset(*HOME, north, east) for north, east in CORNERS]
    return Mission(tuple(MissionItem(MavCmd.NAV_WAYPOINT, x=round(one.lat), y=round(one.lon)) for one in places))


@pytest.mark.parametrize("armed_s", (41.7, 42.5))
def test_the_filter_does_not_begin_anew(core, armed_s):
    """Armed at 42.4 s, a covariance that was no longer positive made the filter begin anew 17 s later, with the rover
    at 4 m/s: no combination of states may have a variance of zero or below, in units of their deviations."""
    simulation = Simulation("ardupilot_rover", seed=0)
    rover = Client(simulation)
    rover.delay(armed_s)
    rover.upload(square())
    rover.arm()
    rover.set_mode("AUTO")
    ekf, far, least = simulation.v.autopilot.ekf, 0.0, 1.0
    for _ in range(400):
        rover.delay(0.1)
        estimate, body = simulation.v.autopilot.estimate.pos, simulation.v.physics.body.pos
        far = max(far, math.hypot(estimate.x - body.x, estimate.y - body.y))
        deviations = np.sqrt(np.diag(ekf.P))
        least = min(least, np.linalg.eigvalsh(ekf.P / np.outer(deviations, deviations))[0])
    assert ekf.resets == 0 and far < 0.5 and least > 0.001
    assert not [text for text in rover.texts if "EKF" in text.text and text.time > armed_s + 1.0]
