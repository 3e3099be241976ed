# SPDX-License-Identifier: BSD-3-Clause
"""The real program on our physics."""

from __future__ import annotations

import hashlib
import math
import signal
import socket

import pytest

from sitl.errors import OptionError
from sitl.foreign.betaflight.betaflight_session import starter
from sitl.foreign.betaflight.configuration import CommandLine
from sitl.foreign.betaflight.program import Program
from sitl.foreign.betaflight.receiver import MODES
from sitl.foreign.process import AutopilotEndedError, free_tcp_run
from tests.platforms import on_linux

ARM, SET_MODE, DENIED = 400, 176, 2
READY_S = 6.0


def hovering(pilot, height=3.0, seconds=6.0):
    """In the air, and what holds it there."""
    pilot.go_on(READY_S)
    assert pilot.command(SET_MODE, 1, 1) == 0
    assert pilot.command(ARM, 1) == 0
    hold = pilot.hold(height)
    pilot.go_on(seconds, hold)
    assert abs(pilot.body.pos[2] + height) < 0.3
    return hold


def test_it_hovers_and_a_flight_in_wind_repeats_to_the_bit(pilot):
    hashes = []
    for _ in range(2):
        flown = pilot(params={"SIM_WIND_SPD": 4.0, "SIM_WIND_TURB": 1.0}, seed=7)
        hovering(flown)
        digest = hashlib.sha256(flown.plant.vehicle.fleet["physics"].tobytes())
        digest.update(repr(flown.heard).encode())
        hashes.append(digest.hexdigest())
        assert math.hypot(*flown.body.pos[:2]) > 1.0
        flown.host.close()
    assert hashes[0] == hashes[1]


def test_it_does_not_arm_before_it_is_ready_and_says_why(pilot):
    early = pilot()
    early.go_on(1.0)
    assert early.command(ARM, 1) == DENIED
    assert any("BOOTGRACE" in text and "CALIB" in text for text in early.texts)
    early.go_on(READY_S)
    early.send("MANUAL_CONTROL", target=1, z=500)
    assert early.command(ARM, 1) == DENIED
    assert early.texts[-1] == "Arm: the throttle is not low (1050 us)"
    assert not early.host.face.is_armed


def test_it_is_disarmed_on_the_ground_and_in_the_air_by_force_alone(pilot):
    copter = pilot()
    copter.go_on(READY_S)
    assert copter.command(ARM, 1) == 0
    assert copter.all("HEARTBEAT")[-1].base_mode & 128
    assert copter.command(ARM, 0) == 0
    assert not copter.all("HEARTBEAT")[-1].base_mode & 128
    copter = pilot()
    hovering(copter, seconds=3.0)
    assert copter.command(ARM, 0, seconds=0.2) == DENIED
    assert copter.texts[-1] == "Disarm: not in the air (param2 21196 does)"
    assert copter.host.face.is_armed
    assert copter.command(ARM, 0, 21196) == 0


def test_modes_are_chosen_by_their_numbers_and_others_named(pilot):
    copter = pilot()
    for number in (2, 0, 1):
        assert copter.command(SET_MODE, 1, number, seconds=0.2) == 0
        assert copter.all("HEARTBEAT")[-1].custom_mode == number
    assert copter.command(SET_MODE, 1, 9, seconds=0.2) == DENIED
    assert copter.texts[-1] == "No mode 9; there are 0 ACRO, 1 ANGLE, 2 HORIZON"
    assert copter.command(512, 435, 0, seconds=0.2) == 0
    assert [mode.mode_name for mode in copter.all("AVAILABLE_MODES")] == [b"ACRO", b"ANGLE", b"HORIZON"]


def test_messages_that_make_no_sense_change_nothing(pilot):
    copter = pilot()
    copter.go_on(1.0)
    nan, inf = math.nan, math.inf
    before = copter.host.face.sticks.pulses()
    assert copter.command(SET_MODE, nan, inf, seconds=0.1) == DENIED
    assert copter.command(511, nan, nan, seconds=0.1) == DENIED
    assert copter.command(511, 30, 1, seconds=0.1) == DENIED
    assert copter.command(512, inf, seconds=0.1) == DENIED
    assert copter.command(ARM, nan, seconds=0.1) == 0  # not 1: to be disarmed, as it is
    copter.host.face.sticks.mode = MODES[0]
    for value in (nan, inf, -inf):
        copter.send("SET_ATTITUDE_TARGET", target_system=1, type_mask=128, body_roll_rate=value, thrust=value)
    copter.send("SET_ATTITUDE_TARGET", target_system=9, type_mask=128, body_roll_rate=1.0, thrust=0.5)
    copter.send("PARAM_SET", target_system=1, param_id=b"SIM_WIND_SPD", param_value=nan)
    copter.send("REQUEST_DATA_STREAM", target_system=1, start_stop=1, req_message_rate=65535)
    copter.host.face.feed(bytes(range(256)))
    copter.go_on(0.2)
    assert copter.host.face.sticks.pulses()[:4] == before[:4]
    assert copter.plant.vehicle.v.physics.wind.speed == 0.0


def test_in_acro_it_turns_as_fast_as_it_is_told(pilot):
    copter = pilot()
    hold = hovering(copter, seconds=4.0)
    assert copter.command(SET_MODE, 1, 0, seconds=0.1) == 0
    hold()
    for axis, name in enumerate(("body_roll_rate", "body_pitch_rate", "body_yaw_rate")):
        wanted = {name: 0.5}
        copter.go_on(0.4, lambda wanted=wanted: copter.send(
            "SET_ATTITUDE_TARGET", target_system=1, type_mask=128, q=(1, 0, 0, 0), thrust=0.45, **wanted
        ))  # fmt: skip
        assert copter.body.rates[axis] == pytest.approx(0.5, abs=0.15)


def test_lines_that_it_does_not_take_are_all_named(program, copter_plant):
    with pytest.raises(OptionError) as caught:
        starter(
            program, copter_plant, ["set no_such_name = 1", "set motor_idle = 99999", "feature NOTHING", "frobnicate"]
        )
    for part in ("'set no_such_name = 1': INVALID NAME", "'set motor_idle = 99999': INVALID VALUE",
                 "'feature NOTHING'", "'frobnicate': UNKNOWN COMMAND"):  # fmt: skip
        assert part in str(caught.value)


def test_its_configuration_is_what_was_typed(program, copter_plant, tmp_path):
    started = starter(program, copter_plant, ["set motor_idle = 777"], folder=tmp_path)(None)
    try:
        assert "motor_idle = 777" in CommandLine(started).type("get motor_idle")
    finally:
        started.close()
    again = starter(program, copter_plant, folder=tmp_path)(None)  # a folder that is kept has its own
    try:
        line = CommandLine(again)
        assert "motor_idle = 777" in line.type("get motor_idle")
        assert "aux 1 1 1 1700 2100" in line.type("aux")
    finally:
        again.close()


def test_a_killed_program_is_named(pilot):
    copter = pilot()
    copter.go_on(1.0)
    copter.host.program.process._signal(signal.SIGKILL)
    with pytest.raises(AutopilotEndedError, match=r"betaflight_SITL.elf was ended by signal 9"):
        copter.go_on(1.0)


def test_while_it_is_stopped_time_stands_and_it_flies_on_after(pilot):
    copter = pilot()
    hold = hovering(copter, seconds=4.0)
    copter.host.program.process._signal(signal.SIGSTOP)
    copter.host.step()
    stands = copter.host.time_us
    assert not copter.host.listen() and copter.host.time_us == stands
    copter.host.program.process._signal(signal.SIGCONT)
    copter.go_on(3.0, hold)
    assert abs(copter.body.pos[2] + 3.0) < 0.2


def test_a_configurator_has_a_port_and_its_save_starts_the_program_again(pilot):
    port = free_tcp_run(1)
    copter = pilot(users_port=port)
    copter.go_on(2.0)
    program = copter.host.program
    with socket.create_connection(("127.0.0.1", port)) as configurator:
        copter.go_on(0.1)
        configurator.sendall(b"#")
        copter.go_on(0.3)
        configurator.sendall(b"set motor_idle = 900\nsave\n")
        copter.go_on(1.0)
    assert copter.host.program is not program
    assert "Betaflight has rebooted" in copter.texts and copter.notes[0].startswith("betaflight reboots at")
    copter.go_on(READY_S)
    assert copter.command(ARM, 1) == 0
    assert copter.plant.vehicle.v.actuators.pwm[0] == pytest.approx(1090, abs=15)


@on_linux
def test_a_program_that_is_none_says_so(tmp_path, copter_plant):
    script = tmp_path / "not-betaflight"
    script.write_text("#!/bin/sh\necho I am none\nexit 3\n")
    script.chmod(0o755)
    with pytest.raises(AutopilotEndedError, match="ended with code 3; it said: I am none"):
        starter(script, copter_plant)


def test_a_program_that_is_killed_by_us_leaves_nothing(program):
    started = Program(program)
    folder = started.process.folder
    started.close()
    assert not folder.exists() and not started.process.is_running()
