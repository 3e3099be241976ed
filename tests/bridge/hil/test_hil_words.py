# SPDX-License-Identifier: BSD-3-Clause
"""What the physics says of itself, and what it answers, as the autopilot's end of HIL hears it."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter
from sitl.bridge.hil.autopilot_end import ELSEWHERE, TAKEN, WAITING, AutopilotEnd
from sitl.bridge.hil.protocol import Sender
from tests.bridge.hil.hil_bench import Bench, Vehicle

SENDER = Sender(1, 200)


@pytest.fixture
def bench() -> Bench:
    made = Bench()
    assert made.join() == TAKEN
    made.here.notes.clear()
    return made


def say(bench: Bench, text: bytes) -> int:
    kind = message("STATUSTEXT")
    return bench.here.feed(SENDER.frame(kind, kind.payload(severity=4, text=text)))


@pytest.mark.parametrize(
    ("count", "kept"), [(1, [0]), (5, [0, 1, 2, 3, 4]), (6, [1, 2, 3, 4, 5]), (12, [7, 8, 9, 10, 11])]
)
def test_the_last_five_words_of_the_physics_are_kept(bench: Bench, count: int, kept: list[int]) -> None:
    for k in range(count):
        assert say(bench, b"word %d" % k) == WAITING
    assert bench.here.notes == [f"physics: word {k}" for k in kept]


def test_words_that_are_no_text_are_kept_as_far_as_they_are(bench: Bench) -> None:
    say(bench, b"caf\xe9")
    assert bench.here.notes == ["physics: caf\ufffd"]


def test_words_cost_no_tick(bench: Bench) -> None:
    controls = bench.here.controls()
    say(bench, b"hello")
    assert bench.here.controls() == controls, "the same once more: nothing was answered"
    assert bench.here.feed(bench.there.feed(controls)) == TAKEN
    assert bench.autopilot.v.time_us == 2500


def heard(data: bytes) -> list[tuple[Any, ...]]:
    """Sender, name and fields of each frame."""
    return [(f.system, f.component, f.kind.name, f.kind.decode(f.payload)) for f in Splitter().feed(data)]


@pytest.mark.parametrize("vehicle_type", [2, 10, 13])
def test_the_first_words_say_who_it_is_and_what_the_world_is_to_be(vehicle_type: int) -> None:
    vehicle = Vehicle()
    end = AutopilotEnd(vehicle.fleet, vehicle.index, vehicle.v, vehicle_type)
    first, *rest = heard(end.hello({"SIM_WIND_SPD": 4.5, "SIM_BATT_VOLTAGE": 12.0}))
    assert first[:3] == (1, 1, "HEARTBEAT")
    said = first[3]._asdict()
    assert said == {
        "type": vehicle_type,
        "autopilot": mavlink.MAV_AUTOPILOT_ARDUPILOTMEGA,
        "base_mode": mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
        "custom_mode": 0,
        "system_status": mavlink.MAV_STATE_ACTIVE,
        "mavlink_version": 3,
    }
    told = [(*who[:3], who[3].param_id, who[3].param_value, who[3].param_type) for who in rest]
    assert told == [
        (1, 1, "PARAM_SET", b"SIM_WIND_SPD", 4.5, mavlink.MAV_PARAM_TYPE_REAL32),
        (1, 1, "PARAM_SET", b"SIM_BATT_VOLTAGE", 12.0, mavlink.MAV_PARAM_TYPE_REAL32),
    ]


def test_what_the_physics_is_asked(bench: Bench) -> None:
    end = bench.here
    asked = [fields for _, _, _, fields in heard(end.ask_truth() + end.ask_state() + end.ask_reboot())]
    assert [(f.command, f.param1, f.param2, f.confirmation) for f in asked] == [
        (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_HIL_STATE_QUATERNION, 0.0, 0),
        (mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_HIL_SENSOR, 0.0, 0),
        (mavlink.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, 1.0, 0.0, 0),
    ]


def test_a_parameter_that_the_physics_took_is_told_as_one_that_nobody_counts(bench: Bench) -> None:
    kind = message("PARAM_SET")
    fields = {"param_id": b"SIM_WIND_SPD", "param_value": 3.5, "param_type": mavlink.MAV_PARAM_TYPE_REAL32}
    ((_, _, name, told),) = heard(bench.there.feed(SENDER.frame(kind, kind.payload(**fields))))
    assert (name, told.param_id, told.param_value) == ("PARAM_VALUE", b"SIM_WIND_SPD", 3.5)
    assert (told.param_type, told.param_count, told.param_index) == (mavlink.MAV_PARAM_TYPE_REAL32, 1, 65535)


@pytest.mark.parametrize("seed", [0, 1 << 31, (1 << 32) - 1, 1 << 63, (1 << 64) - 1])
def test_a_seed_has_64_bits(bench: Bench, seed: int) -> None:
    bench.here.reseed(seed)
    bench.here.feed(bench.there.feed(bench.here.controls()))
    assert bench.physics.log[0] == ("seed", seed)


def test_the_physics_is_a_peripheral_of_the_same_system(bench: Bench) -> None:
    assert {(f.system, f.component) for f in Splitter().feed(bench.there.feed(bench.here.controls()))} == {(1, 158)}


def test_of_what_comes_together_the_most_counts(bench: Bench) -> None:
    """A tick, and behind it the same once more or one of another world."""
    tick = bench.there.feed(bench.here.controls())
    assert bench.here.feed(tick + tick) == TAKEN and bench.here.repeated == 1
    bench.here.controls()
    bench.autopilot.v.time_us += 2500
    assert bench.here.feed(tick) == ELSEWHERE


@pytest.mark.parametrize("system, component", [(1, 1), (7, 191)])
def test_who_commands_the_physics_is_answered(bench: Bench, system: int, component: int) -> None:
    kind = message("COMMAND_LONG")
    asked = Sender(system, component).frame(kind, kind.payload(command=mavlink.MAV_CMD_DO_JUMP))
    ((_, _, name, told),) = heard(bench.there.feed(asked))
    assert (name, told.command, told.result) == ("COMMAND_ACK", mavlink.MAV_CMD_DO_JUMP, mavlink.MAV_RESULT_UNSUPPORTED)
    assert (told.target_system, told.target_component) == (system, component)
