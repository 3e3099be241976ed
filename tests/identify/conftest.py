# SPDX-License-Identifier: BSD-3-Clause
"""One flight of a copter whose properties are known, flown once."""

from __future__ import annotations

import pytest

from sitl import Simulation
from sitl.client import Client
from sitl.logs.dataflash.log import attach
from sitl.logs.tlog import TlogWriter

_SETTINGS = {"LOG_BITMASK": 180223, "LOG_DISARMED": 1, "WPNAV_ACCEL": 400, "WPNAV_JERK": 10, "WP_YAW_BEHAVIOR": 0}


@pytest.fixture(scope="session")
def flown(tmp_path_factory):
    """Rest, a hover, turns and short fast legs of the Erle-Copter: the .bin, with its telemetry (.tlog) beside it."""
    path = tmp_path_factory.mktemp("identify") / "flight.bin"
    simulation = Simulation("erle_copter", seed=1, params=_SETTINGS)
    attach(simulation, path)
    simulation.bridge.taps.append(TlogWriter(path.with_suffix(".tlog"), simulation.bridge.epoch_us))
    vehicle = Client(simulation)
    vehicle.params.read_all()
    vehicle.send("REQUEST_DATA_STREAM", req_message_rate=4, start_stop=1)
    vehicle.wait_ready()
    vehicle.delay(25)
    vehicle.take_off(8)
    vehicle.delay(20)
    places = [(k % 4 in (1, 2), k % 4 in (2, 3)) for k in range(12)]
    items = [vehicle.item("NAV_WAYPOINT", 0, 0), vehicle.item("NAV_TAKEOFF", altitude=8)]
    for side in (1, -1, 1):
        items.append(vehicle.item("NAV_WAYPOINT", 0, 0, altitude=8, hold=4))
        items.append(vehicle.item("CONDITION_YAW", param1=90, param3=side, param4=1))
    items += [vehicle.item("NAV_WAYPOINT", 0, 0, altitude=up) for up in (12, 8)]
    items += [vehicle.item("NAV_WAYPOINT", 15 * north, 15 * east, altitude=8) for north, east in places]
    vehicle.upload(items)
    vehicle.start_mission()
    vehicle.delay(90)
    simulation.close()
    return path
