# SPDX-License-Identifier: BSD-3-Clause
"""Sensors and strapdown navigation: conversions, checks, motions with known answers, broken samples."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.autopilot.estimation import aiding, barometer, gps, magnetometer, strapdown
from sitl.autopilot.estimation.state import Ekf
from sitl.autopilot.params.estimator import Ekf3
from sitl.core.algebra import IDENTITY
from sitl.core.border import GpsReading
from sitl.core.vectors import Vec3
from tests.autopilot.estimation import synthetic_flight as sf


def _fix() -> GpsReading:
    s = GpsReading()
    s.gps_fix, s.gps_satellites, s.gps_eph = 3, 10, 121
    s.gps_lat, s.gps_lon, s.gps_alt = -353632620, 1491652370, 584000
    return s


def _checks(bits: int) -> Ekf3:
    """Parameters that ask for some of the checks, with the usual limits."""
    params = Ekf3()
    params.GPS_CHECK, params.CHECK_SCALE = bits, 100.0
    return params


@pytest.mark.parametrize(("altitude", "hpa"), [(0.0, 1013.25), (1000.0, 898.746), (5000.0, 540.199)])
def test_standard_atmosphere(altitude: float, hpa: float) -> None:
    assert barometer.standard_altitude(hpa) == pytest.approx(altitude, abs=0.2)  # ISO 2533 tables


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), 0.0, -5.0, 99.0, 1300.0])
def test_broken_pressure_is_passed_over(bad: float) -> None:
    ekf = Ekf()
    barometer.read(ekf, 1, bad)
    assert ekf.baro_n == 0 and ekf.baro_seen == 1


@pytest.mark.parametrize("bad", [(float("nan"), 0.2, 0.3), (0.2, float("inf"), 0), (0, 0, 0), (5.0, 0, 0)])
def test_broken_field_is_passed_over(bad) -> None:
    ekf = Ekf()
    magnetometer.read(ekf, 1, Vec3(*bad))
    assert ekf.mag_n == 0 and ekf.mag_seen == 1


def test_a_good_fix_is_sane_and_passes() -> None:
    assert gps.is_sane(_fix())
    assert gps.has_quality(_fix(), _checks(31))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("gps_fix", 2),
        ("gps_lat", 910000000),
        ("gps_lon", -1810000000),
        ("gps_alt", 2**31 - 1),
        ("gps_vel", (0, 40000, 0)),
        ("gps_vel", (-(2**31), 0, 0)),
    ],
)
def test_a_fix_with_values_that_make_no_sense_is_refused(name: str, value) -> None:
    sensors = _fix()
    sensors[name] = value
    assert not gps.is_sane(sensors)


@pytest.mark.parametrize(("name", "value"), [("gps_satellites", 5), ("gps_eph", 300), ("gps_eph", 0)])
def test_quality_checks_can_be_switched_off(name: str, value: int) -> None:
    sensors = _fix()
    sensors[name] = value
    assert not gps.has_quality(sensors, _checks(31))
    assert gps.has_quality(sensors, _checks(0))


def test_origin_is_set_once(ap) -> None:
    def set_origin(lat: int, lon: int, alt: float) -> bool:
        return aiding.set_origin(ap.ekf, ap.estimate, ap.events, aiding.Origin(lat, lon, alt))

    assert not set_origin(910000000, 0, 0.0)
    assert not set_origin(-353632620, 1491652370, float("nan"))
    assert set_origin(-353632620, 1491652370, 584.0)
    assert not set_origin(0, 0, 0.0)
    e = ap.estimate
    assert (e.origin_set, e.origin_lat, e.origin_lon, e.origin_alt) == (1, -353632620, 1491652370, 584.0)
    assert math.degrees(ap.ekf.declination) == pytest.approx(12.7, abs=0.3)


def test_yaw_turns_by_the_declination_learnt(ap) -> None:
    ap.ekf.q, ap.ekf.yaw_aligned = IDENTITY, True
    aiding.set_origin(ap.ekf, ap.estimate, ap.events, aiding.Origin(-353632620, 1491652370, 584.0))
    assert 2 * math.atan2(ap.ekf.q.z, ap.ekf.q.w) == pytest.approx(ap.ekf.declination)
    assert ap.estimate.reset_yaw == pytest.approx(ap.ekf.declination)
    assert ap.estimate.reset_yaw_count == 1


def test_yaw_stays_where_the_heading_alone_is_fused(ap) -> None:
    ap.ekf.q, ap.ekf.yaw_aligned, ap.ekf.heading_only = IDENTITY, True, True
    aiding.set_origin(ap.ekf, ap.estimate, ap.events, aiding.Origin(-353632620, 1491652370, 584.0))
    assert math.degrees(ap.ekf.declination) == pytest.approx(12.7, abs=0.3)
    assert tuple(ap.ekf.q) == tuple(IDENTITY)
    assert ap.estimate.reset_yaw_count == 0


def test_truth_in_truth_out() -> None:
    """Perfect samples of a minute's flight with turns: attitude to 0.001 degree, position to 5 cm."""
    truth = sf.fly(30.0, 2.0)
    ekf = Ekf()
    ekf.q, ekf.pos, ekf.vel = truth.q[0], truth.pos[0], truth.vel[0]
    for k in range(1, len(truth.t)):
        ekf.good_gyro, ekf.good_acc = truth.rates[k], truth.force[k]
        strapdown.advance(ekf, sf.DT)
    assert math.degrees(sf.attitude_error(np.array([ekf.q]), truth.q[-1:])[0]) < 1e-3
    assert np.linalg.norm(ekf.q) == pytest.approx(1.0, abs=1e-12)
    assert ekf.vel == pytest.approx(truth.vel[-1], abs=5e-3)
    assert ekf.pos == pytest.approx(truth.pos[-1], abs=5e-2)


def test_bias_is_taken_off() -> None:
    ekf = Ekf()
    ekf.q = IDENTITY
    ekf.gyro_bias = ekf.good_gyro = Vec3(0.1, -0.2, 0.3)
    ekf.acc_bias = Vec3(0.1, 0.2, 0.3)
    ekf.good_acc = Vec3(0.1, 0.2, 0.3 - strapdown.GRAVITY)
    for _ in range(100):
        strapdown.advance(ekf, sf.DT)
    assert ekf.q == pytest.approx([1, 0, 0, 0])
    assert ekf.vel == pytest.approx([0, 0, 0], abs=1e-12)


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf"), 1e30])
@pytest.mark.parametrize("name", ["gyro", "acc"])
def test_a_broken_sample_is_replaced_by_the_last_good_one(bad: float, name: str) -> None:
    good = {"gyro": Vec3(0.1, 0.2, 0.3), "acc": Vec3(0.0, 0.0, -9.8)}
    ekf = Ekf()
    strapdown.read_imu(ekf, **good)
    strapdown.read_imu(ekf, **{**good, name: good[name].replace(y=bad)})
    assert ekf.bad_imu == 1
    assert ekf.good_gyro == pytest.approx([0.1, 0.2, 0.3])
    assert ekf.good_acc == pytest.approx([0, 0, -9.8])


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5))
def test_tilt_from_specific_force(roll: float, pitch: float) -> None:
    f = Vec3(math.sin(pitch), -math.sin(roll) * math.cos(pitch), -math.cos(roll) * math.cos(pitch))
    assert strapdown.tilt_from_acc(f) == pytest.approx((roll, pitch, 0.0), abs=1e-9)
