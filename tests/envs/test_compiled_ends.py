# SPDX-License-Identifier: BSD-3-Clause
"""The environment's end of MAVLink for a fleet: the same bytes as for one vehicle, whose meaning other tests have, and
the same that is known of a vehicle from its bytes."""

from __future__ import annotations

import ctypes
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter
from sitl.bridge.wire.port import INCOMING, OUT, SIZE, Port
from sitl.core.memory import record_at
from sitl.core.vectors import Euler, Vec3
from sitl.envs.mavlink import compiled, target_messages
from sitl.envs.mavlink.last_messages import PART, StepTelemetry
from sitl.envs.robots.in_fleet import ENCODINGS
from tests.envs.test_step_telemetry import beat, frame

KINDS = sorted({encode.__name__: encode for table in (target_messages.COPTER, target_messages.ROVER)
                for encode in table.values()}.items())  # fmt: skip
ORIGIN = (1.0, 4.0, -2.0)
"""NED of the vehicle's local frame in the world [m]."""
STICKS = (1500.4, 1499.6, 0.0, 2000.0, 1100.0, 1234.5, 1235.5, 1900.0)
SYSTEM, HEADING = 5, 2.0


def written(kind: int, row: tuple[float, ...]) -> tuple[int, bytes]:
    """Number of the message that the compiled law writes for the second of two vehicles, and its memory."""
    end: Any = SimpleNamespace(system=SYSTEM, euler=Euler(0.7, -0.6, HEADING), sequence=3)
    memory = ctypes.create_string_buffer(300)
    commands = np.array([np.full(len(row), 0.123), row])
    number = compiled.write_setpoint(kind, commands, 1, end, Vec3(*ORIGIN), ctypes.addressof(memory))
    return number, memory.raw


@pytest.mark.parametrize(("name", "encode"), KINDS)
@pytest.mark.parametrize("row", [(0.1, -0.2, 0.3, 0.6), (-0.25, 0.15, -0.4, -1.0), (0.0, 0.0, 0.0, 0.0)])
def test_a_fleet_gets_the_bytes_that_one_vehicle_gets(name: str, encode: Any, row: tuple[float, ...]) -> None:
    inbox = StepTelemetry(1)
    inbox.system, inbox.attitude = SYSTEM, (0, 0.7, -0.6, HEADING, 0.0, 0.0, 0.0)
    given = STICKS if encode is target_messages.override else row
    kind, payload = encode(given, inbox, ORIGIN)
    number, memory = written(ENCODINGS[encode], given)
    assert number == kind.id
    assert kind.decode(memory)._asdict() == {
        name: pytest.approx(value, abs=1e-6) for name, value in kind.decode(payload)._asdict().items()
    }


def test_every_kind_of_set_point_has_a_number_of_its_own() -> None:
    assert sorted(ENCODINGS.values()) == list(range(len(KINDS)))
    assert set(ENCODINGS) == {encode for _, encode in KINDS}


@pytest.mark.parametrize("rows", [[0], [1], [1, 0]])
def test_set_points_go_to_the_vehicles_that_are_meant_in_frames_of_a_ground_station(rows: list[int]) -> None:
    """MAVLink 2, from system 255, component 190; sequence numbers count to 255; what waits in the port stays."""
    ports = ctypes.create_string_buffer(2 * SIZE)
    ends: Any = [SimpleNamespace(system=5 + k, euler=Euler(0.0, 0.0, 0.0), sequence=255 - k) for k in range(2)]
    address = ctypes.addressof(ports)
    waiting = b"before"
    for k in range(2):
        ctypes.memmove(address + k * SIZE + INCOMING, waiting, len(waiting))
        record_at(Port, address + k * SIZE).in_size = len(waiting)
    commands = np.array([(1.0, 2.0, 3.0, 0.5), (4.0, 5.0, 6.0, 0.25)])
    compiled.send_setpoints(ends, np.zeros((2, 3)), address, np.array(rows), compiled.VELOCITY, commands)
    for k in range(2):
        size = record_at(Port, address + k * SIZE).in_size
        data = ports.raw[k * SIZE + INCOMING : k * SIZE + INCOMING + size]
        if k not in rows:
            assert data == waiting and ends[k].sequence == 255 - k
            continue
        ((kind, payload, sequence, system, component, *_),) = Splitter().cut(data[len(waiting) :])
        fields = kind.decode(payload)
        assert data.startswith(waiting) and (sequence, system, component) == (255 - k, 255, 190)
        assert (fields.target_system, fields.vx, fields.vz) == (5 + k, commands[k, 0], -commands[k, 2])
        assert ends[k].sequence == (0, 255)[k]


# ---------------------------------------------------------------- what is known of a vehicle


def part(number: int, time_usec: int, name: bytes = b"LASER") -> bytes:
    return frame("DEBUG_FLOAT_ARRAY", array_id=number, time_usec=time_usec, name=name,
                 data=[100.0 * number + k for k in range(PART)])  # fmt: skip


HEARD = {
    "position": frame("LOCAL_POSITION_NED", time_boot_ms=100, x=1, y=2, z=3, vx=4, vy=5, vz=6),
    "attitude": frame("ATTITUDE", time_boot_ms=90, roll=0.5, pitch=0.25, yaw=2, rollspeed=1, pitchspeed=2, yawspeed=3),
    "armed": beat(base_mode=209, custom_mode=4),
    "disarmed": beat(base_mode=81, custom_mode=17),
    "touched": frame("STATUSTEXT", text=b"SIM Hit obstacle at 3 m/s"),
    "another text": frame("STATUSTEXT", text=b"Hit SIM obstacle"),
    "a text's beginning": frame("STATUSTEXT", text=b"SIM Hi"),
    "a scan": part(0, 1000) + part(1, 1000),
    "its parts the other way round": part(1, 1000) + part(0, 1000),
    "half a scan": part(1, 1000),
    "parts of two scans": part(0, 1000) + part(1, 2000),
    "the second after half of one": part(0, 1000) + part(0, 2000) + part(1, 2000),
    "a part that is none": part(2, 1000) + part(0, 1000),
    "another's array": part(0, 1000, b"OTHER") + part(1, 1000),
    "a report": frame("SYS_STATUS", voltage_battery=11850, current_battery=1234, battery_remaining=87),
    "noise": b"\xfd\x00" + beat(base_mode=209, custom_mode=4)[:9],
}


@pytest.mark.parametrize("name", HEARD)
def test_a_fleets_end_knows_what_one_vehicles_telemetry_knows(name: str) -> None:
    readings = PART + 3
    plain = StepTelemetry(readings, [message("SYS_STATUS")])
    plain.feed(beat() + HEARD[name])
    end: Any = compiled.ClientEnd.of(compiled.ClientEnd.fleet(1), 0)
    end.parts = 2
    ports = ctypes.create_string_buffer(SIZE)
    address, data = ctypes.addressof(ports), beat() + HEARD[name]
    ctypes.memmove(address + OUT, data, len(data))
    port = record_at(Port, address)
    port.out_size, port.out_count = len(data), 3
    scans, coming = (np.full((1, n), np.inf, np.float32) for n in (readings, 2 * PART))
    compiled.read_ports([end], scans, coming, address, np.array([0]))  # type: ignore[arg-type]
    assert (port.out_size, port.out_count) == (0, 0)
    assert (end.mode, bool(end.armed), end.hits, end.scans) == (plain.mode, plain.armed, plain.hits, plain.scans)
    assert scans[0].tolist() == plain.scan[:readings].tolist()
    if name == "position":
        assert (end.position_ms, *end.position, *end.velocity) == plain.position
    if name == "attitude":
        assert (end.attitude_ms, *end.euler, *end.rates) == plain.attitude
    assert end.reports.tolist() == pytest.approx(plain.reports.tolist())


@pytest.mark.parametrize(("heading", "ahead", "left"), [(0.0, 4.0, -5.0), (math.pi / 2, 5.0, 4.0)])
def test_what_is_known_is_shown_in_the_worlds_axes(heading: float, ahead: float, left: float) -> None:
    """x north, y west, z up, counter-clockwise; positions are those of the robot's base, 0.5 m ahead of its body's."""
    ends: Any = [compiled.ClientEnd.of(compiled.ClientEnd.fleet(2), k) for k in range(2)]
    ends[1].position, ends[1].velocity = Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0)
    ends[1].euler, ends[1].rates, ends[1].hits = Euler(0.1, 0.2, heading), Vec3(0.3, 0.4, 0.5), 2
    robots = compiled.robot_arrays(2, 3)
    robots.began_us[1] = 400_000
    origins = compiled.Origins(np.array([(9.0, 9.0, 9.0), (10.0, 20.0, -30.0)]), np.array([0, 1_000_000]),
                               np.array([0, 5_000_000]))  # fmt: skip
    ports = ctypes.create_string_buffer(2 * SIZE)
    coming = np.zeros((2, PART), np.float32)
    compiled.show_robots(ends, coming, ctypes.addressof(ports), origins, 0.5, robots, np.array([1]))
    x, y = 11.0 + 0.5 * math.cos(heading), -22.0 - 0.5 * math.sin(heading)
    assert robots.state[1].tolist() == pytest.approx(
        [x, y, 27.0, -heading, ahead, left, -6.0, -0.5, 0.1, 0.2, 0.3, 0.4]
    )
    assert robots.time[1] == pytest.approx(5.6) and robots.collided.tolist() == [0, 1] and ends[1].hits == 0
    assert not robots.state[0].any()
    compiled.show_robots(ends, coming, ctypes.addressof(ports), origins, 0.5, robots, np.array([1]))
    assert robots.collided[1] == 0, "a touch is shown once"
