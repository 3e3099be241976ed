# SPDX-License-Identifier: BSD-3-Clause
"""An airframe from a log of a copter whose properties are known; what a log cannot tell is said."""

from __future__ import annotations

import math
import re
import struct
from dataclasses import replace

import numpy as np
import pytest

from sitl import cli, vehicles
from sitl.autopilot.copter.parameters import TABLE
from sitl.core.constants import GRAVITY
from sitl.identify import IdentifyError, hover, identify
from sitl.identify.expected import Conditions, Copter
from sitl.logs.tlog import LogError
from sitl.missions import files
from tests.logs.log_files import V32, binary, old_flight, without_messages

FULL = Conditions(math.nan, 1.0, 0.0)


@pytest.fixture(scope="session")
def found(flown):
    return identify(flown)


def test_estimates_contain_the_truth_and_others_say_why_not(found) -> None:
    log, airframe = found.logs[0], vehicles.load("erle_copter")
    known = Copter(airframe, log.parameters, log.conditions).properties()
    known |= {name: float(airframe.value(name)) for name in ("baro_noise", "gyro_noise_density")}
    for name in ("hover_output", "yaw_effectiveness", "drag_mcoef", "gyro_noise_density", "baro_noise"):
        estimate = found[name]
        assert estimate.low < known[name] < estimate.high, f"{estimate}, truth {known[name]}"
    for name in ("roll_effectiveness", "pitch_effectiveness"):
        assert found[name].value == pytest.approx(known[name], rel=0.05) and found[name].relative < 0.05, str(
            found[name]
        )
    assert found["motor_lag"].low < known["motor_lag"] < found["motor_lag"].high
    assert found["motor_lag"].low > 0.0
    assert all(estimate.is_observed or estimate.reason for estimate in found.estimates)
    assert "battery_capacity: not observable in this log: " in found.table()


def test_the_airframe_answers_as_the_vehicle_did(found, tmp_path, flown, capsys) -> None:
    out = tmp_path / "mine.toml"
    assert cli.main(["identify", str(flown), "--mass", "2.0", "--out", str(out)]) == 0
    assert "hover_output: 0.57" in capsys.readouterr().out
    mine, log = vehicles.load(str(out)), found.logs[0]
    assert mine.value("mass") == 2.0
    answers = Copter(mine, log.parameters, log.conditions).properties()
    for name in ("hover_output", "roll_effectiveness", "pitch_effectiveness", "yaw_effectiveness", "drag_mcoef"):
        assert answers[name] == pytest.approx(found[name].value, rel=0.01), name
    assert mine.value("time_constant_up") == pytest.approx(found["motor_lag"].value)
    assert mine.value("baro_noise") == found["baro_noise"].value
    text = out.read_text()
    assert "identified, by hover_output: 0.57" in text and "identified, by roll_effectiveness" in text


def test_a_log_that_ends_in_the_air_still_tells(flown, tmp_path) -> None:
    data = flown.read_bytes()
    path = tmp_path / "cut.bin"
    path.write_bytes(data[: int(0.7 * len(data))])
    part = identify(path)
    assert part.logs[0].notes == [
        "cut.bin: it is cut off within a message",
        "cut.bin: it ends while the vehicle is armed: it is read up to there",
    ]
    assert identify(flown).logs[0].notes == ["flight.bin: it ends while the vehicle is armed: it is read up to there"]
    assert part["hover_output"].is_observed
    assert part.logs[0].seconds < 0.8 * identify(flown).logs[0].seconds


def test_pulses_that_hardly_move_are_said(flown, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.rates.resolution", lambda log: 1.0)
    reason = identify(flown)["roll_effectiveness"].reason
    assert "less than 0.15 of a microsecond of the motors' pulses" in reason


def test_a_log_of_no_rest_tells_no_noise(flown, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.log_streams.FlightLog.at_rest", property(lambda log: []))
    estimate = identify(flown)["gyro_noise_density"]
    assert math.isnan(estimate.value) and "LOG_DISARMED 1" in estimate.reason


def test_rates_that_are_too_low_are_said(flown, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.rates._LEAST_HZ", 60.0)
    assert "RATE is logged at 50 Hz; 60 Hz are needed" in identify(flown)["roll_effectiveness"].reason


def test_logs_of_no_use_are_named(flown, tmp_path) -> None:
    data = flown.read_bytes()
    for name, content, says in (
        ("no_parm.bin", data.replace(b"PARM", b"PXRM"), "has no PARM"),
        ("ground.bin", data[: len(data) // 5], "never in the air"),
        ("plane.bin", data.replace(b"ArduCopter V", b"MArduPlane V"), "is of a plane"),
        ("sub.bin", data.replace(b"ArduCopter V", b"MMMArduSub V"), "is of a submarine"),
        ("heli.bin", data.replace(b"ArduCopter V", b"MMArduHeli V"), "is of a helicopter"),
        ("heli6.bin", _with_parameter(data, b"FRAME_CLASS", 6.0), r"is of a helicopter \(FRAME_CLASS 6\)"),
        ("three.bin", _of_version(data, b"3.3"), r"is of ArduCopter V3\.3.*; logs of copters are .* ArduPilot 3\.4 on"),
        ("old.bin", binary(old_flight(), V32), r"is of ArduCopter V3\.2\.1 .*; logs of copters are identified from"),
        ("text.bin", b"hello there\n", "is no log but a text: it begins with 'hello there'; logs of ArduPilot are"),
        ("empty.bin", b"", "is empty; logs of ArduPilot are read"),
        ("px4.ulg", b"ULog\x01\x12\x35" + bytes(90), r"is a log of PX4 \(.ulg\); logs of ArduPilot are read"),
        ("packed.bin", b"\x1f\x8b" + bytes(90), r"is a packed file \(.gz\)"),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises((IdentifyError, LogError), match=rf"{name}' {says}|{name}': .*{says}"):
            identify(path)
    rover = tmp_path / "rover.bin"
    rover.write_bytes(data.replace(b"ArduCopter V", b"xArduRover V"))
    with pytest.raises(IdentifyError, match="logs of a copter and a rover: they must be of one vehicle"):
        identify([flown, rover])
    with pytest.raises(IdentifyError, match="mass -1"):
        identify(flown, mass=-1.0)


def test_a_log_of_arducopter_3_is_identified_by_its_older_names(flown, found, tmp_path) -> None:
    """EK2 (NKF1), CURR, and motors' pulses by those of the throttle stick."""
    data = _of_version(flown.read_bytes(), b"3.5").replace(b"AEKF", b"XEKF")
    for name, older in ((b"XKF1", b"NKF1"), (b"XKF4", b"NKF4"), (b"BAT\0Q", b"CURRQ")):
        assert name in data
        data = data.replace(name, older)
    for name, value in ((b"RC3_MIN", 1000.0), (b"RC3_MAX", 2000.0), (b"MOT_PWM_MIN", 0.0), (b"MOT_PWM_MAX", 0.0)):
        data = _with_parameter(data, name, value)
    path = tmp_path / "old.bin"
    path.write_bytes(data)
    old = identify(path)
    for name in ("hover_output", "hover_current", "battery_resistance", "drag_along", "roll_effectiveness"):
        assert old[name].value == found[name].value, name
    assert "old.bin: NKF1 (EK2) stands for XKF1: the vehicle flew by it" in old.logs[0].notes


def test_effectiveness_that_a_log_does_not_tell_goes_with_the_gains(flown, found, tmp_path, monkeypatch) -> None:
    """A vehicle with gains of a third turns three times as sharply by its outputs, whatever carries it in the hover."""
    monkeypatch.setattr("sitl.identify.rates._LEAST_HZ", 60.0)
    shipped = vehicles.load("ardupilot_x")
    own = {parameter.name: parameter.default for parameter in TABLE} | dict(shipped.parameters)
    for share in (1.0, 1.0 / 3.0):
        path = tmp_path / "gains.bin"
        data = flown.read_bytes()
        for axis in (b"RLL", b"PIT", b"YAW"):
            name = b"ATC_RAT_" + axis + b"_P"
            data = _with_parameter(data, name, share * own[name.decode()])
        path.write_bytes(data)
        made = identify(path)
        log = made.logs[0]
        estimates = Copter(made.airframe(), log.parameters, log.conditions).properties()
        known = Copter(shipped, own | {"FRAME_CLASS": 1.0, "FRAME_TYPE": 1.0}, FULL).properties()
        for axis in ("roll", "pitch", "yaw"):
            assert not made[f"{axis}_effectiveness"].is_observed
            name = f"{axis}_effectiveness"
            assert estimates[name] == pytest.approx(known[name] / share, rel=0.01), name
        assert "assumed, by ATC_RAT_RLL_P and _PIT_P" in made.to_toml()
        low, high = made.airframe().intervals["inertia"]
        assert high == pytest.approx([4.0 * x for x in low]), "half to twice of what is assumed"


def test_how_high_a_flight_counts_may_be_said(flown, capsys) -> None:
    with pytest.raises(IdentifyError, match="never in the air, 90 m over the ground for 12 s"):
        identify(flown, above=90.0)
    with pytest.raises(IdentifyError, match=r"height -1\.0 m over the ground is outside 0 \.\. 100"):
        identify(flown, above=-1.0)
    assert cli.main(["identify", str(flown), "--above", "90"]) == 2
    assert "90 m over the ground" in capsys.readouterr().err


def test_a_weight_that_changes_within_a_log_is_said(found) -> None:
    log = found.logs[0]
    rows = np.column_stack([np.full(60, x) for x in (0.4, GRAVITY, 12.0, 10.0, 0.0)])
    assert not hover._weights(rows, log)
    rows[40:, 0] = 0.55
    assert "at another (outputs 0.40 and 0.55): the weight changed; take logs of one weight" in hover._weights(
        rows, log
    )
    rows[:, 0], rows[40:, 2] = 0.4, 12.0 * np.sqrt(0.9)
    assert not hover._weights(rows, log), "a battery that empties"


def test_where_the_current_hardly_changes_the_resistance_is_the_firmwares(found, flown, monkeypatch) -> None:
    monkeypatch.setattr("sitl.identify.board._MOST_RELATIVE", 0.0)
    estimate = identify(flown)["battery_resistance"]
    truth = float(vehicles.load("erle_copter").value("battery_resistance"))
    assert estimate.low < truth < estimate.high and estimate.data == "BAT.Res, the firmware's estimate"
    assert estimate.value == pytest.approx(found["battery_resistance"].value, rel=0.1)


def _of_version(data: bytes, version: bytes) -> bytes:
    """A log of another version of ArduCopter."""
    return re.sub(rb"ArduCopter V\d\.\d", b"ArduCopter V" + version, data)


def _with_parameter(data: bytes, name: bytes, value: float) -> bytes:
    """A log in which a parameter has another value: it stands behind the name of 16 bytes."""
    at = data.index(name.ljust(16, b"\0")) + 16
    return data[:at] + struct.pack("<f", value) + data[at + 4 :]


def test_messages_that_a_log_lacks_are_named(flown, tmp_path) -> None:
    for name, estimates in (
        (b"IMU", ("hover_output", "drag_along")), (b"RCOU", ("hover_output", "balance_right")),
        (b"XKF1", ("hover_output", "wind_speed")), (b"BAT", ("hover_current", "battery_resistance")),
    ):  # fmt: skip
        found = identify(without_messages(flown, tmp_path / "lacks.bin", name))
        for estimate in estimates:
            assert f"the log has no {name.decode()} (LOG_BITMASK" in found[estimate].reason, estimate


def test_the_plan_is_a_mission(tmp_path, capsys) -> None:
    path = tmp_path / "plan.waypoints"
    assert cli.main(["identify", "--plan", str(path), "--home", "47.397,8.545"]) == 0
    mission = files.load(path).mission
    assert len(mission) > 25
    assert cli.main(["identify", "--plan", str(path)]) == 2
    assert "--home None is not LAT,LON" in capsys.readouterr().err


def test_the_airframe_says_how_far_off_its_properties_may_be(found, tmp_path) -> None:
    airframe = found.airframe()
    low, high = airframe.intervals["power_by_thrust"]
    watts = [found["hover_voltage"].value * end for end in (found["hover_current"].low, found["hover_current"].high)]
    weight = airframe.value("mass") * GRAVITY
    assert (low, high) == pytest.approx([watt / weight for watt in watts], rel=1e-9), (
        "it follows from one property alone"
    )
    hover, (slow, fast) = found["hover_output"], airframe.intervals["outflow_speed_max"]
    moved = [found_at(found, "hover_output", end) for end in (hover.high, hover.low)]
    assert slow <= moved[0] < airframe.value("outflow_speed_max") < moved[1] <= fast, "expo adds to it"
    for least, most in zip(*airframe.intervals["inertia"]):
        assert 0.0 < least < most
    found.write(tmp_path / "mine.toml")
    assert vehicles.load(str(tmp_path / "mine.toml")).intervals == airframe.intervals


def found_at(found, name: str, value: float) -> float:
    """Outflow speed of the airframe where a property of the log has another value."""
    estimates = tuple(replace(one, value=value) if one.name == name else one for one in found.estimates)
    return float(replace(found, estimates=estimates).airframe().value("outflow_speed_max"))
