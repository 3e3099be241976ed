# SPDX-License-Identifier: BSD-3-Clause
"""What is logged and when: formats that readers can take, LOG_ parameters, reboots, changed missions."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from pymavlink import DFReader

from sitl.autopilot.estimation.estimator_events import EKF_STOPPED_GPS
from sitl.autopilot.events import emit
from sitl.autopilot.terrain.ground import TERRAIN_LEFT
from sitl.core.mavlink import MavCmd
from sitl.logs.dataflash import formats
from sitl.logs.dataflash.common import EVENT_MESSAGES
from sitl.logs.dataflash.encoder import EVERY_BIT, LogEncoder
from sitl.logs.dataflash.formats import Field, Message
from sitl.logs.kind import logs_of
from sitl.logs.tlog import LogError
from sitl.run import runner
from sitl.simulation import Simulation
from tests.logs.dataflash.conftest import Run, read_log


def test_nothing_is_logged_before_arming(tmp_path: Path) -> None:
    run = Run(tmp_path)
    run.simulation.advance(3.0)
    run.simulation.close()
    assert not run.path.exists()


def test_log_disarmed_logs_from_boot_on(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(3.0)
    run.simulation.close()
    log = read_log(run.path)
    assert log["BAT"][0].TimeUS <= 200_000
    assert "ArduPilot Ready" in [m.Message for m in log["MSG"]]


def test_log_disarmed_that_is_set_later_logs_from_there_on(tmp_path: Path) -> None:
    run = Run(tmp_path, "rover")
    run.simulation.advance(3.0)
    run.set("LOG_DISARMED", 1.0)
    run.simulation.advance(2.0)
    run.simulation.close()
    stamps = [m.TimeUS for found in read_log(run.path).values() for m in found if hasattr(m, "TimeUS")]
    assert min(stamps) >= 3_000_000 and max(stamps) > 4_900_000


def test_log_disarmed_3_keeps_flights_alone(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=3.0)
    run.simulation.advance(1.0)
    assert run.path.exists()
    run.simulation.close()
    assert not run.path.exists()


def test_backend_0_logs_nothing(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_BACKEND_TYPE=0.0, LOG_DISARMED=1.0)
    run.simulation.advance(1.0)
    run.simulation.close()
    assert not run.path.exists()


def test_logging_pauses_after_disarming_and_goes_on_in_the_same_file(tmp_path: Path) -> None:
    run = Run(tmp_path, "rover")
    run.arm()
    run.client.command(400, 0)
    run.simulation.advance(30.0)
    run.arm()
    run.simulation.advance(2.0)
    run.simulation.close()
    log = read_log(run.path)
    stamps = [m.TimeUS * 1e-6 for m in log["BAT"]]
    gaps = [b - a for a, b in pairwise(stamps)]
    assert 14.0 < max(gaps) < 17.0
    assert [m.ArmState for m in log["ARM"]] == [1, 0, 1]
    assert list(tmp_path.iterdir()) == [run.path]


@pytest.mark.parametrize("disarmed", [0.0, 1.0])
@pytest.mark.parametrize("pause", [1.0, 30.0])
def test_a_disarming_can_end_the_log(tmp_path: Path, pause: float, disarmed: float) -> None:
    run = Run(tmp_path, "rover", LOG_FILE_DSRMROT=1.0, LOG_DISARMED=disarmed)
    for _ in range(2):
        run.arm()
        run.client.command(400, 0)
        run.simulation.advance(pause)
    run.simulation.close()
    logs = [read_log(path) for path in sorted(tmp_path.iterdir(), key=lambda path: len(path.name))]
    assert [[m.ArmState for m in log["ARM"]] for log in logs] == [[1, 0], [1, 0]]
    assert all(len(log["PARM"]) > 1000 for log in logs)


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_a_refused_arming_is_logged_for_15_s_with_its_reason(tmp_path: Path, kind: str) -> None:
    run = Run(tmp_path, kind)
    run.simulation.advance(1.0)
    run.client.command(400, 1)
    run.simulation.advance(30.0)
    run.simulation.close()
    log = read_log(run.path)
    assert any(m.Message.startswith("Arm: ") for m in log["MSG"])
    assert len(log["PARM"]) > 1000 and not log["ARM"]
    stamps = [m.TimeUS * 1e-6 for m in log["BAT"]]
    assert stamps[0] == pytest.approx(1.0, abs=0.11) and stamps[-1] == pytest.approx(16.0, abs=0.11)


def test_a_flight_after_a_refused_arming_is_in_the_same_log(tmp_path: Path) -> None:
    run = Run(tmp_path, "rover")
    run.client.command(400, 1)
    run.simulation.advance(20.0)
    run.arm()
    run.simulation.close()
    log = read_log(run.path)
    assert [m.ArmState for m in log["ARM"]] == [1]
    gaps = [b.TimeUS - a.TimeUS for a, b in pairwise(log["BAT"])]
    assert max(gaps) > 4e6
    assert list(tmp_path.iterdir()) == [run.path]


def test_parameters_that_change_while_it_logs_are_logged_again_without_a_default(tmp_path: Path) -> None:
    run = Run(tmp_path)
    run.drive()
    run.set("LAND_SPEED", 70.0)
    run.client.command(400, 0, 21196)
    run.simulation.advance(1.0)
    run.simulation.close()
    rows: dict[str, list[tuple[float, bool]]] = {}
    for m in read_log(run.path)["PARM"]:
        rows.setdefault(m.Name, []).append((m.Value, math.isnan(m.Default)))
    again = {name: found for name, found in rows.items() if len(found) > 1}
    assert set(again) == {"LAND_SPEED", "MOT_THST_HOVER"}
    assert again["LAND_SPEED"][1] == (70.0, True)
    (before, told), (after, left_out) = again["MOT_THST_HOVER"]
    assert (told, left_out) == (False, True) and after != before


def test_a_hover_throttle_that_is_not_saved_is_logged_once(tmp_path: Path) -> None:
    run = Run(tmp_path, MOT_HOVER_LEARN=0.0)
    run.arm()
    run.client.command(400, 0, 21196)
    run.simulation.advance(1.0)
    run.simulation.close()
    assert [m.Name for m in read_log(run.path)["PARM"]].count("MOT_THST_HOVER") == 1


def test_a_long_text_is_logged_in_pieces(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(0.1)
    run.logger.said(6, "x" * 70)
    run.logger.said(6, "y")
    run.simulation.close()
    *_, first, second, other = read_log(run.path)["MSG"]
    assert [(m.Seq, m.Message) for m in (first, second, other)] == [(0, "x" * 64), (1, "x" * 6), (0, "y")]
    assert first.ID == second.ID == other.ID - 1


def test_bitmask_chooses_at_any_time(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=1.0, LOG_BITMASK=1 << 9)
    run.simulation.advance(1.0)
    run.set("LOG_BITMASK", 1)
    run.simulation.advance(1.0)
    run.simulation.close()
    log = read_log(run.path)
    assert 9 <= len(log["BAT"]) <= 12 and "IMU" not in log
    assert len(log["ATT"]) == 55  # 1.1 s at 50 Hz
    assert log["BAT"][-1].TimeUS < log["ATT"][1].TimeUS
    assert [(m.Name, m.Value) for m in log["PARM"]][-1] == ("LOG_BITMASK", 1.0)


def test_a_reboot_begins_another_log(tmp_path: Path) -> None:
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(2.0)
    run.client.command(246, 1)
    run.simulation.advance(2.0)
    run.simulation.close()
    first, second = read_log(run.path), read_log(tmp_path / "run.2.bin")
    assert first["BAT"][-1].TimeUS > 1_000_000
    assert second["BAT"][0].TimeUS < 300_000
    assert "Barometer 1 calibration complete" in [m.Message for m in second["MSG"]]


def test_missions_and_their_items_are_told(tmp_path: Path) -> None:
    from sitl.autopilot.mission.item import MissionItem
    from sitl.autopilot.mission.mission import Mission

    run = Run(tmp_path)
    home = MissionItem(16, 0)
    items = (home, MissionItem(MavCmd.NAV_TAKEOFF, 3, z=3.0), MissionItem(MavCmd.NAV_LAND, 3))
    run.simulation.sequencer.set_mission(run.simulation.v, Mission(items))
    run.arm()
    run.client.command(300)  # MISSION_START
    run.simulation.advance(8.0)
    run.simulation.close()
    log = read_log(run.path)
    assert [(m.CTot, m.CNum, m.CId) for m in log["CMD"]] == [(3, 0, 16), (3, 1, 22), (3, 2, 21)]
    assert [(m.CNum, m.CId) for m in log["MISE"]][:1] == [(1, 22)]
    assert "AUTO" in [m.Mode for m in log["MODE"]] or 3 in [m.ModeNum for m in log["MODE"]]


def test_a_log_of_before_is_not_written_over(tmp_path: Path) -> None:
    (tmp_path / "run.bin").write_bytes(b"mine")
    run = Run(tmp_path, LOG_DISARMED=1.0)
    run.simulation.advance(0.5)
    run.simulation.close()
    assert run.path.read_bytes() == b"mine"
    assert read_log(tmp_path / "run.2.bin")["FMT"]


def test_a_folder_that_cannot_be_written_to_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    run = Run(tmp_path / "file", LOG_DISARMED=1.0)
    with pytest.raises(LogError, match=r"run\.bin"):
        run.simulation.advance(0.5)
    run.simulation.advance(0.5)  # said once; the run can go on


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_every_message_fits_what_fmt_can_say(kind: str) -> None:
    messages = (*EVENT_MESSAGES, *logs_of(kind).messages(EVERY_BIT, 0, True))
    for m in messages:
        formats.check(m)
    kinds = {(m.name, m.format, m.labels, m.units, m.multipliers) for m in messages}
    assert len({m.name for m in messages}) == len(kinds), "of one name there is one format"
    assert len(set(formats.number_all(messages).values())) == len(kinds)


@pytest.mark.parametrize(
    "message",
    [
        Message("TOOLONG").of(),
        Message("MANY").of(*(Field(f"F{k}", "B") for k in range(16))),
        Message("LAB").of(*(Field(f"AVeryLongLabel{k}", "B") for k in range(5))),
        Message("UNIT").of(Field("A", "f", "!")),
        Message("TYPE").of(Field("A", "x")),
    ],
)
def test_check_refuses_what_does_not_fit(message: Message) -> None:
    with pytest.raises(ValueError, match=message.name):
        formats.check(message)


def test_head_describes_types_units_and_multipliers(tmp_path: Path) -> None:
    message = Message("ABC").of(Field("I", "B", "#"), Field("Ang", "c", "d", "B"), Field("Txt", "N"))
    numbers = formats.number_all([message])
    body = message.packer.pack(*formats.HEAD, numbers["ABC"], 5_000_000, 2, -1234, b"words")
    path = tmp_path / "one.bin"
    path.write_bytes(formats.head([message], numbers, 0) + body)
    log = DFReader.DFReader_binary(str(path))
    read = log.recv_match(type="ABC")
    assert (read.TimeUS, read.I, read.Ang, read.Txt) == (5_000_000, 2, -12.34, "words")
    described = read.fmt
    assert (described.get_unit("TimeUS"), described.get_unit("Ang")) == ("\u00b5s", "deg")
    assert described.instance_field == "I"
    log.close()


def test_the_filter_tells_its_innovations(tmp_path: Path) -> None:
    simulation = Simulation("erle_copter", seed=3, params={"LOG_DISARMED": 1})
    path = tmp_path / "run.bin"
    runner.open_dataflash(simulation, path)
    simulation.advance(90.0)
    ekf = simulation.v.autopilot.ekf
    simulation.close()
    log = read_log(path)
    last, used = log["XKF3"][-1], [m for m in log["XKF3"] if m.TimeUS > 60e6]
    vel, pos = ekf.innovation_vel, ekf.innovation_pos
    assert pytest.approx((-vel.x, -vel.y, -vel.z), abs=0.006) == (last.IVN, last.IVE, last.IVD)
    assert pytest.approx((-pos.x, -pos.y, -pos.z), abs=0.006) == (last.IPN, last.IPE, last.IPD)
    assert pytest.approx(-math.degrees(ekf.innovation_yaw), abs=0.006) == last.IYAW
    for name, most in (("IVN", 1.0), ("IPE", 3.0), ("IPD", 2.0), ("IYAW", 5.0)):  # at rest: noise about zero
        values = np.array([getattr(m, name) for m in used])
        assert 0.0 < np.std(values) < most and abs(np.mean(values)) < 0.5 * most, name


def test_two_filters_are_logged_while_there_are_two(tmp_path: Path) -> None:
    simulation = Simulation("erle_copter", params={"LOG_DISARMED": 1, "SIM_ACC2_BIAS_Z": 0.5})
    path = tmp_path / "run.bin"
    runner.open_dataflash(simulation, path)
    simulation.advance(60.0)
    assert simulation.v.autopilot.second_lane.runs == 1
    simulation.close()
    log = read_log(path)
    for name in ("XKF1", "XKF2", "XKF3", "XKF4", "XKF5", "XKFS", "XKQ"):
        assert [m.C for m in log[name][-2:]] == [0, 1], name
    first, second = log["XKF2"][-2:]
    assert pytest.approx((0.0, 0.5), abs=0.15) == (first.AZ, second.AZ), "each learns the bias of its own sensor"
    assert {m.PI for m in log["XKF4"]} == {0} and {m.MI for m in log["XKFS"]} == {0}


def test_what_is_logged_behind_a_silent_event_is_no_earlier() -> None:
    simulation = Simulation("erle_copter", estimator="truth")
    encoder = LogEncoder(simulation, 0, 0, "test")
    encoder.begin(0)
    emit(simulation.v.autopilot.events, 2000, TERRAIN_LEFT, 0.0, 0.0)
    emit(simulation.v.autopilot.events, 1000, EKF_STOPPED_GPS, 0.0, 0.0)
    encoder.read_events()
    ((_, time_us, data),) = encoder._notes
    assert time_us == 2000 and data == encoder.events.pack("EV", 2000, 19)
