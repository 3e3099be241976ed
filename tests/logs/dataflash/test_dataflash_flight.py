# SPDX-License-Identifier: BSD-3-Clause
"""Logs of a flight and of a drive, as pymavlink reads them: they open, and tell what happened."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.logs.dataflash.conftest import Run, read_log

COMMON = {
    "FMT", "FMTU", "UNIT", "MULT", "PARM", "VER", "MSG", "MODE", "ARM", "EV", "ORGN", "ATT", "IMU", "BARO", "MAG",
    "GPS", "GPA", "BAT", "VIBE", "RCIN", "RCOU", "POS", "PSCN", "PSCE", "SIM",
}  # fmt: skip
OWN = {"copter": {"RATE", "CTUN", "PSCD", "MOTB", "PIDR"}, "rover": {"THR", "STER", "NTUN", "PIDS", "PIDA"}}


@pytest.fixture(scope="module")
def log(driven: Run) -> dict[str, list[Any]]:
    return read_log(driven.path)


def times(messages: list[Any]) -> np.ndarray[Any, Any]:
    return np.array([m.TimeUS for m in messages])


def test_it_holds_what_ardupilot_logs(driven: Run, log: dict[str, list[Any]]) -> None:
    assert log.keys() >= COMMON | OWN[driven.kind]


def test_time_never_goes_back_and_describes_first(log: dict[str, list[Any]]) -> None:
    kinds = [m.get_type() for m in log["*"]]
    assert kinds[: kinds.count("FMT")] == ["FMT"] * kinds.count("FMT")
    stamps = times([m for m in log["*"] if hasattr(m, "TimeUS")])
    assert (np.diff(stamps) >= 0).all()


def test_rates_are_as_declared(log: dict[str, list[Any]]) -> None:
    assert np.unique(np.diff(times(log["IMU"]))).tolist() == [40_000]
    assert np.unique(np.diff(times(log["BAT"]))).tolist() == [100_000]
    assert np.unique(np.diff(times(log["GPS"]))).tolist() == [200_000]


def test_all_parameters_are_in_it(driven: Run, log: dict[str, list[Any]]) -> None:
    listed = driven.simulation.parameters.listed()
    values = {m.Name: (m.Value, m.Default) for m in log["PARM"]}
    assert values.keys() == {p.name for p in listed}
    assert values["LOG_BACKEND_TYPE"] == (1.0, 1.0)


def test_readers_know_the_vehicle_its_modes_and_its_clock(driven: Run) -> None:
    from pymavlink import mavutil

    log = mavutil.mavlink_connection(str(driven.path))
    while log.recv_match() is not None:
        pass
    assert log.mav_type == {"copter": 2, "rover": 10}[driven.kind]
    assert log.flightmode == "GUIDED"
    boot = driven.simulation.bridge.epoch_us * 1e-6
    assert log.messages["BAT"]._timestamp == pytest.approx(boot + log.messages["BAT"].TimeUS * 1e-6, abs=0.002)
    log.close()


def test_arming_is_told(log: dict[str, list[Any]]) -> None:
    assert [m.ArmState for m in log["ARM"]] == [1]
    assert 10 in [m.Id for m in log["EV"]]
    assert any("rmed" in m.Message or "Arming" in m.Message for m in log["MSG"])


def test_commands_of_clients_are_told_with_their_results(driven: Run, log: dict[str, list[Any]]) -> None:
    """Also the one that the log begins with."""
    commands = [(m.Cmd, m.Res, m.WL, m.TS, m.SS) for m in log["MAVC"]]
    sent = [176, 400, 22] if driven.kind == "copter" else [176, 400]
    assert commands == [(number, 0, 1, 1, driven.client.system) for number in sent]


def test_it_tells_where_the_vehicle_went(driven: Run, log: dict[str, list[Any]]) -> None:
    """Estimate, truth and GPS agree; the vehicle is 5 m north at the end."""
    assert pytest.approx(5.0, abs=0.6) == log["SIM2"][-1].PN
    end, truth, fix = log["POS"][-1], log["SIM"][-1], log["GPS"][-1]
    assert pytest.approx(5.0, abs=0.6) == log["PSCN"][-1].PN
    metres = 1.0 / 8.983e-6
    assert (end.Lat - truth.Lat) * metres == pytest.approx(0.0, abs=0.1)
    assert (end.Lat - fix.Lat) * metres == pytest.approx(0.0, abs=3.0)
    assert (end.Lat - log["POS"][0].Lat) * metres == pytest.approx(log["PSCN"][-1].PN, abs=0.2)
    height = 5.0 if driven.kind == "copter" else 0.0
    assert end.RelHomeAlt == pytest.approx(height, abs=0.5)
    assert end.Alt == pytest.approx(truth.Alt, abs=0.1)


def test_the_log_has_the_records_own_numbers(driven: Run, log: dict[str, list[Any]]) -> None:
    """The last row against the record, which has not moved since: the run ends on a sample."""
    v = driven.simulation.v
    assert log["BAT"][-1].TimeUS == v.time_us
    assert log["BAT"][-1].Volt == pytest.approx(v.autopilot.battery.voltage, abs=1e-4)
    assert log["ATT"][-1].Roll == pytest.approx(np.degrees(v.autopilot.estimate.euler[0]), abs=1e-3)
    assert log["ATT"][-1].Yaw == pytest.approx(np.degrees(v.autopilot.estimate.euler[2]) % 360.0, abs=1e-3)
    ring = v.autopilot.inertial
    last = (int(ring.count) - 1) % len(ring.time_us)
    assert log["IMU"][-1].TimeUS == ring.time_us[last]
    assert log["IMU"][-1].AccZ == pytest.approx(ring.acc[last, 2], abs=1e-5)
    assert ring.acc[last, 2] == pytest.approx(float(v.sensors.acc[2]), abs=0.5)
    assert [getattr(log["RCOU"][-1], f"C{k}") for k in range(1, 5)] == v.actuators.pwm[:4].tolist()
    assert log["MAG"][-1].MagX == pytest.approx(1000.0 * float(v.sensors.mag[0]), abs=0.6)


def test_vibration_is_that_of_the_accelerometer(driven: Run, log: dict[str, list[Any]]) -> None:
    shakes, last = driven.simulation.v.autopilot.vibration, log["VIBE"][-1]
    assert (last.VibeX, last.VibeZ) == pytest.approx((shakes.squares.x**0.5, shakes.squares.z**0.5), rel=1e-5)
    assert 0.001 < last.VibeX < 5.0 and last.Clip == shakes.clips == 0


def test_mavlogdump_reads_it(driven: Run) -> None:
    from pymavlink import mavutil

    tool = Path(sys.executable).with_name("mavlogdump.py")
    if not tool.exists():
        pytest.skip(f"{mavutil.__name__} came without its tools")
    command = [sys.executable, str(tool), "--types", "ATT,MODE", str(driven.path)]
    out = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout
    assert out.count(" ATT {") > 50 and "MODE {" in out


def test_the_same_run_gives_the_same_bytes(driven: Run, tmp_path: Path) -> None:
    again = Run(tmp_path, driven.kind)
    again.drive()
    again.simulation.close()
    assert again.path.read_bytes() == driven.path.read_bytes()


def test_logging_changes_nothing(tmp_path: Path) -> None:
    """The vehicle's record and every byte that a client gets are the same without the logger."""
    runs = Run(tmp_path / "with"), Run(tmp_path / "without")
    runs[1].simulation.logger = None
    runs[1].simulation.bridge.listeners.clear()
    received = []
    for run in runs:
        run.client.set_interval("ATTITUDE", 33)
        run.drive()
        received.append(run.client.link.receive())
        run.simulation.close()
    assert received[0] == received[1] and len(received[0]) > 10_000
    assert runs[0].simulation.fleet.tobytes() == runs[1].simulation.fleet.tobytes()
    assert runs[0].path.exists() and not runs[1].path.exists()


def test_what_comes_right_after_arming_is_in_it(tmp_path: Path) -> None:
    run = Run(tmp_path)
    while not run.simulation.v.autopilot.arming.prearm_ok:
        run.simulation.advance(1.0)
    run.client.command(176, 1, 4)
    run.client.command(400, 1)
    run.simulation.advance(0.01)
    run.client.command(22, 0, 0, 0, 0, 0, 0, 5)
    run.simulation.advance(5.0)
    run.simulation.close()
    log = read_log(run.path)
    assert [m.Id for m in log["EV"]] == [10, 15, 28]  # armed, auto armed, not landed
    assert log["IMU"][0].TimeUS - log["ARM"][0].TimeUS < 50_000


def test_a_rovers_ntun_tells_of_the_present_goal(tmp_path: Path) -> None:
    run = Run(tmp_path, "rover")
    run.drive()  # 5 m north
    north = run.simulation.time_us
    run.client.send(
        "SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1, coordinate_frame=1, type_mask=0x9E7,
        vx=0.5, yaw=1.0,
    )  # fmt: skip
    run.simulation.advance(2.0)
    turned = run.simulation.time_us
    run.client.command(176, 1, 0)  # MANUAL
    run.simulation.advance(2.0)
    run.simulation.close()
    rows = read_log(run.path)["NTUN"]
    to_goal = [m for m in rows if turned > m.TimeUS and m.WpDist > 0.5 and m.TimeUS < north]
    assert to_goal and all(m.WpDist <= 5.5 for m in to_goal)
    assert all(min(m.DesYaw, 360.0 - m.DesYaw) < 15.0 and abs(m.XTrack) < 1.0 for m in to_goal)
    last = [m for m in rows if m.TimeUS > north + 500_000]
    assert last and all(m.WpDist == 0.0 and m.DesYaw == pytest.approx(np.degrees(1.0), abs=0.1) for m in last)
    assert rows[-1].TimeUS <= turned + 100_000


def test_a_log_of_a_run_that_is_killed_misses_less_than_two_minutes(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(150.0)
    stamps = times(read_log(run.path)["BAT"])  # it is not closed
    assert stamps[-1] > 40_000_000
    run.simulation.close()


def test_a_landing_target_is_logged(tmp_path: Path) -> None:
    beacon = {"SIM_PLD_ENABLE": 1, "SIM_PLD_LAT": -35.363262, "SIM_PLD_LON": 149.165237, "SIM_PLD_OPTIONS": 1}
    run = Run(tmp_path, "copter", PLND_ENABLED=1, PLND_TYPE=4, **beacon)
    run.drive()
    target = run.simulation.v.autopilot.landing_target
    away, place = tuple(target.away), tuple(target.measured_pos)
    run.simulation.close()
    rows = read_log(run.path)["PL"]
    assert (rows[0].Heal, rows[0].TAcq, rows[0].mZ) == (0, 0, 0.0)
    last = rows[-1]
    assert (last.Heal, last.TAcq, last.Est, last.EKFOutl) == (1, 1, 1, 0)
    assert (last.pX, last.pY) == pytest.approx(away, abs=0.02)
    assert (last.mX, last.mY, last.mZ) == pytest.approx(place, abs=0.02)
    assert np.unique(np.diff(times(rows))).tolist() == [100_000]
    assert last.TimeUS - 1000 * last.LastMeasMS <= 20_000
