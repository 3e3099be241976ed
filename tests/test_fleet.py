# SPDX-License-Identifier: BSD-3-Clause
"""A fleet flies as so many simulations of their own, bit for bit, in its records and in its bytes."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.bridge.links import InProcessLink
from sitl.client import Client
from sitl.errors import OptionError
from sitl.fleet import Fleet
from sitl.move import Move
from sitl.simulation import Simulation, Snapshot
from sitl.vehicle.core_entry import Core, load_core
from sitl.vehicle.kinds import KINDS
from sitl.worlds import load as load_world

VELOCITY_ONLY = 0x5C7
FRAMES = {"copter": "erle_copter", "rover": "erle_rover"}
N = 4


def core_of(kind: str) -> Core:
    return load_core(KINDS[kind])


def says(name: str, sequence: int = 0, **fields: Any) -> bytes:
    """A message of a ground station."""
    kind = message(name)
    return encode_v2(kind, kind.payload(**fields), sequence, 255, 190)


def command(number: int, *params: float) -> bytes:
    values = {f"param{k}": value for k, value in enumerate(params, 1)}
    return says("COMMAND_LONG", command=number, target_system=1, target_component=1, **values)


def velocity(vx: float, vy: float = 0.0, vz: float = 0.0) -> bytes:
    motion = {"vx": vx, "vy": vy, "vz": vz}
    return says("SET_POSITION_TARGET_LOCAL_NED", target_system=1, coordinate_frame=1, type_mask=VELOCITY_ONLY, **motion)


@pytest.fixture(scope="module", params=FRAMES)
def kind(request: Any) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def under_way(kind: str) -> Snapshot:
    """In GUIDED, armed, a copter at 5 m, with two streams at 10 Hz."""
    simulation = Simulation(FRAMES[kind], core=core_of(kind))
    client = Client(simulation)
    client.wait_ready()
    if KINDS[kind].flies:
        client.take_off(5.0)
    else:
        client.set_mode("GUIDED")
        client.arm()
    client.set_rate("ATTITUDE", 10)
    client.set_rate("LOCAL_POSITION_NED", 10)
    simulation.advance(0.05)
    assert simulation.v.autopilot.arming.armed
    return simulation.snapshot()


@pytest.fixture
def fleet(kind: str, under_way: Snapshot) -> Iterator[Fleet]:
    made = Fleet(FRAMES[kind], N, core=core_of(kind))
    made.put(range(N), under_way)
    yield made
    made.close()


class Singles:
    """The same vehicles, each in a simulation of its own."""

    def __init__(self, kind: str, start: Snapshot) -> None:
        self.simulations = [Simulation(FRAMES[kind], core=core_of(kind)) for _ in range(N)]
        self.links = [InProcessLink() for _ in range(N)]
        for simulation, link in zip(self.simulations, self.links, strict=True):
            simulation.bridge.add_link(link)
            simulation.restore(start)
            link.receive()

    def go(self, fleet: Fleet, seconds: float, words: Callable[[int], bytes]) -> None:
        """Let both act on ``words(index)`` and go on; they say and are the same."""
        for index in range(N):
            fleet.send(index, words(index))
            self.links[index].send(words(index))
        fleet.advance(seconds)
        for index, (simulation, link) in enumerate(zip(self.simulations, self.links, strict=True)):
            simulation.advance(seconds)
            assert fleet.receive(index) == link.receive(), index
            assert fleet.records[index].tobytes() == simulation.fleet.tobytes(), index
            assert fleet.time_us[index] == simulation.time_us


def test_set_points_and_telemetry(kind: str, under_way: Snapshot, fleet: Fleet) -> None:
    singles = Singles(kind, under_way)
    for step in range(30):
        singles.go(fleet, 0.1, lambda k, s=step: velocity((k - 1.5) * (1 if s < 15 else -1)))  # type: ignore[misc]
    assert len({record["autopilot"]["estimate"]["vel"][0] for record in fleet.records}) == N


def test_what_needs_the_shell(kind: str, under_way: Snapshot, fleet: Fleet) -> None:
    """Commands, parameters, texts, a mission, a reboot: of some vehicles, the others go on."""
    words: dict[tuple[int, int], bytes] = {
        (2, 0): velocity(1.0) + command(512, 33) + velocity(0.5),
        (3, 1): says("PARAM_SET", target_system=1, param_id=b"WP_SPD" if kind == "copter" else b"WP_SPEED",
                     param_value=3.0, param_type=9),
        (3, 2): says("PARAM_SET", target_system=1, param_id=b"FRSKY_OPTIONS", param_value=3.0, param_type=9),
        (4, 2): command(20),
        (4, 3): says("MISSION_COUNT", target_system=1, target_component=1, count=1),
        (6, 3): says("PARAM_REQUEST_LIST", target_system=1, target_component=1),
        (8, 1): command(511, 30, 20_000),
        (8, 0): command(400, 0, 21196),
        (9, 0): command(246, 1),
        (12, 2): says("MANUAL_CONTROL", target=1, x=100, y=-200, z=500, r=30),
    }  # fmt: skip
    singles = Singles(kind, under_way)
    for step in range(25):
        singles.go(fleet, 0.2, lambda k, s=step: words.get((s, k), b""))  # type: ignore[misc]
    numbers = [int(record["autopilot"]["modes"]["number"]) for record in fleet.records]
    assert numbers[1] != numbers[2]
    assert int(fleet.records["time_us"][0]) < int(fleet.records["time_us"][1])  # it was rebooted
    kept = [fleet.simulation(k).parameters["FRSKY_OPTIONS"] for k in range(N)]
    assert kept == [s.parameters["FRSKY_OPTIONS"] for s in singles.simulations] == [0.0, 0.0, 3.0, 0.0]


def test_more_bytes_than_a_port_holds(kind: str, under_way: Snapshot, fleet: Fleet) -> None:
    singles = Singles(kind, under_way)
    many = b"".join(velocity(0.01 * k) for k in range(60))
    for _ in range(3):
        singles.go(fleet, 0.05, lambda k: many if k == 2 else b"")


def test_frames_in_pieces(kind: str, under_way: Snapshot, fleet: Fleet) -> None:
    singles, words = Singles(kind, under_way), velocity(1.0) + command(512, 33)
    for start in range(0, len(words), 7):
        singles.go(fleet, 0.0125, lambda k, s=start: words[s : s + 7])  # type: ignore[misc]


def test_nobody_reads(kind: str, under_way: Snapshot, fleet: Fleet) -> None:
    """What there is no room for in a port is kept elsewhere, in order."""
    singles = Singles(kind, under_way)
    fleet.advance(60.0)
    for index, (simulation, link) in enumerate(zip(singles.simulations, singles.links, strict=True)):
        simulation.advance(60.0)
        assert fleet.receive(index) == link.receive()


def test_threads_and_order_change_nothing(kind: str, under_way: Snapshot) -> None:
    def fly(threads: int, order: list[int]) -> list[bytes]:
        fleet = Fleet(FRAMES[kind], 7, threads=threads, core=core_of(kind))
        fleet.put(range(7), under_way)
        for step in range(8):
            for index in order:
                fleet.send(index, velocity(0.2 * index, 0.05 * step))
            fleet.advance(0.1)
        found = [fleet.records[k].tobytes() + fleet.receive(k) for k in range(7)]
        fleet.close()
        return found

    alone = fly(1, list(range(7)))
    assert fly(2, list(range(7))) == alone
    assert fly(3, [6, 1, 0, 5, 2, 4, 3]) == alone
    assert len(set(alone)) == 7


def test_some_go_on_and_others_wait(fleet: Fleet) -> None:
    began, waits = fleet.time_us, fleet.records[0].tobytes()
    fleet.advance(0.5, [1, 3])
    assert (fleet.time_us - began).tolist() == [0, 500_000, 0, 500_000]
    assert fleet.records[0].tobytes() == waits


def test_states_are_put_taken_and_looked_at(kind: str, fleet: Fleet) -> None:
    fleet.send(2, velocity(1.0))
    fleet.advance(1.0)
    taken = fleet.snapshot(2)
    single = fleet.simulation(2)
    fleet.put([0, 1], taken)
    fleet.put(3, taken, seed=7)
    fleet.advance(2.0)
    single.advance(2.0)
    assert fleet.records[0].tobytes() == fleet.records[1].tobytes() == fleet.records[2].tobytes()
    assert fleet.records[0].tobytes() == single.fleet.tobytes() != fleet.records[3].tobytes()
    view = fleet.view(1)
    fleet.advance(0.1)
    assert view is fleet.view(1) and view.time_us == fleet.records["time_us"][1]
    assert len(fleet) == N


def test_a_snapshot_of_another_vehicle_changes_nobody(kind: str, fleet: Fleet) -> None:
    other = Simulation(FRAMES["rover" if kind == "copter" else "copter"]).snapshot()
    before = fleet.records.tobytes()
    with pytest.raises(OptionError, match="the snapshot is of airframe"):
        fleet.put([0, 1], other)
    assert fleet.records.tobytes() == before


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"count": 0}, "count = 0; a whole number from 1 on is needed"),
        ({"count": 2.5}, r"count = 2\.5"),
        ({"threads": -1}, "threads = -1"),
        ({"physics": "hil:tcp:127.0.0.1:1"}, "no physics at|a fleet flies on native physics"),
    ],
)
def test_what_cannot_be_a_fleet(options: dict[str, Any], text: str) -> None:
    with pytest.raises((OptionError, ConnectionError), match=text):
        Fleet("erle_copter", **options)


def test_what_cannot_be_asked(fleet: Fleet) -> None:
    for index in (-1, N):
        with pytest.raises(OptionError, match=rf"no vehicle {index}; it has 0 \.\. 3"):
            fleet.send(index, b"")
    for which in ([1, N], [-1], [0.5]):
        with pytest.raises(OptionError, match="the fleet has no vehicle"):
            fleet.advance(0.1, which)  # type: ignore[arg-type]
    for seconds in (-1.0, math.nan, math.inf):
        with pytest.raises(OptionError, match="a number from 0 on"):
            fleet.advance(seconds)


def test_words_are_heard_at_power_on_without_time_going_by(kind: str) -> None:
    fleet = Fleet(FRAMES[kind], 2, core=core_of(kind))
    fleet.send(1, command(512, 148))
    fleet.advance(0.0)
    assert fleet.receive(0) == b"" and len(fleet.receive(1)) > 0
    assert fleet.time_us.tolist() == [0, 0]


def test_a_closed_fleet_can_only_be_looked_at(kind: str, under_way: Snapshot) -> None:
    fleet = Fleet(FRAMES[kind], 2, core=core_of(kind))
    fleet.close()
    for what in (lambda: fleet.send(0, b""), lambda: fleet.advance(0.1), lambda: fleet.put(0, under_way)):
        with pytest.raises(OptionError, match="the fleet is closed"):
            what()
    assert fleet.view(0).time_us == 0


PLAIN = """
from sitl.fleet import Fleet
import hashlib
fleet = Fleet("erle_rover", 2)
fleet.advance(0.02)
print(hashlib.sha256(fleet.records.tobytes() + fleet.receive(0) + fleet.receive(1)).hexdigest())
"""


def test_plain_python_gives_the_same_bits() -> None:
    found = [
        subprocess.run(
            [sys.executable, "-c", PLAIN],
            env={**os.environ, "NUMBA_DISABLE_JIT": switch},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for switch in ("0", "1")
    ]
    assert found[0] == found[1] != ""


def test_memory_of_a_vehicle() -> None:
    fleet = Fleet("erle_copter", 1)
    assert fleet.records.itemsize + fleet.ports.itemsize < 76_000
    assert np.all(fleet.time_us == 0)


def test_vehicles_of_a_fleet_are_in_different_worlds() -> None:
    """Each flies as in a fleet that is in its world alone."""
    first, second = (load_world(name) for name in ("rooms:seed=1", "rooms:seed=2"))
    core, still = core_of("copter"), Move(seed=3)
    both, alone = Fleet("erle_copter", 3, core=core, world=first), Fleet("erle_copter", 1, core=core, world=second)
    start, other = both.snapshot(0), alone.snapshot(0)
    both.enter(1, second)
    assert both.world(0) is first and both.world(1) is second
    with pytest.raises(OptionError, match=f"snapshot is of world {first.name}, vehicle 1 is in world {second.name}"):
        both.put(1, start)
    both.move([0, 1], [still, still], start)
    alone.move(0, still, other)
    for fleet in (both, alone):
        fleet.advance(1.0)
    assert both.records[1]["sensors"] == alone.records[0]["sensors"]
    assert both.records[0]["sensors"] != both.records[1]["sensors"]
    kept = both.snapshot(1)
    assert kept.world == second.name and both.simulation(1).world == second
    both.put(1, kept)


def test_a_fleet_without_a_world_stays_in_none() -> None:
    with pytest.raises(OptionError, match="made without a world stays in none"):
        Fleet("erle_copter", 1, core=core_of("copter")).enter(0, load_world("open"))


def test_the_shell_serves_a_vehicle_in_its_world() -> None:
    """A message that Python answers: the vehicle goes on among the solids of its own world."""
    first, second = load_world("open"), load_world("rooms:seed=2")
    fleet = Fleet("erle_copter", 2, core=core_of("copter"), world=first)
    start = fleet.snapshot(0)
    fleet.enter(1, second)
    fleet.move(1, Move(seed=1), start)
    quiet, asked = fleet.simulation(1), says("PARAM_REQUEST_READ", target_system=1, param_index=3)
    fleet.send(1, asked), fleet.send(0, asked)
    fleet.advance(0.5)
    quiet.advance(0.5)
    assert fleet.receive(1) and np.isinf(fleet.records[0]["sensors"]["lidar_ranges"][:5]).all()
    assert np.array_equal(
        fleet.records[1]["sensors"]["lidar_ranges"], quiet.fleet[0]["sensors"]["lidar_ranges"], equal_nan=True
    )
