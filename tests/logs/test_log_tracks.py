# SPDX-License-Identifier: BSD-3-Clause
"""Logs of many versions give their flight, or say why not; small files take little memory, whatever they say."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from sitl.logs import track_bin, track_tlog
from sitl.logs.dataflash.columns import Columns
from sitl.logs.tlog import LogError, read_steady, read_tlog
from sitl.logs.track_columns import LONGEST_S, TrackError
from tests.logs.log_files import V32, V36, Message, binary, flight, old_flight, telemetry, text, written


def without(formats: dict[str, tuple[str, str]], *names: str) -> dict[str, tuple[str, str]]:
    return {name: found for name, found in formats.items() if name not in names}


def only(messages: list[Message], formats: dict[str, tuple[str, str]]) -> list[Message]:
    return [message for message in messages if message[0] in formats]


@pytest.mark.parametrize("form", [binary, text])
def test_a_log_without_energy_is_read_with_the_energy_of_voltage_and_current(tmp_path: Path, form: object) -> None:
    track = track_bin.read(written(tmp_path / "x.bin", form(flight(), V36)))  # type: ignore[operator]
    assert (track.kind, len(track), track.modes, track.armed) == ("copter", 50, [(1.0, "GUIDED")], [(1.0, True)])
    assert track["north"][-1] == pytest.approx(9.8, abs=0.02)
    assert track["vn"] == pytest.approx(np.full(50, 2.0))
    assert np.degrees(track["yaw"]) == pytest.approx(np.full(50, 90.0))
    assert np.degrees(track["roll"][3]) == pytest.approx(1.0)
    assert track["energy"][-1] == pytest.approx(60.0 * 4.9 / 3600.0)
    assert track.notes == ["energy is summed up from voltage and current: it has no EnrgTot"]


@pytest.mark.parametrize("form", [binary, text])
def test_arducopter_3_2_has_milliseconds_hundredths_and_no_pos(tmp_path: Path, form: object) -> None:
    track = track_bin.read(written(tmp_path / "x.log", form(old_flight(), V32)))  # type: ignore[operator]
    assert (track.kind, len(track), track.modes) == ("copter", 50, [(1.0, "LOITER")])
    assert track.t[0] == pytest.approx(1.0)
    assert track["north"][-1] == pytest.approx(9.8, abs=0.02)
    assert track["vn"][5:-5] == pytest.approx(np.full(40, 2.0), abs=0.1)
    assert track["energy"][-1] == pytest.approx(60.0 * 4.9 / 3600.0)
    assert track.notes[0] == "positions are those of AHR2: it has no POS"
    assert "it has no velocities: they are taken from its positions" in track.notes


def test_what_is_missing_is_said(tmp_path: Path) -> None:
    few = without(V36, "ATT", "BAT", "NKF1", "EV", "MODE")
    track = track_bin.read(written(tmp_path / "x.bin", binary(only(flight(), few), few)))
    assert track.notes == [
        "it has no MODE",
        "it tells of no arming (ARM, EV)",
        "it has no velocities: they are taken from its positions",
        "it has no attitude",
        "it has no energy of the battery",
    ]
    none = without(V36, "POS")
    with pytest.raises(TrackError, match="no two positions in POS, AHR2 or GPS"):
        track_bin.read(written(tmp_path / "y.bin", binary(only(flight(), none), none)))


@pytest.mark.parametrize(
    ("version", "what"),
    [
        ("ArduPlane V4.5.0 (fa0f089f)", "a plane"),
        ("ArduSub V4.1.0", "a submarine"),
        ("AntennaTracker V4.2.0", "an antenna tracker"),
        ("Blimp V4.3.0", "a blimp"),
    ],
)
def test_a_log_of_another_vehicle_says_of_which(tmp_path: Path, version: str, what: str) -> None:
    with pytest.raises(LogError, match=rf"x\.bin' is of {what} \({version.split()[0]}"):
        track_bin.read(written(tmp_path / "x.bin", binary(flight(version), V36)))


@pytest.mark.parametrize(
    ("version", "kind"),
    [
        ("APM:Copter V3.3", "copter"),
        ("APMrover2 V3.1.2", "rover"),
        ("ArduRover V4.6.0", "rover"),
        ("TradHeli V3.1", "copter"),
    ],
)
def test_firmwares_by_all_their_names(tmp_path: Path, version: str, kind: str) -> None:
    assert track_bin.read(written(tmp_path / "x.bin", binary(flight(version), V36))).kind == kind


def test_a_log_that_names_no_firmware_is_known_by_its_parameters(tmp_path: Path) -> None:
    formats = V36 | {"PARM": ("QNf", "TimeUS,Name,Value")}
    messages = only(flight(), without(V36, "MSG"))
    with pytest.raises(LogError, match="does not say what vehicle it is of"):
        track_bin.read(written(tmp_path / "x.bin", binary(messages, formats)))
    for name, kind in ((b"RTL_ALT", "copter"), (b"CRUISE_SPEED", "rover")):
        path = written(tmp_path / "x.bin", binary([("PARM", 1_000_000, name, 1.0), *messages], formats))
        assert track_bin.read(path).kind == kind
    with pytest.raises(LogError, match="of a plane"):
        track_bin.read(
            written(tmp_path / "x.bin", binary([("PARM", 1_000_000, b"TECS_CLMB_MAX", 1.0), *messages], formats))
        )


def test_the_filter_that_is_flown_by_gives_velocities(tmp_path: Path) -> None:
    formats = V36 | {"XKF1": ("QBfff", "TimeUS,C,VN,VE,VD"), "XKF4": ("QBB", "TimeUS,C,PI")}
    messages = [("XKF4", 1_000_000, 0, 1), *flight()]
    messages += [("XKF1", 1_000_000 + 100_000 * k, core, 5.0 + core, 0.0, 0.0) for k in range(50) for core in (0, 1)]
    messages.sort(key=lambda m: m[1])
    assert track_bin.read(written(tmp_path / "x.bin", binary(messages, formats)))["vn"][9] == pytest.approx(2.0)
    flown = [(*m[:-1], 3) if m[0] == "ATT" else m for m in messages]  # AEKF
    assert track_bin.read(written(tmp_path / "x.bin", binary(flown, formats)))["vn"][9] == pytest.approx(6.0)


def test_a_damaged_piece_is_passed_over(tmp_path: Path) -> None:
    data = binary(flight(), V36)
    middle = len(data) * 2 // 3
    path = written(
        tmp_path / "x.bin", data[:middle] + b"\xa3\x95\x07 no message " + data[middle + 40 :] + b"\xa3\x95\x03cut"
    )
    track = track_bin.read(path)
    assert len(track) == 50
    assert any(note.endswith("bytes of it are no messages, and left out") for note in track.notes)


def test_a_message_whose_time_cannot_be_is_left_out(tmp_path: Path) -> None:
    messages = flight()
    far = ("POS", 1 << 60, *messages[3][2:])
    track = track_bin.read(written(tmp_path / "x.bin", binary([*messages[:90], far, *messages[90:], far], V36)))
    assert len(track) == 50
    assert "2 messages of it have times that cannot be, and are left out" in track.notes


def test_a_log_that_goes_on_far_ahead_is_refused_and_not_filled_up(tmp_path: Path) -> None:
    messages = flight()
    far = [(name, t + int(1.1e6 * LONGEST_S), *rest) for name, t, *rest in messages]
    with pytest.raises(TrackError, match=r"from 1\.0 s to 190085\.9 s: at most 48 hours"):
        track_bin.read(written(tmp_path / "x.bin", binary([*messages, *far], V36)))


def test_a_format_of_no_length_ends(tmp_path: Path) -> None:
    """A reader that goes on by what FMT says would stay where it is."""
    data = bytearray(binary(flight(), V36))
    data[89 + 4] = 0  # Length of the first format
    log = Columns(written(tmp_path / "x.bin", bytes(data)))
    assert "MSG" not in log and log.skipped > 0


def test_a_telemetry_log_with_one_time_far_ahead_is_refused(tmp_path: Path) -> None:
    times = [*range(1000, 6000, 100), 4_294_000_000]
    with pytest.raises(TrackError, match=r"from 1\.0 s to 4294000\.0 s: at most 48 hours"):
        track_tlog.read(written(tmp_path / "x.tlog", telemetry(boot_ms=times)))


def test_a_telemetry_log_whose_computer_set_its_clock_leaves_the_jump_out(tmp_path: Path) -> None:
    first, second = telemetry(), telemetry(boot_ms=range(6000, 9000, 100), epoch_us=1_700_000_000_000_000 + (1 << 50))
    path = written(tmp_path / "x.tlog", first + second)
    assert [*read_steady(path)][-1][:2] == (1, 4_900_000 + 2_900_000)
    assert len(track_tlog.read(path)) == 80


def test_a_telemetry_log_goes_on_behind_what_is_no_frame(tmp_path: Path) -> None:
    data = telemetry()
    path = written(tmp_path / "x.tlog", data[:400] + b"no frame at all" + data[400:])
    assert len(list(read_tlog(path))) >= 49
    assert len(track_tlog.read(path)) >= 49


def test_a_telemetry_log_of_a_plane_says_so(tmp_path: Path) -> None:
    path = written(tmp_path / "x.tlog", telemetry(mav_type=1))
    with pytest.raises(TrackError, match=r"no copter and no rover: system 1 is of MAV_TYPE 1 \(FIXED_WING\)"):
        track_tlog.read(path)
