# SPDX-License-Identifier: BSD-3-Clause
"""What telemetry tells of a copter, what it does not, and telemetry of no use."""

from __future__ import annotations

import pytest

from sitl import cli, vehicles
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.identify import IdentifyError, identify
from sitl.identify.expected import Copter
from sitl.logs.tlog import LogError, read_tlog


@pytest.fixture(scope="session")
def telemetry(flown):
    return flown.with_suffix(".tlog")


@pytest.fixture(scope="session")
def told(telemetry):
    return identify(telemetry)


def written(path, frames):
    path.write_bytes(b"".join(time_us.to_bytes(8, "big") + frame for time_us, frame in frames))
    return path


def without(path, to, *names):
    """A .tlog without messages of these names."""
    numbers = {message(name).id for name in names}
    return written(to, ((t, f) for t, f in read_tlog(path) if int.from_bytes(f[7:10], "little") not in numbers))


def thinned(path, to, name, each):
    """A .tlog with one of so many messages of a name."""
    number, count, kept = message(name).id, 0, []
    for t, frame in read_tlog(path):
        if int.from_bytes(frame[7:10], "little") == number:
            count += 1
            if count % each:
                continue
        kept.append((t, frame))
    return written(to, kept)


def test_estimates_that_telemetry_tells_hold_the_truth_as_the_vehicles_own_log_does(told, flown) -> None:
    own, airframe = identify(flown), vehicles.load("erle_copter")
    known = Copter(airframe, own.logs[0].parameters, own.logs[0].conditions).properties()
    for name in ("hover_output", "drag_mcoef"):
        assert told[name].low < known[name] < told[name].high, f"{told[name]}, truth {known[name]}"
    assert told["battery_resistance"].low < airframe.value("battery_resistance") < told["battery_resistance"].high
    assert told["hover_output"].value == pytest.approx(own["hover_output"].value, rel=0.01)
    assert told["hover_current"].value == pytest.approx(own["hover_current"].value, rel=0.02)
    assert told["gyro_bias"].value == pytest.approx(own["gyro_bias"].value, abs=1e-3)
    assert told.logs[0].seconds == pytest.approx(own.logs[0].seconds, abs=5.0)
    assert told["hover_output"].data.endswith("s of hover: SERVO_OUTPUT_RAW, RAW_IMU, LOCAL_POSITION_NED")


def test_every_other_estimate_says_why_telemetry_does_not_tell_it(told) -> None:
    assert all(estimate.is_observed or estimate.reason for estimate in told.estimates)
    assert "no output of the rate controllers (RATE), and attitudes are needed at 20 Hz: ATTITUDE at 4 Hz" in (
        told["roll_effectiveness"].reason
    )
    assert "behind which filter" in told["gyro_noise_density"].reason
    assert "vertical velocity" in told["gps_velocity_noise_vertical"].reason


def test_an_airframe_comes_of_telemetry_and_how_to_get_a_bin_is_said(telemetry, tmp_path, capsys) -> None:
    out = tmp_path / "mine.toml"
    assert cli.main(["identify", str(telemetry), "--mass", "2.0", "--out", str(out)]) == 0
    assert "note: A .bin tells more: " in capsys.readouterr().out
    assert vehicles.load(str(out)).value("mass") == 2.0


def test_messages_that_come_too_seldom_are_named(telemetry, tmp_path) -> None:
    found = identify(thinned(telemetry, tmp_path / "seldom.tlog", "SERVO_OUTPUT_RAW", 4))
    assert found["hover_output"].reason == "SERVO_OUTPUT_RAW at 1 Hz; 2 Hz are needed"
    assert found["drag_mcoef"].is_observed
    found = identify(without(telemetry, tmp_path / "none.tlog", "VIBRATION", "BATTERY_STATUS"))
    assert found["vibration"].reason == "no VIBRATION; 1 Hz are needed"
    assert "no BATTERY_STATUS" in found["hover_current"].reason and found["hover_output"].is_observed


def test_telemetry_of_no_use_is_named(telemetry, flown, tmp_path) -> None:
    with pytest.raises(IdentifyError, match=r"has no parameters \(PARAM_VALUE, or @PARAM/param.pck by FTP\)"):
        identify(without(telemetry, tmp_path / "bare.tlog", "PARAM_VALUE"))
    with pytest.raises(IdentifyError, match="two forms"):
        identify([telemetry, flown])
    for kind, autopilot, says in ((1, 3, "FIXED_WING with autopilot ARDUPILOTMEGA"), (2, 12, "with autopilot PX4")):
        beat = message("HEARTBEAT").payload(type=kind, autopilot=autopilot, base_mode=129, mavlink_version=3)
        frames = [(10**15 + 10**6 * k, encode_v2(message("HEARTBEAT"), beat, k, 1, 1)) for k in range(5)]
        with pytest.raises(LogError, match=f"is of no copter or rover of ArduPilot: system 1 is a .*{says}"):
            identify(written(tmp_path / "other.tlog", frames))
    cut = tmp_path / "cut.tlog"
    cut.write_bytes(telemetry.read_bytes()[:-5])
    assert identify(cut)["hover_output"].is_observed


def test_a_frame_with_a_wrong_checksum_is_left_out(telemetry, tmp_path) -> None:
    frames = list(read_tlog(telemetry))
    number = message("ATTITUDE").id
    at = next(k for k, (_, f) in enumerate(frames) if int.from_bytes(f[7:10], "little") == number and k > 5000)
    time_us, frame = frames[at]
    frames[at] = (time_us, frame[:20] + bytes([frame[20] ^ 0x55]) + frame[21:])
    log = identify(written(tmp_path / "bad.tlog", frames)).logs[0]
    assert log.notes[0] == "bad.tlog: 1 frames with a wrong checksum are left out"
    assert not any("checksum" in note for note in identify(telemetry).logs[0].notes)
    assert len(log.columns["ATT"]) == len(identify(telemetry).logs[0].columns["ATT"]) - 1
