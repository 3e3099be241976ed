# SPDX-License-Identifier: BSD-3-Clause
"""Whatever a client sends: nothing raises, and what is refused leaves the record as it was."""

from __future__ import annotations

import math
import random
import struct
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.bridge import Bridge
from sitl.bridge.copter.vehicle_commands import COMMANDS as OF_COPTERS
from sitl.bridge.dialect import MessageType, message, message_by_id
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.bridge.rover.vehicle_commands import COMMANDS as OF_ROVERS
from tests.bridge.fakes import Bench, FakeRover, FakeVehicle

HANDLED = sorted(Bench().bridge._handlers)
FLOATS = st.sampled_from([0.0, 1.0, -1.0, math.nan, math.inf, -math.inf, 3e38, -3e38, 1e-40, 90.0, 400.0, 65536.0])
SAFE_RESULTS = range(6)


def packed(kind: MessageType, rng: random.Random, floats: list[float]) -> bytes:
    """A payload of this message with awkward numbers in all floats, small or extreme ones in the integers."""
    layout = struct.Struct(kind.pack.__self__.format)
    values: list[Any] = []
    for piece in _codes(layout.format):
        if piece in "fd":
            values.append(rng.choice(floats))
        elif piece.endswith("s"):
            values.append(rng.choice([b"MAV_GCS_SYSID", b"", b"\xff" * 16, b"NO_SUCH"]))
        else:
            bits = 8 * struct.calcsize("<" + piece)
            low, high = (0, 2**bits - 1) if piece.isupper() else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
            values.append(rng.choice([0, 1, 2, 3, min(255, high), low, high, rng.randint(low, high)]))
    return layout.pack(*values)


def _codes(text: str) -> list[str]:
    found, number = [], ""
    for c in text.lstrip("<"):
        if c.isdigit():
            number += c
        else:
            found += [number + "s"] if c == "s" else [c] * int(number or 1)
            number = ""
    return found


@settings(max_examples=150, deadline=None)
@given(
    st.integers(0, 2**32),
    st.lists(FLOATS, min_size=1, max_size=4),
    st.sampled_from([(FakeVehicle, 0), (FakeVehicle, 4), (FakeRover, 0), (FakeRover, 15)]),
    st.booleans(),
)
def test_awkward_numbers_in_every_message(
    seed: int, floats: list[float], what: tuple[type[FakeVehicle], int], located: bool
) -> None:
    rng = random.Random(seed)
    kind_of_vehicle, mode = what
    bench = Bench(kind_of_vehicle())
    if located:
        bench.vehicle.locate()
    bench.vehicle.v.autopilot.modes.number = mode
    for number in HANDLED:
        kind = message_by_id(number)
        bench.client.link.send(
            encode_v2(kind, packed(kind, rng, floats), rng.randint(0, 255), rng.choice([255, 3]), 190)
        )
    bench.run(0.1)
    for call in bench.autopilot.calls:
        for value in _numbers(call):
            assert math.isfinite(value), call


def _numbers(value: Any) -> list[float]:
    if isinstance(value, tuple | list) and type(value).__name__ != "Yaw":
        return [n for v in value for n in _numbers(v)]
    return [value] if isinstance(value, float) else []


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from([FakeVehicle, FakeRover]),
    st.sampled_from(sorted({*OF_COPTERS, *OF_ROVERS, 16, 999})),
    st.lists(FLOATS, min_size=7, max_size=7),
    st.booleans(),
    st.integers(0, 255),
)
def test_every_command_is_answered_once_and_a_refusal_changes_nothing(
    vehicle: type[FakeVehicle], number: int, p: list[float], as_int: bool, frame: int
) -> None:
    bench = Bench(vehicle())
    bench.vehicle.locate()
    bench.autopilot.ok = False
    before = bench.vehicle.fleet.tobytes()
    if as_int:
        asked: Any = mavlink.MAVLink_command_int_message(1, 1, frame, number, 0, 0, *p[:4], 5, 7, p[6])
    else:
        asked = mavlink.MAVLink_command_long_message(1, 1, number, 0, *p)
    acks = bench.ask(asked, "COMMAND_ACK")
    assert [m.command for m in acks] == [number] and acks[0].result in SAFE_RESULTS
    if acks[0].result != 0:
        assert bench.vehicle.fleet.tobytes() == before


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 8))
def test_mutated_frames(seed: int, flips: int) -> None:
    rng = random.Random(seed)
    bench = Bench()
    for number in HANDLED:
        kind = message_by_id(number)
        encode = rng.choice((encode_v1, encode_v2))
        raw = bytearray(encode(kind, packed(kind, rng, [0.0, 1.0]), 0, 255, 190))
        for _ in range(flips):
            if raw:
                raw[rng.randrange(len(raw))] = rng.randrange(256)
        bench.client.link.send(bytes(raw[: rng.randint(0, len(raw))]) if rng.random() < 0.2 else bytes(raw))
    bench.client.link.send(bytes(300))
    asked = mavlink.MAVLink_command_long_message(0, 0, 512, 0, 30, 0, 0, 0, 0, 0, 0)
    bench.run(0.1)
    assert "COMMAND_ACK" in {m.get_type() for m in bench.ask(asked)} or bench.bridge.channels[0].version == 1


@settings(max_examples=100, deadline=None)
@given(st.lists(st.binary(max_size=300), max_size=10))
def test_random_bytes(noise: list[bytes]) -> None:
    bench = Bench()
    before = bench.vehicle.fleet.tobytes()
    for data in noise:
        bench.client.link.send(data)
        bench.bridge.receive()
    assert bench.vehicle.fleet.tobytes() == before
    bench.client.link.send(bytes(300))
    assert bench.command(512, 30) == 0


def test_two_services_cannot_take_the_same_message() -> None:
    bridge: Bridge = Bench().bridge
    name = message("PARAM_SET").name
    try:
        bridge._add_handler(name, lambda *_: None)
    except ValueError as error:
        assert name in str(error)
    else:
        raise AssertionError("accepted")
