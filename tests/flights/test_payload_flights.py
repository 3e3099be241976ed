# SPDX-License-Identifier: BSD-3-Clause
"""PAYLOAD_PLACE in missions: loads are placed, kept at the greatest descent, or were gone before."""

from __future__ import annotations

import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import Aviator, Item

GRIP = {"GRIP_ENABLE": 1.0, "GRIP_TYPE": 1.0, "SERVO9_FUNCTION": 28.0}
OPEN, CLOSED = 1100, 1900
AUX, GRIPPER = 218, 19


def mission(p: Aviator, *items: Item, seconds: float = 150.0) -> float:
    """Fly a take-off to 6 m, items, and a return; when it began."""
    p.start_mission(Item(MavCmd.NAV_TAKEOFF, None, 6.0), *items, Item(MavCmd.NAV_RETURN_TO_LAUNCH))
    start = p.now
    p.fly(seconds, lambda: not p.armed)
    return start


def test_a_load_is_placed(core: Core) -> None:
    """At its place: down to the ground, the gripper opens, up again, on."""
    p = Aviator(core, **GRIP, PLDP_DELAY=2.0).ready()
    start = mission(p, Item(MavCmd.NAV_PAYLOAD_PLACE, (4.0, 3.0)))
    texts = ["PayloadPlace: payload release thrust threshold", "PayloadPlace: Releasing the gripper"]
    texts += ["Gripper load releasing", "Gripper load released", "Mission: 3 RTL"]
    times = [min(t for t, _, said in p.texts if said.startswith(text)) for text in texts]
    assert times == sorted(times)
    assert times[4] - times[1] > 2.5
    assert p.simulation.v.actuators.pwm[8] == OPEN
    assert p.reached == [1, 2, 3]
    assert not p.armed
    rows = p.since(start)
    placing = rows[(rows[:, 0] > times[1] - 1.0) & (rows[:, 0] < times[4])]
    assert -placing[:, 3].max() < 0.3, "on the ground"
    assert placing[0, 1:3] == pytest.approx([4.0, 3.0], abs=1.2)
    assert -placing[-1, 3] == pytest.approx(6.0, abs=0.5)


def test_a_load_that_finds_no_ground_is_brought_back(core: Core) -> None:
    p = Aviator(core, **GRIP).ready()
    start = mission(p, Item(MavCmd.NAV_PAYLOAD_PLACE, None, p=(2.0,)))
    assert p.said("PayloadPlace: Reached maximum descent")
    assert not p.said("Gripper load")
    rows = p.since(start)
    placed = rows[(rows[:, 0] > p.reached_at(1)) & (rows[:, 0] < p.reached_at(2))]
    assert -placed[:, 3].max() == pytest.approx(4.0, abs=0.5)
    assert p.reached == [1, 2, 3]


def test_nothing_is_placed_with_an_open_gripper(core: Core) -> None:
    p = Aviator(core, **GRIP).ready()
    p.ask(AUX, GRIPPER, 0)
    p.fly(1.0)
    mission(p, Item(MavCmd.NAV_PAYLOAD_PLACE, (4.0, 3.0)))
    assert p.said("PayloadPlace: Abort: Gripper Open")
    assert p.reached_at(2) - p.reached_at(1) < 1.0
    assert p.reached == [1, 2, 3]
