# SPDX-License-Identifier: BSD-3-Clause
"""PAYLOAD_PLACE: when a load counts as placed, what the gripper does, and where it climbs again."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.autopilot.copter.modes import payload_place as law
from sitl.autopilot.copter.modes.payload_place import PAYLOAD_PLACE_DID
from sitl.autopilot.navigation.state import COMMAND_ARRIVED
from sitl.autopilot.notes import Text
from tests.autopilot.copter.steady_copter import codes, wait


def said(v: Any) -> list[int]:
    """What it did so far."""
    ring = v.autopilot.events
    return [int(ring.a[k]) for k in range(int(ring.count)) if ring.code[k] == PAYLOAD_PLACE_DID]


@pytest.fixture
def placing(flying: Any) -> Any:
    """On a steady descent at 0.5 m/s from 10 m, with a thrust of 0.5."""
    ap = flying.autopilot
    law.begin(flying)
    path = ap.control.pos_d
    path.accel_max, path.speed_up = 2.5, 2.5
    path.pos_desired, path.vel_desired = -10.0, 0.5
    ap.control.attitude.throttle_in = 0.5
    law.begin_descent(ap.modes.payload_place, flying.time_us, path.pos_desired, ap.params)
    return flying


def watch(v: Any, seconds: float, thrust: float) -> int:
    """Watch the descent at a thrust for a while; the stage then."""
    v.autopilot.control.attitude.throttle_in = thrust
    for _ in range(round(seconds * 40)):
        if v.autopilot.modes.payload_place.stage != law.DESCENDING:
            break
        wait(v, 0.025)
        law.watch_descent(v)
    return int(v.autopilot.modes.payload_place.stage)


def test_without_a_place_it_begins_where_it_is(flying: Any) -> None:
    law.begin(flying)
    assert flying.autopilot.modes.payload_place.stage == law.STARTING
    flying.autopilot.modes.nav.has_target = True
    law.begin(flying)
    assert flying.autopilot.modes.payload_place.stage == law.FLYING


@pytest.mark.parametrize(("speed", "result"), [(0.0, 0.5), (1.2, 1.2), (5.0, 1.5)])
def test_speed_of_the_descent(placing: Any, speed: float, result: float) -> None:
    """PLDP_SPEED_DN, or LAND_SPEED; WPNAV_SPEED_DN at most."""
    ap = placing.autopilot
    ap.params.PLDP.SPEED_DN = speed
    law.begin_descent(ap.modes.payload_place, placing.time_us, -10.0, ap.params)
    assert ap.modes.payload_place.speed == pytest.approx(result)


def test_a_load_is_placed_when_less_thrust_is_needed_for_half_a_second(placing: Any) -> None:
    """Of the least of two steady seconds, 90 %; a shorter dip does not count."""
    assert watch(placing, 3.0, 0.5) == law.DESCENDING
    assert watch(placing, 0.4, 0.44) == law.DESCENDING
    assert watch(placing, 0.1, 0.5) == law.DESCENDING
    assert watch(placing, 1.0, 0.46) == law.DESCENDING
    assert watch(placing, 0.45, 0.44) == law.DESCENDING
    assert watch(placing, 0.1, 0.44) == law.RELEASING
    assert said(placing) == [law.PLACED]
    assert placing.autopilot.events.b[0] == pytest.approx(0.45)


def test_thrust_counts_in_a_steady_descent_alone(placing: Any) -> None:
    placing.autopilot.control.pos_d.vel_desired = 0.45
    assert watch(placing, 5.0, 0.1) == law.DESCENDING
    placing.autopilot.control.pos_d.vel_desired = 0.5
    assert watch(placing, 5.0, 0.1) == law.DESCENDING


@pytest.mark.parametrize(("limit", "stage"), [(0.0, law.DESCENDING), (5.0, law.CLIMB_STARTS)])
def test_greatest_descent(placing: Any, limit: float, stage: int) -> None:
    ap = placing.autopilot
    ap.modes.payload_place.limit = limit
    ap.control.pos_d.pos_desired = -4.9
    assert watch(placing, 0.1, 0.5) == stage
    assert said(placing) == ([law.AT_LIMIT] if limit else [])


@pytest.mark.parametrize(
    ("count", "reading", "stage", "texts"),
    [
        (0, 0.0, law.CLIMB_STARTS, [law.NO_RANGE]),
        (1, 3.0, law.DESCENDING, []),
        (1, 1.0, law.RELEASING, [law.PLACED]),
        (1, float("inf"), law.RELEASING, [law.PLACED]),
    ],
)
def test_rangefinder(placing: Any, count: int, reading: float, stage: int, texts: list[int]) -> None:
    """PLDP_RNG_MAX: nothing is placed while it reads more; one that sees nothing is not asked."""
    placing.autopilot.params.PLDP.RNG_MAX = 2.0
    placing.sensors.rangefinder_count, placing.sensors.rangefinder_range[0] = count, reading
    watch(placing, 3.0, 0.5)
    assert watch(placing, 1.0, 0.3) == stage
    assert said(placing) == texts


@pytest.mark.parametrize(
    ("before", "after", "texts"),
    [
        (law.FLYING, law.DONE, [law.ABORTED]),
        (law.STARTING, law.DONE, [law.ABORTED]),
        (law.DESCENDING, law.RELEASING, [law.BY_HAND]),
        (law.WAITING, law.WAITING, []),
    ],
)
def test_an_open_gripper(placing: Any, before: int, after: int, texts: list[int]) -> None:
    ap = placing.autopilot
    ap.modes.payload_place.stage = before
    law.note_open(ap.modes.payload_place, ap.events, placing.time_us, -8.0)
    assert ap.modes.payload_place.stage == after
    assert said(placing) == texts


@pytest.mark.parametrize("gripper", [law.NO_GRIPPER, law.HOLDS])
def test_release_wait_and_climb(placing: Any, gripper: int) -> None:
    """The shell is asked to open the gripper, once; then PLDP_DELAY, then up to where the descent began."""
    ap = placing.autopilot
    place, path = ap.modes.payload_place, ap.control.pos_d
    ap.params.PLDP.DELAY = 1.0
    place.placed_us = placing.time_us - 600_000
    place.gripper, place.stage = gripper, law.RELEASING
    ap.estimate.pos, ap.estimate.vel = ap.estimate.pos.replace(z=-2.0), ap.estimate.vel.replace(z=0.4)
    law.release(placing)
    assert path.vel_desired == 0.0, "the descent is over"
    if gripper == law.HOLDS:
        assert codes(placing) == [PAYLOAD_PLACE_DID, COMMAND_ARRIVED]
        assert ap.events.attention
        wait(placing, 2.0)
        law.release(placing)
        assert place.stage == law.OPENING
        place.gripper = law.OPEN
        placing.time_us -= 2_000_000
    law.release(placing)
    assert place.stage == law.WAITING
    wait(placing, 0.91)
    law.release(placing)
    assert place.stage == law.CLIMBING
    path.pos_desired = place.start_d + 0.02
    law.release(placing)
    assert place.stage == law.CLIMBING
    path.pos_desired = place.start_d + 0.01
    law.release(placing)
    assert place.stage == law.DONE


def test_a_landed_vehicle_lets_go(placing: Any) -> None:
    ap = placing.autopilot
    ap.arming.landed_maybe = True
    law.run(placing)
    assert said(placing)[0] == law.LANDED
    assert ap.modes.payload_place.stage == law.WAITING


def test_texts() -> None:
    notes = PAYLOAD_PLACE_DID.notes
    assert notes(None, law.PLACED, 0.45) == [Text(6, "PayloadPlace: payload release thrust threshold: 0.450000")]
    assert notes(None, law.AT_LIMIT, 0.0) == [Text(4, "PayloadPlace: Reached maximum descent")]
