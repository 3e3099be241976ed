# SPDX-License-Identifier: BSD-3-Clause
"""AUTO_RTL: back by the mission's return paths and landing sequences. Items, modes and texts are a real ArduPilot's."""

from __future__ import annotations

import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import AUTO, AUTO_RTL, GUIDED, LOITER, POSITION, RTL, Aviator
from tests.pilots.witness import Item

LAND_START, PATH_START = Item(MavCmd.DO_LAND_START), Item(MavCmd.DO_RETURN_PATH_START)
TAKE_OFF, LAND = Item(MavCmd.NAV_TAKEOFF, z=20.0), Item(MavCmd.NAV_LAND, (0.0, 0.0))
RETURN, LANDING = 188, 189
"""MAV_CMDs"""


def leg(north: float, east: float = 0.0, up: float = 20.0) -> Item:
    return Item(MavCmd.NAV_WAYPOINT, (north, east), up)


WITH_PATH = (
    leg(125), PATH_START, leg(90), leg(75), leg(55), leg(50), LAND_START, leg(25), leg(-25), LAND,
)  # fmt: skip


def flying(core: Core, *items: Item, **params: float) -> Aviator:
    """In GUIDED 20 m over home, with a mission."""
    p = Aviator(core, "ardupilot_quad", **params).hover(20.0)
    assert p.upload(*items) == 0
    return p


def new_texts(p: Aviator, since: int) -> list[str]:
    return [text for _, _, text in p.texts[since:]]


def tried(p: Aviator, number: int) -> tuple[bool, int, int, list[str]]:
    """Ask for a mode: whether it was taken; the mode, the item under way and what was said half a second later."""
    before = len(p.texts)
    p.acks.clear()
    p.send_command("DO_SET_MODE", 1, number)
    p.fly(0.5)
    return dict(p.acks)[176] == 0, p.mode, int(p.ap.modes.nav.mission_current), new_texts(p, before)


def test_without_a_way_back_it_is_refused(core: Core) -> None:
    p = flying(core, TAKE_OFF, leg(60))
    beginning = "Mode change to AUTO RTL failed: "
    no_sequence = "Unable to start landing sequence"
    assert tried(p, AUTO_RTL) == (
        False, GUIDED, 0, [no_sequence, beginning + "No return path or landing sequence found"],
    )  # fmt: skip
    before = len(p.texts)
    assert p.ask(LANDING) == 4 and p.ask(RETURN) == 4
    assert new_texts(p, before) == [
        no_sequence, beginning + "No landing sequence found", beginning + "No return path found",
    ]  # fmt: skip
    assert p.upload(TAKE_OFF, leg(60), LAND_START) == 0
    assert tried(p, AUTO_RTL)[:2] == (False, GUIDED), "nothing follows the mark"


def test_flies_the_landing_sequence_and_is_told_as_a_mode_of_its_own(core: Core) -> None:
    p = flying(core, TAKE_OFF, leg(60), LAND_START, leg(30), LAND)
    sequence = ["Mission: 3 LandStart", "Mission: 4 WP"]
    assert tried(p, AUTO_RTL) == (True, AUTO_RTL, 4, [*sequence, "Landing sequence start", *sequence])
    assert p.telemetry.mode == "AUTO_RTL"
    assert tried(p, AUTO_RTL) == (True, AUTO_RTL, 4, [])
    assert p.ask(RETURN) == 0 and p.said("Landing sequence active")
    assert tried(p, AUTO) == (True, AUTO, 4, ["Mission: 4 WP"])
    assert tried(p, AUTO_RTL) == (True, AUTO_RTL, 4, [*sequence, "Landing sequence start"])
    assert p.ask(MavCmd.DO_LAND_START) == 0 and p.mode == AUTO_RTL
    assert p.ask(224, 2) == 0
    p.fly(0.1)
    assert p.mode == AUTO, "item 2 is no part of the way back"
    assert tried(p, AUTO_RTL)[:3] == (True, AUTO_RTL, 4)
    start = p.now
    p.wait_disarmed(120.0)
    assert p.since(start)[:, 1].max() == pytest.approx(30.0, abs=1.0)
    assert p.pos[:2] == pytest.approx((0.0, 0.0), abs=1.0)


def test_joins_the_return_path_at_its_nearest_leg(core: Core) -> None:
    p = flying(core, *WITH_PATH)
    assert tried(p, AUTO_RTL) == (True, AUTO, 6, ["Mission: 6 WP", "Return path started", "Mission: 6 WP"]), (
        "AUTO begins the item anew, and is AUTO then"
    )
    assert tried(p, AUTO_RTL) == (True, AUTO_RTL, 6, ["Mission: 6 WP", "Return path started"])
    assert p.ask(RETURN) == 0 and p.said("Return path active")
    assert p.ask(LANDING) == 0
    assert (p.mode, p.ap.modes.nav.mission_current) == (AUTO_RTL, 8)
    assert p.set_mode(GUIDED)
    p.setpoint(POSITION, position=(62.0, 0.0, -20.0))
    assert p.fly(40.0, lambda: p.pos[0] > 61.0)
    assert p.ask(RETURN, wait=0.3) == 0
    assert p.ap.modes.nav.mission_current == 5
    assert p.fly(60.0, lambda: p.ap.modes.nav.mission_current == 9), "on to the landing sequence behind it"


def test_distances_of_return_paths_count_height_and_those_of_landings_do_not(core: Core) -> None:
    p = flying(core, TAKE_OFF, PATH_START, leg(30, up=80.0), PATH_START, leg(50))
    assert tried(p, AUTO_RTL)[2] == 5
    assert p.set_mode(GUIDED)
    assert p.upload(TAKE_OFF, leg(60), LAND_START, leg(30, up=80.0), LAND_START, leg(50), LAND) == 0
    assert tried(p, AUTO_RTL)[2] == 4
    assert p.set_mode(GUIDED)
    begin = Item(MavCmd.DO_RETURN_PATH_START, (10.0, 0.0), 20.0)
    assert p.upload(TAKE_OFF, begin, leg(0, 100), leg(0, -100), LAND) == 0
    p.setpoint(POSITION, position=(10.0, 0.0, -20.0))
    p.fly(8.0)
    assert tried(p, AUTO_RTL)[2] == 3, "the mark's own place is the path's beginning"


def test_on_the_ground_it_needs_a_take_off_as_auto_does(core: Core) -> None:
    p = Aviator(core, "ardupilot_quad").ready()
    assert p.upload(LAND_START, leg(30), LAND) == 0
    assert tried(p, AUTO_RTL)[:3] == (True, AUTO_RTL, 2), "disarmed any mode is taken"
    assert p.set_mode(GUIDED)
    p.arm()
    accepted, mode, _, said = tried(p, AUTO_RTL)
    assert (accepted, mode) == (False, GUIDED)
    assert {"Auto: Missing Takeoff Cmd", "Mode change to AUTO failed: init failed"} < set(said)


@pytest.mark.parametrize(("items", "mode"), [((TAKE_OFF, leg(60), LAND_START, leg(30), LAND), AUTO_RTL), ((), RTL)])
def test_a_lost_radio_takes_it_or_else_rtl(core: Core, items: tuple[Item, ...], mode: int) -> None:
    p = flying(core, *items, FS_THR_ENABLE=6)
    p.sticks(1.0)
    assert p.set_mode(LOITER)
    p.sticks(1.0)
    p.hold(throttle=900)
    p.fly(3.0)
    assert p.mode == mode
    assert p.said("Trying RTL Mode") == (mode == RTL)
