# SPDX-License-Identifier: BSD-3-Clause
"""Fields of telemetry by MAVLink's units, each with a value of its own, and where they are not known."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.bridge.copter import status_messages as copter
from sitl.bridge.rover import status_messages as rover
from sitl.bridge.telemetry import motion, sensors
from sitl.bridge.telemetry.builder import compiled
from sitl.bridge.wire.choose import message_of
from sitl.core.vectors import Euler, Quat, Vec3
from sitl.vehicle.copter import Copter
from sitl.vehicle.rover import Rover
from tests.bridge.test_telemetry_laws import HOME, says


def located() -> Any:
    """12.345678 s after boot, 10 m up, 100 m north and 200 m east of an origin."""
    found: Any = Copter()
    found.time_us = 12_345_678
    estimate, home = found.autopilot.estimate, found.autopilot.home
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = HOME
    estimate.origin_set = True
    estimate.pos, estimate.vel = Vec3(100.0, 200.0, -10.0), Vec3(3.0, -4.0, 0.5)
    estimate.euler = Euler(0.1, -0.2, 1.5)
    home.lat, home.lon, home.alt, home.is_set = *HOME[:2], HOME[2] + 1.0, True
    home.pos = Vec3(1.0, 2.0, -1.0)
    return found


@pytest.fixture
def v() -> Any:
    return located()


def test_positions_on_the_globe(v: Any) -> None:
    m = says(motion.global_position_int, v)
    assert (m.alt, m.relative_alt) == (594_000, 9_000)
    assert (m.vx, m.vy, m.vz, m.hdg, m.time_boot_ms) == (300, -400, 50, 8594, 12_345)
    v.autopilot.home.is_set = False
    assert says(motion.global_position_int, v).relative_alt == 0
    v.autopilot.estimate.origin_set = False
    v.autopilot.estimate.status_flags = motion.POS_HORIZ_REL
    m = says(motion.global_position_int, v)
    assert (m.lat, m.lon, m.alt, m.relative_alt) == (0, 0, 0, 10_000), "above where it began"


def test_positions_from_the_origin_are_told_where_there_is_one(v: Any) -> None:
    m = says(motion.local_position_ned, v)
    assert (m.x, m.y, m.z, m.vx, m.vy, m.vz, m.time_boot_ms) == (100.0, 200.0, -10.0, 3.0, -4.0, 0.5, 12_345)
    v.autopilot.estimate.origin_set = False
    assert says(motion.local_position_ned, v) is None
    v.autopilot.estimate.status_flags = motion.POS_HORIZ_REL
    assert says(motion.local_position_ned, v) is not None


@pytest.mark.parametrize(("throttle", "percent"), [(0.0, 0), (0.494, 49), (0.495, 50), (1.0, 100), (-0.5, 50)])
def test_the_head_up_display(v: Any, throttle: float, percent: int) -> None:
    m = says(copter.vfr_hud, v)
    assert (m.groundspeed, m.airspeed, m.alt, m.climb, m.heading) == (5.0, 5.0, 594.0, -0.5, 85)
    hud: Any = type("Hud", (), {})()
    motion.vfr_hud(hud, v, throttle)
    assert hud.throttle == percent


def test_home_and_origin(v: Any) -> None:
    m = says(motion.home_position, v)
    assert (m.latitude, m.longitude, m.altitude, m.x, m.y, m.z) == (*HOME[:2], 585_000, 1.0, 2.0, -1.0)
    assert all(map(math.isnan, m.q)) and m.time_usec == 12_345_678
    m = says(motion.gps_global_origin, v)
    assert (m.latitude, m.longitude, m.altitude, m.time_usec) == (*HOME[:2], 584_000, 12_345_678)
    v.autopilot.home.is_set = v.autopilot.estimate.origin_set = False
    assert says(motion.home_position, v) is None is says(motion.gps_global_origin, v)


@pytest.mark.parametrize("second", [False, True])
def test_a_receivers_fix(v: Any, second: bool) -> None:
    s = v.sensors.gps2 if second else v.sensors
    s.gps_time_us, s.gps_lat, s.gps_lon, s.gps_alt = 12_000_000, 10, -20, 30_000
    s.gps_fix, s.gps_satellites, s.gps_eph, s.gps_epv = 4, 12, 121, 200
    s.gps_vel = Vec3(0.0, -250.0, 999.0)
    v.autopilot.params["GPS2_TYPE"] = 1.0
    law = motion.gps2_raw if second else motion.gps_raw_int
    m = says(law, v)
    assert (m.fix_type, m.lat, m.lon, m.alt, m.alt_ellipsoid) == (4, 10, -20, 30_000, 30_000)
    assert (m.vel, m.cog, m.satellites_visible, m.eph, m.epv) == (250, 27_000, 12, 121, 200)
    assert m.h_acc == round(motion.ACCURACY_OF_HDOP * 121) and m.v_acc == round(motion.ACCURACY_OF_VDOP * 200)
    assert m.vel_acc == 0
    s.gps_eph, s.gps_satellites = motion.USUAL_HDOP + 1000, 300
    m = says(law, v)
    assert (m.vel_acc, m.satellites_visible) == (800, 255)
    s.gps_fix = 1
    m = says(law, v)
    assert (m.fix_type, m.eph, m.epv, m.h_acc, m.v_acc, m.vel_acc) == (1, 65535, 65535, 0, 0, 0)
    v.autopilot.params["GPS2_TYPE"] = 0.0
    assert says(motion.gps2_raw, v) is None


def test_attitudes(v: Any) -> None:
    estimate = v.autopilot.estimate
    m = says(motion.ahrs2, v)
    assert (m.roll, m.pitch, m.yaw, m.altitude) == pytest.approx((0.1, -0.2, 1.5, 594.0)) and m.lng > HOME[1]
    estimate.q, estimate.rates, estimate.gyro_bias = (
        Quat(0.5, -0.5, 0.25, 0.75),
        Vec3(1.0, 2.0, 3.0),
        Vec3(0.1, -0.2, 0.3),
    )
    m = says(motion.attitude_quaternion, v)
    assert (m.q1, m.q2, m.q3, m.q4, m.rollspeed, m.pitchspeed, m.yawspeed) == (0.5, -0.5, 0.25, 0.75, 1.0, 2.0, 3.0)
    m = says(motion.ahrs, v)
    assert (m.omegaIx, m.omegaIy, m.omegaIz) == pytest.approx((-0.1, 0.2, -0.3))


PARTS = {"OPTICAL_FLOW", "GPS2_RAW", "DISTANCE_SENSOR", "RANGEFINDER", "OBSTACLE_DISTANCE", "DEBUG_FLOAT_ARRAY"}
"""Of what may be fitted."""
ASKED_FOR = {"FENCE_STATUS", "PID_TUNING", "POSITION_TARGET_GLOBAL_INT"}
"""While a fence is on, loops are chosen, or there is a target."""


@pytest.mark.parametrize(
    ("record", "module", "silent"),
    [
        (Copter, copter, {"POSITION_TARGET_LOCAL_NED", "RPM", "ESC_TELEMETRY_1_TO_4", "ESC_TELEMETRY_5_TO_8"}),
        (Rover, rover, {"NAV_CONTROLLER_OUTPUT", "WHEEL_DISTANCE"}),
    ],
)
def test_a_vehicle_that_knows_where_it_is_tells_all_but_of_what_it_lacks(record: Any, module: Any, silent: Any) -> None:
    made: Any = record()
    made.time_us = 12_345_678
    estimate = made.autopilot.estimate
    estimate.origin_lat, estimate.origin_lon, estimate.origin_alt = HOME
    assert {"LOCAL_POSITION_NED", "GPS_GLOBAL_ORIGIN", "HOME_POSITION"} <= unsaid(made, module)
    estimate.origin_set = made.autopilot.home.is_set = True
    assert unsaid(made, module) == PARTS | ASKED_FOR | silent


def unsaid(v: Any, module: Any) -> set[str]:
    return {message_of(law).kind.name for law in compiled(module.MESSAGES) if says(law, v) is None}


# ---------------------------------------------------------------- sensors


def shaken(v: Any) -> Any:
    c = v.autopilot.calibrated
    c.acc, c.gyro, c.mag = Vec3(0.0, 9.80665, -19.6133), Vec3(0.1, -0.2, 0.3), Vec3(0.25, -0.5, 0.125)
    c.acc2, c.gyro2 = Vec3(9.80665, 0.0, 0.0), Vec3(1.0, 2.0, 3.0)
    v.sensors.temperature, v.sensors.abs_pressure, v.sensors.abs_pressure2 = 21.5, 1013.25, 900.0
    return v


@pytest.mark.parametrize("law", [sensors.raw_imu, sensors.scaled_imu])
def test_imus_are_thousandths(v: Any, law: Any) -> None:
    """mG, mrad/s, mgauss, hundredths of a degree Celsius."""
    m = says(law, shaken(v))
    assert (m.xacc, m.yacc, m.zacc) == (0, 1000, -2000) and (m.xmag, m.ymag, m.zmag) == (250, -500, 125)
    assert (m.xgyro, m.ygyro, m.zgyro, m.temperature) == (100, -200, 300, 2150)


def test_the_second_imu_is_the_first_where_they_do_not_differ(v: Any) -> None:
    assert says(sensors.scaled_imu2, shaken(v)).yacc == 1000
    v.sensors.imu_state = sensors.IMUS_DIFFER
    m = says(sensors.scaled_imu2, v)
    assert (m.xacc, m.yacc, m.xgyro, m.zgyro) == (1000, 0, 1000, 3000)


def test_pressures(v: Any) -> None:
    m = says(sensors.highres_imu, shaken(v))
    assert (m.abs_pressure, m.pressure_alt, m.temperature) == (1013.25, 0.0, 21.5)
    assert (m.yacc, m.zgyro, m.xmag) == pytest.approx((9.80665, 0.3, 0.25))
    assert m.fields_updated == 0x1FFF & ~(1 << 10), "all but the differential pressure"
    v.sensors.abs_pressure = 898.746
    assert says(sensors.highres_imu, v).pressure_alt == pytest.approx(1000.0, abs=0.5), "the standard atmosphere"
    v.sensors.abs_pressure = -1.0
    assert says(sensors.highres_imu, v).pressure_alt == 0.0
    m = says(sensors.scaled_pressure, v)
    assert (m.press_abs, m.temperature) == (-1.0, 2150)
    assert says(sensors.scaled_pressure2, v).press_abs == -1.0
    v.sensors.baro_state = sensors.BAROS_DIFFER
    assert says(sensors.scaled_pressure2, v).press_abs == 900.0
    v.sensors.baro_state = sensors.ONE_BARO
    assert says(sensors.scaled_pressure2, v) is None


def test_clipping_counts_by_imu(v: Any) -> None:
    v.autopilot.vibration.clips, v.autopilot.vibration.more_clips = 3, 2
    m = says(sensors.vibration, v)
    assert (m.clipping_0, m.clipping_1, m.clipping_2, m.time_usec) == (3, 5, 0, 12_345_678)
