# SPDX-License-Identifier: BSD-3-Clause
"""The same commands give the same bytes: again, elsewhere, from a snapshot; and INITIAL_MODE at power-on."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from pathlib import Path

import pytest

from sitl.core.mavlink import MavCmd
from sitl.simulation import Core, load_core
from sitl.vehicle.kinds import KINDS
from tests.drives import rover_driver as rover
from tests.drives.rover_driver import Driver
from tests.pilots.witness import Item

ALL = pytest.mark.parametrize("frame", rover.AIRFRAMES)


def act(d: Driver) -> bytes:
    """A drive through many modes; what was heard of it, and the record at its end."""
    side = 6.0 * d.cruise
    for k in range(8):
        d.stream(2.0, rover.VELOCITY, vx=d.cruise, vy=(-1) ** k * d.cruise)
        d.set_mode((rover.LOITER, rover.CIRCLE, rover.RTL, rover.SMART_RTL, rover.HOLD, rover.MANUAL)[k % 6])
        d.sticks(3.0, steering=1400 + 50 * k, throttle=1600)
        d.let_go()
        d.set_mode(rover.GUIDED)
    d.start_mission(Item(MavCmd.NAV_WAYPOINT, (side, 0.0)), Item(MavCmd.NAV_WAYPOINT, (side, side)))
    d.fly(20.0)
    return repr((d.rows, d.texts, d.acks)).encode() + d.simulation.fleet.tobytes()


def digest(frame: str) -> str:
    """Of a whole drive from power-on."""
    return hashlib.sha256(act(Driver(load_core(KINDS["rover"]), frame, seed=5).armed_in())).hexdigest()


@ALL
def test_again(core: Core, frame: str) -> None:
    first = act(Driver(core, frame, seed=5).armed_in())
    assert act(Driver(core, frame, seed=5).armed_in()) == first
    assert act(Driver(core, frame, seed=6).armed_in()) != first


def test_in_another_process() -> None:
    root = Path(__file__).parents[2]
    script = "from tests.drives.test_rover_drive_repeats import digest; print(digest('erle_rover'))"
    run = subprocess.run([sys.executable, "-c", script], cwd=root, capture_output=True, text=True, check=True)
    assert run.stdout.strip() == digest("erle_rover")


@ALL
def test_from_a_snapshot(core: Core, frame: str) -> None:
    """Restored, the vehicle and its telemetry go on as if nothing had been in between."""
    d = Driver(core, frame, seed=5).armed_in()
    d.start_mission(
        Item(MavCmd.NAV_WAYPOINT, (10.0 * d.cruise, 0.0)), Item(MavCmd.NAV_WAYPOINT, (0.0, 10.0 * d.cruise))
    )
    d.fly(8.0)
    snapshot = d.simulation.snapshot()
    record, mission = d.simulation.fleet.tobytes(), d.simulation.mission

    def go_on() -> bytes:
        sent = b""
        for _ in range(100):
            d.simulation.advance(0.1)
            sent += d.connection.endpoint.link.receive()
        return sent + d.simulation.fleet.tobytes()

    first = go_on()
    d.set_mode(rover.MANUAL)
    d.sticks(5.0, throttle=1700)
    d.let_go()
    d.simulation.restore(snapshot)
    assert d.simulation.fleet.tobytes() == record and d.simulation.mission is mission
    d.connection.endpoint.receive()
    assert go_on() == first


@ALL
def test_forks(core: Core, frame: str) -> None:
    """Two simulations from one snapshot: the same while they are told the same, then each its own."""
    parent = Driver(core, frame, seed=5).armed_in()
    parent.get_going(seconds=5.0)
    snapshot = parent.simulation.snapshot()
    children = [Driver(core, frame, seed=k) for k in (5, 9)]
    for child in children:
        child.simulation.restore(snapshot)
        child.stream(4.0, rover.VELOCITY, vx=child.cruise)
    assert children[0].simulation.fleet.tobytes() == children[1].simulation.fleet.tobytes()
    children[0].set_mode(rover.HOLD)
    children[1].stream(3.0, rover.VELOCITY, vy=children[1].cruise)
    assert children[0].simulation.fleet.tobytes() != children[1].simulation.fleet.tobytes()
    assert parent.simulation.time_us < children[0].simulation.time_us


INITIALISING = 16
NO_RADIO = {"SIM_RC_FAIL": 1.0, "FS_THR_ENABLE": 0.0}


def test_a_stored_mission_may_start_with_the_vehicle(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", **NO_RADIO).ready()
    assert d.upload(Item(MavCmd.NAV_WAYPOINT, (10.0, 0.0)), Item(MavCmd.NAV_WAYPOINT, (10.0, 10.0))) == 0
    d.set_parameter("INITIAL_MODE", rover.AUTO)
    d.simulation.request_reboot()
    d.simulation.advance(5.0)
    assert d.mode == rover.AUTO
    assert d.ap.modes.nav.mission_current == 0  # no place means anything yet
    d.simulation.advance(45.0)
    assert d.mode == rover.AUTO and d.ap.modes.nav.mission_current == 1


def test_a_mode_that_cannot_begin_yet_is_not_entered(core: Core) -> None:
    d = Driver(core, "ardupilot_rover", INITIAL_MODE=float(rover.LOITER), **NO_RADIO)
    d.simulation.advance(1.0)
    assert d.mode == INITIALISING
