# SPDX-License-Identifier: BSD-3-Clause
"""Which flight of a log is flown again, what was done in it, and a clear word for logs that hold none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sitl.autopilot.copter.firmware import FIRMWARE
from sitl.errors import OptionError
from sitl.logs.tlog import LogError
from sitl.missions.twin import inputs, streams, taken_parameters, twin
from sitl.missions.twin.flight_log import FlightLog, TwinError
from tests.logs.log_files import V32, binary, old_flight, telemetry, without_messages
from tests.missions.twin.conftest import FORMATS, Log, cut


def test_a_flight_is_from_arming_to_disarming_and_begins_where_the_vehicle_stood(written: Log) -> None:
    log = FlightLog(written())
    assert (log.kind, log.version, log.span) == ("copter", (4, 5), (20.0, 30.0, True))
    assert log.home() == pytest.approx((47.3977, 8.5456, 488.0, 90.0))


def test_the_longest_flight_is_taken_or_the_one_that_is_asked_for(written: Log) -> None:
    path = written(("ARM", 15_000_000, 1, 0), ("ARM", 19_000_000, 0, 0))
    assert FlightLog(path).number == 2
    with pytest.raises(TwinError, match=r"flight 1 of 2 .4 s armed. the vehicle never left"):
        FlightLog(path, 1)
    with pytest.raises(OptionError, match=r"flight 3: log .* has flights 1 to 2"):
        FlightLog(path, 3)


def test_a_log_that_arming_opened_begins_armed(written: Log) -> None:
    log = FlightLog(written(("ARM", 30_000_000, 0, 0), armed=False))
    assert log.span.armed == 1.0 and log.span.is_whole


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"without": ("PARM",)}, "has no PARM"),
        ({"armed": False}, "never armed for 3 s"),
        ({"height": 0.5}, "flight 1 of 1 .10 s armed. the vehicle never left the ground"),
        ({"without": ("XKF1",)}, "has none of XKF1"),
        ({"without": ("PARM", "ARM")}, "has no PARM"),
        ({"firmware": "ArduPlane V4.5.7 (abc)"}, "is of a plane"),
        ({"firmware": "ArduSub V4.5.7 (abc)"}, "is of a submarine"),
        ({"more": (("PARM", 1_000_000, b"FRAME_CLASS", 6.0, 0.0),)}, r"is of a helicopter \(FRAME_CLASS 6\)"),
    ],
)
def test_logs_without_a_flight(written: Log, options: dict[str, Any], text: str) -> None:
    with pytest.raises((TwinError, LogError), match=text):
        FlightLog(written(*options.get("more", ()), **{k: v for k, v in options.items() if k != "more"}))


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (bytes(range(256)) * 100, "is no log: it begins with the bytes 00 01"),
        (b"hello there\n", "is no log but a text: it begins with 'hello there'"),
        (b"", "is empty"),
        (telemetry(), "is a .tlog; a twin is made of the on-board log .* which the vehicle keeps on its card"),
        (b"ULog\x01\x12\x35" + bytes(90), r"is a log of PX4 \(.ulg\)"),
        (binary(old_flight(), V32), "has no PARM"),
    ],
)
def test_a_file_of_which_no_twin_is_made(tmp_path: Path, data: bytes, text: str) -> None:
    path = tmp_path / "odd.bin"
    path.write_bytes(data)
    with pytest.raises(TwinError, match=rf"odd.bin' {text}"):
        FlightLog(path)


def test_damaged_real_logs(own_log: Path, tmp_path: Path) -> None:
    with pytest.raises((TwinError, LogError), match=r"does not say what vehicle it is of"):
        FlightLog(cut(own_log, tmp_path / "tiny.bin", 0.003))
    with pytest.raises(TwinError, match=r"has no PARM"):
        FlightLog(without_messages(own_log, tmp_path / "none.bin", b"PARM"))
    log = FlightLog(cut(own_log, tmp_path / "half.bin", 0.6))
    assert not log.span.is_whole and log.columns.truncated


def test_nothing_is_written_of_a_log_that_cannot_be_flown(written: Log, tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    kept.mkdir()
    with pytest.raises(TwinError):
        twin.fly(written(height=0.0), "erle_copter", keep=kept)
    with pytest.raises(OptionError, match=r"frame erle_rover is a rover, log .* is of a copter"):
        twin.fly(written(), "erle_rover", keep=kept)
    assert not list(kept.iterdir())


def test_parameters_that_say_how_it_is_flown_are_taken_over(written: Log) -> None:
    path = written(
        ("PARM", 1_000_000, b"COMPASS_OFS_X", 77.0, 0.0), ("PARM", 1_000_000, b"XYZ_NONE", 3.0, 0.0),
        ("PARM", 1_000_000, b"SIM_ACC1_BIAS_X", 3.0, 0.0), ("PARM", 1_000_000, b"SIM_WIND_SPD", 6.0, 0.0),
        ("PARM", 1_000_000, b"ATC_ANGLE_MAX", 35.0, 30.0), ("PARM", 24_000_000, b"RTL_ALT", 1800.0, 1500.0),
        ("PARM", 25_000_000, b"WPNAV_SPEED", 800.0, 500.0), ("PARM", 1_000_000, b"ATC_RAT_RLL_P", 0.2, 0.135),
    )  # fmt: skip
    found = taken_parameters.taken(FlightLog(path), FIRMWARE.table)
    assert found.values["ATC_RAT_RLL_P"] == pytest.approx(0.2) and found.values["SIM_WIND_SPD"] == 6.0
    assert found.values["ANGLE_MAX"] == 3500.0  # under its name of today
    assert not {"COMPASS_OFS_X", "SIM_ACC1_BIAS_X", "SERVO1_FUNCTION"} & set(found.values)
    assert found.missing == ["XYZ_NONE"] and found.own == 3
    assert found.notes()[0] == "1 parameter of the log not in this autopilot: XYZ_NONE"
    assert [(round(t, 3), value) for t, _, value in found.changes] == [(5.0, pytest.approx(800.0))]


def test_modes_commands_sticks_and_wind(written: Log) -> None:
    command = (1, 1, 255, 190, 0)
    path = written(
        ("MODE", 19_000_000, 4, 4, 2), ("MODE", 25_000_000, 9, 9, 2), ("MODE", 27_000_000, 6, 6, 5),
        ("MAVC", 20_000_000, *command, 400, 1.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0, 1),
        ("MAVC", 21_000_000, *command, 22, 0.0, 0.0, 0.0, 0.0, 0, 0, 8.0, 0, 1),
        ("MAVC", 22_000_000, *command, 115, 90.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 4, 1),
        ("MAVC", 22_000_000, *command, 512, 1.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 0, 1),
        ("XKF2", 20_000_000, 0, 0.0, -4.0), ("XKF2", 30_000_000, 0, 0.0, -4.0),
    )  # fmt: skip
    found = inputs.of(FlightLog(path))
    assert found.modes == [(-1.0, 4, True), (5.0, 9, True), (7.0, 6, False)]
    assert [(m.time, m.name, m.fields["command"], m.fields["z"]) for m in found.messages] == [
        (1.0, "COMMAND_INT", 22, 8.0)
    ]
    assert found.notes == ["left out, for the log's vehicle refused it: command 115"]
    assert found.sticks is not None
    time, pulses = found.sticks
    assert np.interp(0.0, time, pulses[:, 2]) == 1200.0 and pulses.shape[1] == 6
    assert found.wind[3].speed == pytest.approx(4.0) and found.wind[3].direction == pytest.approx(90.0)


def test_set_points_of_guided_keep_their_place_beside_where_it_was_armed(written: Log) -> None:
    path = written(
        ("GUIP", 22_000_000, 2, 500.0, 300.0, 800.0, 0, *[0.0] * 6),
        ("GUIP", 23_000_000, 4, 0.0, 0.0, 0.0, 0, 100.0, -50.0, 20.0, 0.0, 0.0, 0.0),
        ("GUIP", 24_000_000, 2, 500.0, 300.0, 800.0, 1, *[0.0] * 6),
        ("GUIP", 25_000_000, 2, 473978000.0, 85456000.0, 900.0, 0, *[0.0] * 6),
    )  # fmt: skip
    found = inputs.of(FlightLog(path))
    first, second, third = (message.fields for message in found.messages)
    # armed 3 m north, 4 m east, 0.5 m below the origin; 4.5 logs centimetres, up
    assert (first["x"], first["y"], first["z"]) == pytest.approx((2.0, -1.0, -8.5))
    assert (second["vx"], second["vy"], second["vz"]) == pytest.approx((1.0, -0.5, -0.2))
    assert (third["coordinate_frame"], third["alt"]) == (6, 9.0)
    assert "1 set-points of GUIDED over terrain are left out" in found.notes


def test_parameters_of_arducopter_3_are_taken_under_their_names_of_today(written: Log) -> None:
    """The rates that are asked for were not filtered then; pulses of motors are the airframe's."""
    rows = (("MOT_PWM_MIN", 0.0), ("MOT_PWM_MAX", 0.0), ("ATC_RAT_RLL_FILT", 10.0), ("POS_Z_P", 1.5))
    path = written(*(("PARM", 1_000_000, name.encode(), value, value) for name, value in rows))
    values = taken_parameters.taken(FlightLog(path), FIRMWARE.table).values
    assert not {"MOT_PWM_MIN", "MOT_PWM_MAX"} & set(values)
    assert (values["ATC_RAT_RLL_FLTD"], values["ATC_RAT_RLL_FLTT"], values["PSC_POSZ_P"]) == (10.0, 0.0, 1.5)


def test_no_acceleration_is_asked_for_where_the_stick_is_the_throttle(written: Log, monkeypatch) -> None:
    """ArduCopter logs what it asked for last, in STABILIZE, too."""
    monkeypatch.setitem(FORMATS, "RATE", ("Qff", "TimeUS,A,ADes"))
    rows = [("RATE", 20_500_000 + 500_000 * k, 1.0 * k, 100.0 * k) for k in range(18)]
    log = FlightLog(written(*rows, ("MODE", 24_900_000, 2, 2, 1)))
    asked, flown = (
        next(one for one in streams.COPTER if one.name == name).of(log)
        for name in ("asked_acceleration", "acceleration")
    )
    assert asked is not None and flown is not None
    assert len(flown.time) == 18 and asked.time.tolist() == pytest.approx([5.0 + 0.5 * k for k in range(9)])
    assert asked.values[0, 0] == pytest.approx(9.0)
