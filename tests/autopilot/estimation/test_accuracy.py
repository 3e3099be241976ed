# SPDX-License-Identifier: BSD-3-Clause
"""Accuracy and consistency through a flight with the default sensors' errors."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.autopilot.estimation import status, update
from sitl.autopilot.estimation.estimator_events import (
    EKF_INITIALISED,
    EKF_ORIGIN_SET,
    EKF_TILT_ALIGNED,
    EKF_USES_GPS,
    EKF_YAW_ALIGNED,
    EKF_YAW_ALIGNED_IN_FLIGHT,
)
from sitl.core.kernels import jit_disabled
from sitl.core.records import first_difference
from tests.autopilot.estimation import synthetic_flight as sf
from tests.autopilot.estimation.synthetic_flight import TAKE_OFF


def _in_air(truth: sf.Truth) -> np.ndarray:
    return truth.t > TAKE_OFF


def test_position_within_one_metre(flown, truth) -> None:
    """RMS over the flights; one alone is as good as its GPS, whose slow error nothing on board can see."""
    squares = []
    for fleet, out in flown:
        error = (out["pos"] - sf.true_position(fleet, truth))[_in_air(truth)]
        squares.append(sf.rms(error) ** 2)
        assert sf.rms(error) < 1.5
        assert sf.rms(error[:, 2]) < 0.15
    assert np.sqrt(np.mean(squares)) < 1.0


def test_position_within_two_decimetres_of_a_gps_without_slow_error(truth, tick) -> None:
    fleet = sf.new()
    out = sf.play(sf.sense(truth, TAKE_OFF, 5, sf.Noise(gps_slow=0.0)), fleet, tick)
    assert sf.rms((out["pos"] - sf.true_position(fleet, truth))[_in_air(truth)]) < 0.2


def test_velocity_within_a_decimetre_per_second(flown, truth) -> None:
    for _, out in flown:
        assert sf.rms((out["vel"] - truth.vel)[_in_air(truth)]) < 0.1


def test_attitude_within_one_degree(flown, truth) -> None:
    for _, out in flown:
        error = np.degrees(sf.attitude_error(out["q"], truth.q))[_in_air(truth)]
        assert sf.rms(error) < 1.0
        assert sf.rms(error[-20000:]) < 0.3  # the last 50 s: biases are known by then


def test_rates_and_acceleration_follow_every_tick(flown, truth) -> None:
    m = _in_air(truth)
    acceleration = np.gradient(truth.vel, sf.DT, axis=0)
    for _, out in flown:
        # white noise of the sensors at 400 Hz, not more: 3.4e-4 sqrt(400) and 0.004 sqrt(400) an axis
        assert sf.rms((out["rates"] - truth.rates)[m]) < 0.015
        assert sf.rms((out["acc_ned"] - acceleration)[m]) < 0.25


def test_euler_angles_are_those_of_the_quaternion(flown) -> None:
    for _, out in flown:
        w, x, y, z = out["q"][-1]
        assert np.isclose(out["euler"][-1][2], np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def test_innovations_agree_with_their_covariances(flown) -> None:
    """Mean normalised innovation squared about 1 for GPS position, GPS velocity, barometer, magnetometer."""
    total, count = np.zeros(4), np.zeros(4)
    for fleet, _ in flown:
        total += fleet[0]["autopilot"]["ekf"]["nis_sum"]
        count += fleet[0]["autopilot"]["ekf"]["nis_count"]
    assert np.all(count > 1000)
    assert np.all(total / count > 0.75), total / count
    assert np.all(total / count < 1.25), total / count


def test_attitude_errors_agree_with_their_covariance(flown, truth) -> None:
    """Normalised error squared of attitude and velocity at the end of the flights."""
    values = []
    for fleet, out in flown:
        P = fleet[0]["autopilot"]["ekf"]["P"]
        d = sf.multiply(truth.q[-1:], out["q"][-1:] * [1, -1, -1, -1])[0]
        theta = 2.0 * np.sign(d[0]) * d[1:]
        values.append(theta @ np.linalg.solve(P[:3, :3], theta) / 3)
        v = truth.vel[-1] - out["vel"][-1]
        values.append(v @ np.linalg.solve(P[3:6, 3:6], v) / 3)
    assert 0.05 < np.mean(values) < 4.0


def test_covariance_is_symmetric_and_positive(flown) -> None:
    for fleet, _ in flown:
        P = fleet[0]["autopilot"]["ekf"]["P"]
        assert np.array_equal(P, P.T) or np.allclose(P, P.T, rtol=0, atol=1e-12)
        d = 1 / np.sqrt(np.diag(P))
        assert np.linalg.eigvalsh(P * np.outer(d, d)).min() > -1e-9


def test_boot_takes_the_time_of_a_real_one(flown) -> None:
    """Seconds after boot in the recording of ArduPilot's SITL."""
    expected = {
        EKF_INITIALISED: 4.44,
        EKF_TILT_ALIGNED: 5.80,
        EKF_YAW_ALIGNED: 5.88,
        EKF_ORIGIN_SET: 20.0,
        EKF_USES_GPS: 41.6,
    }
    for fleet, _ in flown:
        times = {code: t for t, code in sf.events(fleet)}
        for code, t in expected.items():
            assert abs(times[code] - t) < 0.5, (code, times[code])
        assert TAKE_OFF < times[EKF_YAW_ALIGNED_IN_FLIGHT] < TAKE_OFF + 5


def test_status_after_the_flight(flown) -> None:
    for fleet, _ in flown:
        e = fleet[0]["autopilot"]["estimate"]
        assert e["status_flags"] == 831  # as ArduPilot reports with GPS in use
        assert (e["attitude_ok"], e["position_ok"], e["origin_set"]) == (1, 1, 1)
        assert abs(e["origin_alt"] - sf.ALT) < 2.0
        assert e["reset_ne_count"] == 1  # from holding the position to GPS
        for name in ("vel", "pos", "hgt", "mag"):
            assert 0 <= e[f"variance_{name}"] < 0.3
        assert np.all(np.abs(e["gyro_bias"]) > 0)


def test_flags_before_gps(truth, tick) -> None:
    fleet = sf.new()
    flight = sf.sense(sf.fly(15.0, 99.0), 99.0, 0)
    sf.play(flight, fleet, tick)
    flags = fleet[0]["autopilot"]["estimate"]["status_flags"]
    assert flags == status.ATTITUDE | status.VELOCITY_VERT | status.POS_VERT_ABS | status.CONST_POS_MODE
    assert fleet[0]["autopilot"]["estimate"]["position_ok"] == 0


@pytest.mark.skipif(jit_disabled(), reason="nothing is compiled")
def test_plain_python_agrees_with_compiled(tick) -> None:
    """A second of flight with all sensors, from the same record."""
    truth = sf.fly(57.0, 50.0)
    flight = sf.sense(truth, 50.0, 1)
    compiled = sf.new()
    plain = None
    n = len(truth.t)
    for k in range(n):
        sf.load_tick(compiled[0]["sensors"], flight, k)
        compiled["time_us"] = 2500 * (k + 1)
        compiled["autopilot"]["arming"]["armed"] = 1 if truth.t[k] > 50 else 0
        if k == n - 400:
            plain = compiled.copy()
        elif k > n - 400:
            plain["sensors"], plain["time_us"] = compiled["sensors"], compiled["time_us"]
        tick(compiled)
        if plain is not None:
            update.update({0: sf.Copter.of(plain, 0)}, 0)
    assert plain is not None
    difference = first_difference(plain[0], compiled[0])
    assert difference is None
