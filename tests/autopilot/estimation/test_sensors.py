# SPDX-License-Identifier: BSD-3-Clause
"""Barometer, magnetometer and GPS messages: conversions, checks, origin."""

from __future__ import annotations

import math

import pytest

from sitl.autopilot.estimation import aiding, barometer, gps, magnetometer
from sitl.autopilot.estimation.state import Ekf
from sitl.autopilot.params.estimator import Ekf3
from sitl.autopilot.state import Sensors
from sitl.core.algebra import IDENTITY


def _fix() -> Sensors:
    s = Sensors()
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
    ekf, sensors = Ekf(), Sensors()
    sensors.baro_count, sensors.abs_pressure = 1, bad
    barometer.read(ekf, sensors)
    assert ekf.baro_n == 0 and ekf.baro_seen == 1


@pytest.mark.parametrize("bad", [(float("nan"), 0.2, 0.3), (0.2, float("inf"), 0), (0, 0, 0), (5.0, 0, 0)])
def test_broken_field_is_passed_over(bad) -> None:
    ekf, sensors = Ekf(), Sensors()
    sensors.mag_count, sensors.mag = 1, bad
    magnetometer.read(ekf, sensors)
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
def test_a_fix_with_figures_that_make_no_sense_is_refused(name: str, value) -> None:
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
    aiding.place_origin(ap.ekf, ap.estimate, ap.events, aiding.Origin(-353632620, 1491652370, 584.0))
    assert 2 * math.atan2(ap.ekf.q.z, ap.ekf.q.w) == pytest.approx(ap.ekf.declination)
    assert ap.estimate.reset_yaw == pytest.approx(ap.ekf.declination)
    assert ap.estimate.reset_yaw_count == 1
