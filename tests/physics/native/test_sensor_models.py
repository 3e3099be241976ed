# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest
from pytest import approx

from sitl.core.geodesy import METRES_PER_DEGE7
from sitl.core.rng import Rng, seed
from sitl.core.vectors import Vec3
from sitl.physics.native.records import Body, Derived, GpsReceiver, SensorState
from sitl.physics.native.sensors import barometer, gps, imu, magnetometer
from sitl.physics.native.tick import Clock
from sitl.vehicles.properties.body import Sensors


def samples(rig, sample, field, count):
    out = np.empty((count, 3))
    for k in range(count):
        sample(rig.p, rig.v.sensors, rig.v.rng)
        out[k] = rig.v.sensors[field]
    return out


def test_imu_noise_has_its_density_and_biases(rig):
    r = rig("erle_copter", acc_scale_error=0.0)
    acc = samples(r, imu.sample, "acc", 1000)
    assert acc.std(axis=0) == approx([0.004 * 20.0] * 3, rel=0.1)
    assert acc.mean(axis=0) == approx(np.array([0.0, 0.0, -9.80665]) + r.p.sensors.acc_bias, abs=0.01)
    gyro = samples(r, imu.sample, "gyro", 1000)
    assert gyro.std(axis=0) == approx([3.394e-4 * 20.0] * 3, rel=0.1)
    assert gyro.mean(axis=0) == approx(r.p.sensors.gyro_bias, abs=1e-3)


def test_turn_on_biases_differ_by_seed_with_their_deviation(rig):
    biases = np.array([rig("erle_copter", seed=s).p.sensors.gyro_bias for s in range(60)])
    assert biases.std() == approx(0.0087, rel=0.15)


def test_in_run_bias_settles_at_its_deviation(rig):
    r = rig("erle_copter", acc_bias_time=1.0)
    values = np.empty((3000, 3))
    for k in range(len(values)):
        imu.walk(r.p.sensors, r.p.derived, r.v.rng)
        values[k] = r.p.sensors.acc_walk
    assert values[100:].std() == approx(0.006 * math.sqrt(0.5), rel=0.1)


def test_imu_saturates(rig):
    r = rig("erle_copter")
    r.p.body.specific_force = (1000.0, -1000.0, 0.0)
    imu.sample(r.p, r.v.sensors, r.v.rng)
    assert r.v.sensors.acc[:2] == (176.0, -176.0)


def test_noise_scale_zero_is_the_truth(rig):
    r = rig("erle_copter", noise_scale=0.0)
    r.step(3)
    s = r.v.sensors
    assert list(s.acc) == approx([0.0, 0.0, -9.80665], abs=1e-6)
    assert list(s.gyro) == [0.0, 0.0, 0.0]
    assert list(s.mag) == approx(r.p.origin.field, abs=1e-7)


def test_the_gyros_of_ardupilots_airframes_drift_and_come_back(rig):
    """SIM_DRIFT_SPEED 0.05 deg/s a minute on all axes, for SIM_DRIFT_TIME 5 minutes, then back."""
    r = rig()
    a, s = r.p.airframe, r.p.sensors
    for tick in range(0, 240_000, imu.WALK_TICKS):
        imu.drift(s, a, tick)
        if tick == 120_000 - imu.WALK_TICKS:
            assert list(s.gyro_walk) == approx([math.radians(0.25)] * 3, rel=1e-3)
    assert list(s.gyro_walk) == approx([0.0] * 3, abs=1e-9)
    a.gyro_drift_speed = 0.0
    imu.drift(s, a, 0)
    assert list(s.gyro_walk) == approx([0.0] * 3, abs=1e-9)


def test_gps_is_late_by_its_delay_and_comes_at_its_rate(rig):
    r = rig(gps_fix_time=0.01, gps_start=0.01)
    p, s = r.p, r.v.sensors
    arrivals = []
    for tick in range(1, 400):
        p.body.pos = p.body.pos.replace(x=0.0025 * tick * 10.0)  # 10 m/s north
        before = int(s.gps_count)
        gps.sample(p, s, Clock(tick, tick * 2500), r.v.rng)
        if s.gps_count != before:
            arrivals.append(tick)
            north = (int(s.gps_lat) - int(p.origin.lat)) * METRES_PER_DEGE7
            then = tick - 53  # 132.5 ms ago
            assert north == approx(0.0025 * then * 10.0, abs=0.006)  # steps of 1e-7 degree
            assert s.gps_time_us == tick * 2500
    assert np.diff(arrivals).tolist() == [80] * (len(arrivals) - 1)


def test_a_late_receiver_takes_no_more_fixes_than_can_be_on_their_way(rig):
    """Ten a second, each a second old: eight of them arrive, and later ones as well."""
    r = rig(gps_rate=10.0, gps_fix_time=0.01, gps_start=0.1)
    p, s = r.p, r.v.sensors
    p.sensors.gps[0].fault.is_on, p.sensors.gps[0].fault.delay = True, 400
    arrivals = []
    for tick in range(1, 2001):
        p.body.pos = p.body.pos.replace(x=0.0025 * tick * 10.0)  # 10 m/s north
        before = int(s.gps_count)
        gps.sample(p, s, Clock(tick, tick * 2500), r.v.rng)
        if s.gps_count != before:
            arrivals.append(tick)
            north = (int(s.gps_lat) - int(p.origin.lat)) * METRES_PER_DEGE7
            assert north == approx(0.0025 * (tick - 400) * 10.0, abs=0.006)
    assert 26 <= len(arrivals) <= 36 and np.diff(arrivals).max() <= 160


def test_gps_has_no_fix_at_first(rig):
    r = rig("erle_copter", gps_start=0.0025, gps_fix_time=1.0)
    p, s = r.p, r.v.sensors
    fixes = {}
    for tick in range(1, 600):
        gps.sample(p, s, Clock(tick, tick * 2500), r.v.rng)
        fixes[tick] = int(s.gps_fix)
    assert fixes[40] == 0 and fixes[60] == 1 and fixes[400] == 1 and fixes[599] == 3
    assert s.gps_eph == 80 and s.gps_satellites == 12
    assert s.gps_alt == approx(584000, abs=4000)


def test_gps_errors_have_their_deviation(rig):
    r = rig("erle_copter", gps_fix_time=0.1, gps_drift_horizontal=0.0, gps_drift_vertical=0.0)
    rows = []
    for k in range(600):
        gps.take(r.p, r.p.sensors.gps[0], 10_000 + k, r.v.rng)
        gps.deliver(r.p.sensors.gps[0], r.v.sensors, Clock(20_000 + k, 0), r.p.airframe)
        s = r.v.sensors
        north = (int(s.gps_lat) - int(r.p.origin.lat)) * METRES_PER_DEGE7
        rows.append((north, s.gps_alt / 1e3 - 584.0, *s.gps_vel))
    north, up, *velocity = np.array(rows).std(axis=0)
    assert (north, up) == approx((0.10, 0.20), rel=0.12)
    assert velocity == approx([5.0, 5.0, 8.0], rel=0.12)  # [cm/s]


def test_barometer_shows_the_standard_atmosphere(rig):
    r = rig("erle_copter", baro_drift=0.0)
    r.p.body.pos = r.p.body.pos.replace(z=-100.0)
    values = np.empty(800)
    for k in range(len(values)):
        barometer.sample(r.p, r.v.sensors, r.v.rng)
        values[k] = r.v.sensors.abs_pressure
    assert values.mean() == approx(1013.25 * (1.0 - 684.0 / 44330.8) ** 5.25588, abs=0.005)  # ISA at 684 m
    assert values.std() == approx(0.015, rel=0.12)
    assert r.v.sensors.temperature == approx(15.0 - 0.0065 * 684.0, abs=1e-5)


@pytest.mark.parametrize("heading", [0.0, 90.0, 217.0])
def test_magnetometer_shows_heading_and_declination(rig, heading):
    r = rig(heading=heading, mag_noise=0.0)
    magnetometer.sample(r.p, r.v.sensors, r.v.rng, 0)
    x, y, z = list(r.v.sensors.mag)
    magnetic = math.degrees(math.atan2(-y, x)) % 360.0
    assert (heading - magnetic) % 360.0 == approx(12.8, abs=0.3)  # ArduPilot's COMPASS_DEC there: 12.80 deg
    assert math.sqrt(x * x + y * y + z * z) == approx(0.58, abs=0.01)
    assert z < 0.0  # southern hemisphere: the field points up


def test_sensor_rates(rig):
    r = rig()
    r.step(160)
    assert r.v.sensors.mag_count == 1 + 160 // 5
    assert r.v.sensors.baro_count == 1 + 160 // 8
    assert r.v.sensors.time_us == 400_000 == r.v.time_us


def test_without_errors_a_sensor_shows_the_truth():
    rng = Rng()
    seed(rng, 1)  # of zeros only it would give zeros for ever
    one, none, truth = Vec3(1.0, 1.0, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.0, -2.0, 3.0)
    assert imu.measure(truth, one, none, none) == truth
    assert imu.measure(truth, 2.0 * one, one, none) == 2.0 * truth + one
    body = Body()
    body.pos, body.vel = truth, 2.0 * truth
    assert gps.measure(GpsReceiver(), body, Sensors(), Derived(), rng) == (truth, 2.0 * truth)
    assert barometer.pressure_error(SensorState(), Sensors(), Derived(), rng) == 0.0


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_range_bounds_all_but_nan(bad):
    x, y, z = imu.saturate(Vec3(5.0, -5.0, bad), 3.0)
    assert (x, y) == (3.0, -3.0)
    assert math.isnan(z) if math.isnan(bad) else z == 3.0


def test_a_broken_accelerometer_shows_its_bias(rig):
    r = rig("erle_copter", noise_scale=0.0)
    r.p.sensors.imus_faulty = True
    r.p.sensors.imus[0].acc_bias = Vec3(1.0, -2.0, 3.0)
    imu.sample(r.p, r.v.sensors, r.v.rng)
    assert list(r.v.sensors.acc) == approx([1.0, -2.0, 3.0 - 9.80665], abs=1e-6)


def test_a_vehicle_without_barometer_gets_no_samples(rig):
    r = rig()
    before = r.v.sensors.baro_count
    r.p.sensors.baro_missing = True
    r.step(40)
    assert r.v.sensors.baro_count == before


def test_more_compasses_differ_by_their_offsets_alone(rig):
    r = rig()
    r.p.sensors.irons[1].hard, r.p.sensors.irons[2].hard = Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.0, -0.2)
    magnetometer.sample(r.p, r.v.sensors, r.v.rng, 0)
    first = np.array(r.v.sensors.mag)
    assert np.array(r.v.sensors.mag2) - first == approx([-0.1, 0.0, 0.0], abs=1e-6)
    assert np.array(r.v.sensors.mag3) - first == approx([0.0, 0.0, 0.2], abs=1e-6)


def jammed(rig, ticks):
    """Fixes of a receiver at rest that is jammed: type, distance from where it is [m], speed [m/s], HDOP."""
    r = rig(gps_fix_time=0.01, gps_start=0.01)
    r.step(400)
    r.p.sensors.gps[0].jammed = True
    s, seen, out = r.v.sensors, r.v.sensors.gps_count, []
    for _ in range(ticks):
        r.step(1)
        if s.gps_count != seen:
            seen = s.gps_count
            north = 1e-7 * s.gps_lat - HOME_LAT
            speed = math.hypot(s.gps_vel.x, s.gps_vel.y) * 0.01
            out.append((s.gps_fix, abs(math.radians(north)) * 6371000.0, speed, 0.01 * s.gps_eph, s.gps_satellites))
    return r, out


HOME_LAT = -35.363262


def test_a_jammed_receiver_falls_silent_and_then_shows_anything(rig):
    _, fixes = jammed(rig, 16000)
    begins = next(k for k, fix in enumerate(fixes) if fix[0] < 3)
    silent = next(k for k, fix in enumerate(fixes) if k > begins and fix[4] > 0)
    assert begins < 4 and silent - begins >= 5 and all(fix[0] < 3 for fix in fixes[begins:silent])
    wrong = [fix for fix in fixes[silent:] if fix[0] == 3]
    assert max(fix[1] for fix in wrong) > 100.0 and max(fix[2] for fix in wrong) > 100.0
    assert max(fix[3] for fix in wrong) > 410.0, "v_acc is beyond 50 m, vel_acc beyond 30 m/s"
    assert min(fix[4] for fix in fixes[silent:]) < 6


def test_after_jamming_the_receiver_shows_where_it_is(rig):
    r, _ = jammed(rig, 8000)
    r.p.sensors.gps[0].jammed = False
    r.step(800)
    s = r.v.sensors
    assert s.gps_fix == 6 and abs(1e-7 * s.gps_lat - HOME_LAT) < 1e-4 and abs(s.gps_vel.x) < 100
    assert s.gps_satellites == int(r.p.airframe.gps_satellites)
