# SPDX-License-Identifier: BSD-3-Clause
"""A link that loses every fifth frame, in both directions: what is asked for happens nevertheless."""

from __future__ import annotations

import random

import pytest

from sitl import Simulation
from sitl.bridge.links.inprocess import InProcessLink
from sitl.client import Client, InProcess, WaitTimeoutError
from sitl.simulation import Core


class Losses:
    """Loses a share of the frames, by dice."""

    def __init__(self, share: float, seed: int) -> None:
        self.share, self.dice, self.lost = share, random.Random(seed), 0

    def __call__(self, frame: bytes) -> bool:
        lost = self.dice.random() < self.share
        self.lost += lost
        return lost


@pytest.mark.parametrize("seed", range(4))
def test_what_is_lost_is_sent_again(core: Core, seed: int) -> None:
    there, back = Losses(0.2, seed), Losses(0.2, 100 + seed)
    simulation = Simulation("erle_copter", seed=1, core=core)
    vehicle = Client(InProcess(simulation, link=InProcessLink(drop_to_client=back, drop_to_vehicle=there)))
    vehicle.wait_ready()
    vehicle.params.update(WPNAV_SPEED=700, RTL_ALT=1300)
    params = simulation.v.autopilot.params
    assert (params.WPNAV_SPEED, params.RTL_ALT) == (700, 1300)
    corners = [vehicle.item("NAV_WAYPOINT", float(k), 10.0, altitude=10) for k in range(20)]
    vehicle.upload([vehicle.item("NAV_WAYPOINT"), vehicle.item("NAV_TAKEOFF", altitude=10), *corners])
    assert len(simulation.mission) == 22
    assert [item.x for item in simulation.mission.items[2:]] == [item.x for item in corners]
    vehicle.set_mode("GUIDED")
    vehicle.arm()
    assert simulation.v.autopilot.arming.armed
    assert there.lost > 5 and back.lost > 50


def test_a_link_that_is_cut_ends_in_a_time_out(core: Core) -> None:
    there = Losses(0.0, 0)
    vehicle = Client(
        InProcess(Simulation("erle_copter", core=core), link=InProcessLink(drop_to_vehicle=there)), name="mute"
    )
    vehicle.delay(1)
    there.share = 1.0
    with pytest.raises(WaitTimeoutError, match="waited 3 s for an answer to arming") as failure:
        vehicle.arm()
    assert "mute at 4.0 s simulated" in str(failure.value)
    with pytest.raises(WaitTimeoutError, match="waited 3 s for the value of RTL_ALT"):
        vehicle.params["RTL_ALT"]
    assert there.lost > 12
