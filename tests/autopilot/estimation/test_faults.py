# SPDX-License-Identifier: BSD-3-Clause
"""Broken, missing and lying sensors: the estimate stays finite and bounded, and comes back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sitl.autopilot.estimation import status
from sitl.autopilot.estimation.estimator_events import EKF_INITIALISED, EKF_STOPPED_GPS, EKF_USES_GPS
from tests.autopilot.estimation import synthetic_flight as sf
from tests.autopilot.estimation.synthetic_flight import TAKE_OFF


def _seconds(k: int) -> float:
    return k * sf.DT


def _no_gps(first: float, last: float):
    def spoil(k, sensors):
        if first <= _seconds(k) < last:
            sensors["gps_count"] = spoil.count
        else:
            spoil.count = int(sensors["gps_count"])

    spoil.count = 0
    return spoil


def test_without_gps_from_the_start_it_holds_its_place(tick) -> None:
    fleet = sf.new()
    truth = sf.fly(60.0, 99.0)
    out = sf.play(sf.sense(truth, 99.0, 1), fleet, tick, _no_gps(0.0, 99.0))
    e = fleet[0]["autopilot"]["estimate"]
    assert e["attitude_ok"] == 1 and e["position_ok"] == 0
    assert e["status_flags"] & status.CONST_POS_MODE
    assert np.abs(out["pos"]).max() < 0.5 and np.abs(out["vel"]).max() < 0.3
    assert np.degrees(np.abs(out["euler"][-1, :2])).max() < 1.0


def test_loss_and_return_of_gps(truth, tick) -> None:
    """Dead reckoning for 7 s, then no position; 15 s: position held; a second of fixes brings it back."""
    fleet = sf.new()
    log: dict[float, tuple[int, int]] = {}
    spoil_gps = _no_gps(90.0, 115.0)

    def spoil(k, sensors):
        spoil_gps(k, sensors)
        if k % 400 == 0:
            e = fleet[0]["autopilot"]["estimate"]
            log[_seconds(k)] = (int(e["position_ok"]), int(e["status_flags"]))

    out = sf.play(sf.sense(truth, TAKE_OFF, 2), fleet, tick, spoil)
    assert log[96.0][0] == 1 and log[98.0][0] == 0
    assert not log[104.0][1] & status.CONST_POS_MODE and log[106.0][1] & status.CONST_POS_MODE
    assert log[114.0][0] == 0 and log[118.0][0] == 1
    codes = [code for _, code in sf.events(fleet)]
    assert codes.count(EKF_STOPPED_GPS) == 1 and codes.count(EKF_USES_GPS) == 2
    e = fleet[0]["autopilot"]["estimate"]
    assert e["reset_ne_count"] == 3 and np.linalg.norm(e["reset_pos"][:2]) > 0.1
    k = int(96.0 / sf.DT)
    assert np.linalg.norm((out["pos"] - sf.true_position(fleet, truth))[k]) < 3.0
    late = truth.t > 125.0
    assert sf.rms((out["pos"] - sf.true_position(fleet, truth))[late]) < 1.5
    assert sf.rms(np.degrees(sf.attitude_error(out["q"], truth.q))[late]) < 2.0


def test_a_gps_glitch_is_gated_then_followed(truth, tick) -> None:
    fleet = sf.new()
    moved: dict[float, float] = {}
    flags: dict[float, int] = {}

    def spoil(k, sensors):
        if _seconds(k) >= 80.0 and k in flight.fixes:
            sensors["gps_lat"] += 5000  # 55 m north
        if k % 400 == 0:
            e = fleet[0]["autopilot"]["estimate"]
            moved[_seconds(k)] = float(e["pos"][0] - truth.pos[k, 0])
            flags[_seconds(k)] = int(e["status_flags"])

    flight = sf.sense(truth, TAKE_OFF, 3)
    sf.play(flight, fleet, tick, spoil)
    assert abs(moved[88.0]) < 3.0 and flags[88.0] & status.GPS_GLITCHING
    assert moved[95.0] == pytest.approx(55.0, abs=4.0) and flags[95.0] & status.GPS_GLITCHING
    assert not flags[102.0] & status.GPS_GLITCHING, "ten seconds later"
    assert fleet[0]["autopilot"]["estimate"]["reset_ne_count"] == 2


def test_moving_at_power_on_delays_the_calibration(tick) -> None:
    fleet = sf.new()

    def spoil(k, sensors):
        if 2.0 < _seconds(k) < 6.0:
            sensors["gyro"][0] += 0.3 * np.sin(3.0 * _seconds(k))

    sf.play(sf.sense(sf.fly(15.0, 99.0), 99.0, 1), fleet, tick, spoil)
    when = next(t for t, code in sf.events(fleet) if code == EKF_INITIALISED)
    assert 10.0 <= when < 10.5


def test_lost_health_begins_anew_and_recovers(truth, tick) -> None:
    fleet = sf.new()

    def spoil(k, sensors):
        if k == int(100.0 / sf.DT):
            fleet[0]["autopilot"]["ekf"]["vel"][0] = np.nan

    out = sf.play(sf.sense(truth, TAKE_OFF, 1), fleet, tick, spoil)
    assert fleet[0]["autopilot"]["ekf"]["resets"] == 1
    late = truth.t > 130.0
    assert np.all(np.isfinite(out["pos"][late]))
    assert fleet[0]["autopilot"]["estimate"]["position_ok"] == 1
    assert sf.rms(np.degrees(sf.attitude_error(out["q"], truth.q))[late]) < 3.0


def test_an_external_estimator_is_left_alone(tick) -> None:
    fleet = sf.new()
    fleet[0]["autopilot"]["ekf"]["use_external"] = 1
    before = fleet["autopilot"]["estimate"].tobytes()
    sf.play(sf.sense(sf.fly(1.0, 99.0), 99.0, 1), fleet, tick)
    assert fleet["autopilot"]["estimate"].tobytes() == before


WILD = st.one_of(st.floats(width=32), st.sampled_from([np.nan, np.inf, -np.inf, 0.0, 1e3, -1e3, 3e38]))
FIELDS = ("gyro", "acc", "mag", "abs_pressure", "gps_lat", "gps_lon", "gps_alt", "gps_vel", "gps_fix")
FAULT = st.tuples(
    st.sampled_from(FIELDS),
    st.integers(0, 2),
    WILD,
    st.floats(0.0, 60.0),  # from [s]
    st.floats(0.0025, 3.0),  # for [s]
)


@pytest.mark.slow
@given(st.lists(FAULT, min_size=1, max_size=6))
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
def test_whatever_the_sensors_say_the_estimate_is_finite(tick, faults) -> None:
    fleet = sf.new()
    truth = sf.fly(62.0, TAKE_OFF)

    def spoil(k, sensors):
        t = _seconds(k)
        for name, axis, value, start, span in faults:
            if start <= t < start + span:
                whole = sensors.dtype[name].base.kind == "i"
                x = int(np.clip(np.nan_to_num(value), -(2**31), 2**31 - 1)) if whole else value
                if sensors.dtype[name].shape:
                    sensors[name][axis] = x
                else:
                    sensors[name] = x

    with np.errstate(all="ignore"):
        out = sf.play(sf.sense(truth, TAKE_OFF, 1), fleet, tick, spoil)
    for name in sf.KEPT:
        assert np.all(np.isfinite(out[name])), name
    assert np.allclose(np.linalg.norm(out["q"], axis=1), 1.0, atol=1e-6)
    ekf = fleet[0]["autopilot"]["ekf"]
    P, d = ekf["P"], np.sqrt(np.diag(ekf["P"]))
    if ekf["phase"] > 0:
        assert np.allclose(P, P.T, atol=1e-9 * np.outer(d, d))
        assert np.linalg.eigvalsh(P / np.outer(d, d)).min() > -1e-6
    assert np.all(np.abs(ekf["gyro_bias"]) <= 0.2) and np.all(np.abs(ekf["acc_bias"]) <= 1.0)
