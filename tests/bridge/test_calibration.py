# SPDX-License-Identifier: BSD-3-Clause
"""Sensors with errors are calibrated over MAVLink; the bench turns the vehicle as a user's hands would."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl import Simulation
from sitl.autopilot.estimation.alignment import CALIBRATE
from sitl.autopilot.sensor_calibration import ACCELS_DONE
from sitl.bridge.services import calibration
from sitl.bridge.services.calibration import GYROS, LEVEL, SIMPLE, CalibrationService
from sitl.client import Client
from sitl.client.errors import CommandRefusedError
from sitl.core.algebra import yaw_of
from sitl.core.vectors import Vec3
from tests.bridge.fakes import Bench, mavlink

IRON = {
    "SIM_MAG1_OFS_X": 100, "SIM_MAG1_OFS_Y": 200, "SIM_MAG1_OFS_Z": -150, "SIM_MAG1_DIA_X": 1.0, "SIM_MAG1_DIA_Y": 1.1,
    "SIM_MAG1_DIA_Z": 1.2, "SIM_MAG1_ODI_X": 0.004, "SIM_MAG2_OFS_X": -80,
}  # fmt: skip
ACCELEROMETER = {
    "SIM_ACC1_BIAS_X": 0.7, "SIM_ACC1_BIAS_Y": -0.3, "SIM_ACC1_BIAS_Z": 1.8, "SIM_ACC1_SCAL_X": 0.98,
    "SIM_ACC1_SCAL_Y": 1.12, "SIM_ACC1_SCAL_Z": 1.05, "SIM_ACC_TRIM_X": 0.05, "SIM_ACC_TRIM_Y": -0.03,
}  # fmt: skip
SIDES = ((0, 0), (-90, 0), (90, 0), (0, -90), (0, 90), (180, 0))
"""Roll and pitch [deg] of the six positions."""
BOOT_S = 25.0


class User(Client):
    """A client that remembers what calibrations tell."""

    def __init__(self, frame: str = "calibration_copter", **params: float) -> None:
        self.told: list[tuple[str, Any]] = []
        super().__init__(Simulation(frame, params=params))
        self.delay(BOOT_S)

    def _take(self, name: str, fields: Any) -> None:
        super()._take(name, fields)
        if name in ("MAG_CAL_PROGRESS", "MAG_CAL_REPORT", "COMMAND_LONG"):
            self.told.append((name, fields))

    def last(self, name: str) -> Any:
        return next(fields for kind, fields in reversed(self.told) if kind == name)

    def has_text(self, text: str) -> bool:
        return any(text in said.text for said in self.texts)

    def turn(self, roll: float, pitch: float, yaw: float = 0.0) -> None:
        """Have the bench hold an attitude [deg]."""
        for output, angle in ((6, roll), (7, pitch), (8, yaw)):
            self.command("DO_SET_SERVO", output, round(1500 + angle / 0.36))
        self.command("DO_SET_SERVO", 5, 1150)
        self.delay(4.0)

    def axes(self, group: str) -> list[float]:
        return [self.params[f"{group}_{axis}"] for axis in "XYZ"]

    def reported(self) -> set[int]:
        return {fields.compass_id for name, fields in self.told if name == "MAG_CAL_REPORT"}


def test_gyros() -> None:
    user = User(SIM_GYR1_BIAS_X=0.02, SIM_GYR1_BIAS_Z=-0.01)
    drift = user.simulation.v.autopilot.estimate.rates
    user.command("PREFLIGHT_CALIBRATION", 1)
    user.delay(2.0)
    assert user.axes("INS_GYROFFS") == pytest.approx([0.02, 0.0, -0.01], abs=1e-3)
    assert tuple(user.simulation.v.autopilot.estimate.rates) == pytest.approx(tuple(drift), abs=2e-3)


def test_accelerometers_level_and_trim() -> None:
    user = User("ardupilot_rover", SIM_ACC1_BIAS_X=0.7, SIM_ACC1_BIAS_Z=-0.5)
    assert abs(user.attitude.pitch) > math.radians(3.0)
    user.command("PREFLIGHT_CALIBRATION", 0, 0, 0, 0, 4)
    user.delay(6.0)
    assert user.axes("INS_ACCOFFS") == pytest.approx([0.7, 0.0, -0.5], abs=0.02)
    assert abs(user.attitude.pitch) < math.radians(0.5)
    user.params["SIM_ACC_TRIM_X"] = 0.06
    user.command("PREFLIGHT_CALIBRATION", 0, 0, 0, 0, 2)
    with pytest.raises(CommandRefusedError):
        user.command("PREFLIGHT_CALIBRATION", 1)  # one after the other
    user.delay(2.0)
    assert user.params["AHRS_TRIM_X"] == pytest.approx(0.06, abs=1e-3)
    assert user.has_text("Trim OK: roll=3.4")


def test_accelerometers_in_six_positions() -> None:
    user = User(**ACCELEROMETER)
    user.command("PREFLIGHT_CALIBRATION", 0, 0, 0, 0, 1)
    for number, (roll, pitch) in enumerate(SIDES, start=1):
        user.turn(roll, pitch)
        asked = user.last("COMMAND_LONG")
        assert (asked.command, asked.param1) == (42429, number)
        if number == 3:  # as MAVProxy does: any acknowledgement
            user.send("COMMAND_ACK", command=number, result=1)
        else:
            with pytest.raises(CommandRefusedError):
                user.command("ACCELCAL_VEHICLE_POS", number + 1)
            user.command("ACCELCAL_VEHICLE_POS", number)
        user.delay(1.5)
    assert user.has_text("Calibration successful") and user.last("COMMAND_LONG").param1 == 16777215
    assert user.axes("INS_ACCOFFS") == pytest.approx([0.7, -0.3, 1.8], rel=0.005)
    assert user.axes("INS_ACCSCAL") == pytest.approx([0.98, 1.12, 1.05], rel=0.005)
    assert (user.params["AHRS_TRIM_X"], user.params["AHRS_TRIM_Y"]) == pytest.approx((0.05, -0.03), rel=0.005)
    user.turn(0, 0)
    assert tuple(user.simulation.v.autopilot.calibrated.acc) == pytest.approx((0.0, 0.0, -9.8), abs=0.02)
    user.delay(30.0)
    assert user.has_text("Accels calibrated requires reboot")


def test_positions_that_are_all_the_same_fail() -> None:
    user = User()
    user.command("PREFLIGHT_CALIBRATION", 0, 0, 0, 0, 1)
    for number in range(1, 7):
        user.command("ACCELCAL_VEHICLE_POS", number)
        user.delay(1.5)
    assert user.has_text("Calibration FAILED") and user.last("COMMAND_LONG").param1 == 16777216
    assert user.axes("INS_ACCOFFS") == [0.0, 0.0, 0.0]


@pytest.mark.slow
def test_compasses_by_turning() -> None:
    user = User(**IRON)
    user.command("DO_START_MAG_CAL", 0)
    user.command("DO_SET_SERVO", 5, 1250)
    assert user.passes(lambda: user.told and user.last("MAG_CAL_PROGRESS").completion_pct > 20, 60)
    user.command("DO_START_MAG_CAL", 0)  # goes on
    user.delay(1.0)
    assert user.last("MAG_CAL_PROGRESS").completion_pct > 20
    with pytest.raises(CommandRefusedError):
        user.command("DO_ACCEPT_MAG_CAL", 0)
    kept = user.simulation.snapshot()
    seen = []
    for _ in range(2):
        user.simulation.restore(kept)
        user.told.clear()
        assert user.passes(lambda: user.reported() == {0, 1, 2}, 200)
        seen.append(user.last("MAG_CAL_REPORT"))
    assert seen[0] == seen[1]  # a snapshot has the samples
    assert all(fields.cal_status == 4 for name, fields in user.told if name == "MAG_CAL_REPORT")
    assert user.params["COMPASS_OFS_X"] == 5.0
    user.command("DO_ACCEPT_MAG_CAL", 0)
    assert user.axes("COMPASS_OFS") == pytest.approx([100.0, 200.0, -150.0], abs=0.5)
    assert user.axes("COMPASS_DIA") == pytest.approx([1.0, 1.1, 1.2], abs=1e-3)
    assert user.params["COMPASS_ODI_X"] == pytest.approx(0.004, abs=1e-4)
    assert user.axes("COMPASS_OFS2") == pytest.approx([-80.0, 13.0, -18.0], abs=0.5)
    user.turn(0, 0)
    user.delay(30.0)
    assert user.has_text("Compass calibration running") and user.has_text("Compass calibrated requires reboot")
    assert not user.has_text("Compass not healthy")


def test_a_calibration_that_fits_badly_fails_and_one_is_cancelled() -> None:
    user = User(COMPASS_OFFS_MAX=50, **IRON)
    user.command("DO_START_MAG_CAL", 1)
    user.command("DO_SET_SERVO", 5, 1250)
    assert user.passes(lambda: user.reported() == {0}, 200)
    assert user.last("MAG_CAL_REPORT").cal_status == 5
    with pytest.raises(CommandRefusedError):
        user.command("DO_ACCEPT_MAG_CAL", 1)
    user.command("DO_CANCEL_MAG_CAL", 1)
    user.command("DO_START_MAG_CAL", 2)
    user.delay(1.0)
    assert user.last("MAG_CAL_PROGRESS").compass_id == 1
    user.command("DO_CANCEL_MAG_CAL", 0)
    user.told.clear()
    user.delay(2.0)
    assert not user.told and user.axes("COMPASS_OFS") == [5.0, 13.0, -18.0]
    for mask in (8, -1):
        with pytest.raises(CommandRefusedError):
            user.command("DO_START_MAG_CAL", mask)


def test_compasses_from_a_known_heading() -> None:
    """With EK3_MAG_CAL 2, ArduRover's default, the heading takes minutes to come back, as there."""
    user = User("ardupilot_rover", SIM_MAG1_OFS_X=100, SIM_MAG1_OFS_Y=300, SIM_MAG3_OFS_Z=99, EK3_MAG_CAL=4)
    true = math.degrees(yaw_of(user.simulation.v.physics.body.q))
    assert abs(math.degrees(user.attitude.yaw) - true) > 10.0
    user.command("FIXED_MAG_CAL_YAW", true)
    assert user.axes("COMPASS_OFS") == pytest.approx([100.0, 300.0, -18.0], abs=3.0)
    assert user.axes("COMPASS_OFS3") == pytest.approx([5.0, 13.0, 99.0], abs=3.0)
    user.delay(30.0)
    assert abs(math.degrees(user.attitude.yaw) - true) < 2.0


def test_an_armed_vehicle_is_not_calibrated() -> None:
    user = User("ardupilot_rover")
    user.wait_ready()
    user.arm()
    for name, params in (("PREFLIGHT_CALIBRATION", (1,)), ("DO_START_MAG_CAL", (0,))):
        with pytest.raises(CommandRefusedError):
            user.command(name, *params)
    assert user.has_text("Disarm to allow calibration") and user.has_text("Disarm to allow compass calibration")


def test_all_directions_have_a_section() -> None:
    from sitl.bridge.services.compass_calibration import SECTIONS

    assert SECTIONS.shape == (80, 3)
    apart = np.degrees(np.arccos(np.clip(SECTIONS @ SECTIONS.T - 2.0 * np.eye(80), -1.0, 1.0)))
    assert apart.min() > 15.0


def test_a_position_is_asked_for_again_as_soon_as_it_is_due() -> None:
    bench = Bench()
    service = bench.bridge.get(CalibrationService)
    bench.run(3.0)
    bench.client.receive()
    service.start_positions()
    asked = []
    for _ in range(4):
        now, due = bench.bridge.now_us, service.due_us
        service.service(max(due - 1, now) if asked else due)
        service.service(due)
        bench.bridge.flush()
        asked.append([m.param1 for m in bench.client.receive("COMMAND_LONG")])
        assert service.due_us == due + 1_000_000
    assert asked == [[1.0]] * 4, "once each time"


# ---------------------------------------------------------------- step by step, without physics

ACCEPTED, REJECTED, FAILED = 0, 1, 4
G = 9.80665


def resting(bench: Bench, roll: float = 0.0, pitch: float = 0.0) -> CalibrationService:
    """Shows gravity of a vehicle that leans so [deg]."""
    bench.run(3.0)
    r, p = math.radians(roll), math.radians(pitch)
    acc = Vec3(G * math.sin(p), -G * math.sin(r) * math.cos(p), -G * math.cos(r) * math.cos(p))
    bench.vehicle.v.sensors.acc, bench.vehicle.v.sensors.gyro = acc, Vec3(0.0, 0.0, 0.0)
    found: CalibrationService = bench.bridge.get(CalibrationService)
    return found


def values(bench: Bench, group: str) -> list[float]:
    return [bench.vehicle.parameters[f"{group}_{axis}"] for axis in "XYZ"]


def test_gyros_are_measured_for_a_second(bench: Bench) -> None:
    service, v = resting(bench), bench.vehicle.v
    v.autopilot.params.INS.GYROFFS.Y = 0.01
    v.autopilot.ekf.gyro_bias = Vec3(0.5, 0.25, 0.0)
    assert service.start(GYROS) == ACCEPTED
    assert service.start(GYROS) == service.start_positions() == REJECTED and service.is_in_position(1.0) == FAILED
    v.sensors.gyro = Vec3(0.04, 0.0, 0.0)
    bench.run(0.5)
    v.sensors.gyro = Vec3(0.0, 0.0, -0.02)
    bench.run(0.4975)
    assert values(bench, "INS_GYROFFS") == [0.0, 0.01, 0.0]
    bench.run(0.0025)
    assert values(bench, "INS_GYROFFS") == pytest.approx([0.02, 0.0, -0.01], abs=1e-7)
    assert tuple(v.autopilot.ekf.gyro_bias) == pytest.approx((0.48, 0.26, 0.01), abs=1e-7)
    assert service.start(GYROS) == ACCEPTED, "it is over"


@pytest.mark.parametrize(
    ("roll", "pitch", "result"), [(9.9, 0.0, ACCEPTED), (0.0, -9.9, ACCEPTED), (10.1, 0.0, FAILED), (0.0, 10.1, FAILED)]
)
def test_who_leans_by_more_than_ten_degrees_is_not_level(bench: Bench, roll: float, pitch: float, result: int) -> None:
    assert resting(bench, roll, pitch).start(LEVEL) == result
    bench.client.receive()
    bench.run(1.0)
    texts = [m.text.replace("-0.00", "0.00") for m in bench.client.receive("STATUSTEXT")]
    assert texts == [f"Trim OK: roll={roll:.2f} pitch={pitch:.2f} yaw=0.00"] * (result == ACCEPTED)
    trim = (math.radians(roll), math.radians(pitch)) if result == ACCEPTED else (0.0, 0.0)
    assert values(bench, "AHRS_TRIM")[:2] == pytest.approx(trim, abs=1e-6)


@pytest.mark.parametrize("phase", [CALIBRATE, CALIBRATE + 1])
def test_level_accelerometers_have_offsets_and_no_trim(bench: Bench, phase: int) -> None:
    service, ap = resting(bench), bench.vehicle.v.autopilot
    bench.vehicle.v.sensors.acc = Vec3(0.5, -0.25, -G + 0.75)
    bench.vehicle.parameters["AHRS_TRIM_X"], ap.ekf.phase = 0.1, phase
    ap.params.INS.ACCSCAL.X = 1.05
    assert service.start(SIMPLE) == ACCEPTED
    bench.run(1.0)
    assert values(bench, "INS_ACCOFFS") == pytest.approx([0.5, -0.25, 0.75], abs=1e-6)
    assert values(bench, "INS_ACCSCAL") == [1.0, 1.0, 1.0] and values(bench, "AHRS_TRIM")[:2] == [0.0, 0.0]
    assert ap.ekf.good_acc.z == (0.0 if phase == CALIBRATE else pytest.approx(-G, abs=1e-6))


@pytest.mark.parametrize(
    ("fitness", "offset", "scale", "good"),
    [
        (0.09, 3.4, 1.2, True), (0.1, 0.0, 1.0, False), (0.0, 3.5, 1.0, False), (0.0, -3.5, 1.0, False),
        (0.0, 0.0, 0.8, True), (0.0, 0.0, 0.79, False), (0.0, 0.0, 1.21, False),
    ],
)  # fmt: skip
def test_six_positions_and_what_comes_of_them(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, fitness: float, offset: float, scale: float, good: bool
) -> None:
    """Each is asked for once a second until a client says so; the result is told in the same way."""
    service, seen = resting(bench), []
    fit = SimpleNamespace(fitness=fitness, offset=(0.0, offset, 0.0), scale=(1.0, 1.0, scale))
    monkeypatch.setattr(calibration, "fit_accelerometer", lambda means: seen.append(means.copy()) or fit)
    bench.client.receive()
    assert service.start_positions() == ACCEPTED
    for number in range(1, 7):
        bench.run(1.0)
        heard = bench.client.receive("COMMAND_LONG", "STATUSTEXT")
        asked = [m for m in heard if m.get_type() == "COMMAND_LONG"]
        assert {m.command for m in asked} == {42429} and asked[-1].param1 == number
        assert len(asked) == (1, 3, 2, 2, 2, 2)[number - 1], "at once, and a second later"
        assert [m.severity for m in heard if m.get_type() == "STATUSTEXT"] == [2]
        assert service.is_in_position(number + 1.0) == FAILED and service.start(GYROS) == REJECTED
        if number == 1:
            bench.client.send(mavlink.MAVLink_command_ack_message(0, 0))
            bench.bridge.receive()
        else:
            assert service.is_in_position(float(number)) == ACCEPTED
        bench.vehicle.v.sensors.acc = Vec3(float(number), 0.0, -G)
        bench.client.receive()
        bench.run(1.0)
    result = 16777215 if good else 16777216
    assert seen[0] == pytest.approx(np.array([[k, 0.0, -G] for k in range(1, 7)]), abs=1e-6)
    heard = bench.client.receive("COMMAND_LONG", "STATUSTEXT")
    assert {m.param1 for m in heard if m.get_type() == "COMMAND_LONG"} >= {result}
    assert ("Calibration successful" if good else "Calibration FAILED") in [
        m.text for m in heard if m.get_type() == "STATUSTEXT"
    ]
    bench.run(2.0)
    assert [m.param1 for m in bench.client.receive("COMMAND_LONG")] == [result] * 2
    assert bool(bench.vehicle.v.autopilot.calibrated.state & ACCELS_DONE) == good
    assert values(bench, "INS_ACCOFFS") == pytest.approx([0.0, offset * good, 0.0])
    assert values(bench, "INS_ACCSCAL") == pytest.approx([1.0, 1.0, scale if good else 1.0])
    assert service.is_in_position(float(result)) == FAILED and service.start(GYROS) == ACCEPTED
