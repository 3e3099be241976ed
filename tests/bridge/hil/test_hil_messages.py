# SPDX-License-Identifier: BSD-3-Clause
"""From a record to messages and back: the same bits."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl.bridge.frame import Splitter
from sitl.bridge.hil import controls, measurements, ranging, rc_inputs, sensor, truth
from sitl.bridge.hil.measurements import Inbox, Measurements
from sitl.bridge.hil.protocol import RefusedError
from sitl.core.record_reader import RecordReader
from sitl.core.records import first_difference
from sitl.physics.carried import Carried
from sitl.vehicle.kinds import KINDS
from sitl.vehicles import apply, load
from sitl.vehicles.receivers import equipped
from tests.bridge.hil.hil_bench import Vehicle

single = st.floats(-90.0, 90.0, width=32)


def reader(vehicle: Vehicle) -> RecordReader:
    return RecordReader(vehicle.fleet, vehicle.index)


def across(source: Vehicle, is_all: bool = True) -> Vehicle:
    """A vehicle that has taken all that ``source`` measures."""
    other = Vehicle()
    inbox = Inbox(other.fleet, other.index, other.v)
    *kept, last = Splitter().feed(Measurements(source.fleet, source.index, source.v).everything())
    for frame in kept:
        inbox.keep(frame.kind.id, frame.payload)
    values = inbox.end(last.payload)
    assert values is not None
    inbox.take(values, is_all)
    return other


@given(st.lists(single, min_size=9, max_size=9), st.floats(300.0, 1100.0, width=32), st.integers(0, 1 << 40))
def test_imu_and_clock(values: list[float], pressure: float, tick: int) -> None:
    source = Vehicle()
    v, s = source.v, source.v.sensors
    v.time_us = s.time_us = 2500 * tick
    v.tick = tick
    s.acc, s.gyro, s.mag, s.abs_pressure, s.temperature = values[:3], values[3:6], values[6:], pressure, -3.25
    s.mag_count = s.baro_count = 1
    other = across(source)
    assert first_difference(other.fleet[1]["sensors"], source.fleet[1]["sensors"]) is None
    assert other.v.time_us == v.time_us and other.v.tick == tick


def test_what_has_no_noise_changes_for_px4_and_stays_for_ours() -> None:
    source = Vehicle()
    s = source.v.sensors
    s.mag, s.abs_pressure = (0.2, 0.0, 0.4), 950.0
    writer, seen = sensor.SensorWriter(reader(source)), []
    for is_dithered in (False, True):
        writer.is_dithered = is_dithered
        for _ in range(4):
            s.mag_count += 1
            s.baro_count += 1
            fields = sensor.SENSOR_KIND.decode(writer.payload())
            seen.append((fields.xmag, fields.abs_pressure))
    assert len(set(seen[:4])) == 1 and all(a[0] != b[0] and a[1] != b[1] for a, b in pairwise(seen[4:]))
    assert all(abs(mag - 0.2) < 2e-5 and abs(pressure - 950.0) < 2e-3 for mag, pressure in seen)


def test_updated_flags_follow_the_counters() -> None:
    source = Vehicle()
    writer = sensor.SensorWriter(reader(source))
    flags = []
    for mag, baro in ((1, 1), (1, 1), (2, 1), (2, 2)):
        source.v.sensors.mag_count, source.v.sensors.baro_count = mag, baro
        flags.append(sensor.SensorReader.read(writer.payload())[14])
    assert flags == [0x1BFF, 0x3F, 0x1FF, 0x1A3F]


LIMITS = {
    "xacc": 5000.0, "yacc": 5000.0, "zacc": 5000.0, "xgyro": 500.0, "ygyro": 500.0, "zgyro": 500.0, "xmag": 100.0,
    "ymag": 100.0, "zmag": 100.0, "abs_pressure": 2000.0, "diff_pressure": 2000.0, "pressure_alt": 100_000.0,
    "temperature": 300.0,
}  # fmt: skip
"""Of HIL_SENSOR, in its units: no sensor shows so much."""


@pytest.mark.parametrize(("field", "limit"), LIMITS.items())
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_no_sensor_shows_is_refused_by_its_name(field: str, limit: float, sign: float) -> None:
    below = float(np.nextafter(np.float32(limit), np.float32(0.0)))
    sensor.SensorReader.read(sensor.SENSOR_KIND.payload(**{field: sign * below}))
    for value in (sign * limit, sign * math.inf, math.nan):
        with pytest.raises(RefusedError, match=rf"HIL_SENSOR\.{field} = .*less than {limit:g} in size"):
            sensor.SensorReader.read(sensor.SENSOR_KIND.payload(**{field: value}))


@pytest.mark.parametrize("k", [0, 7, 15])
def test_controls_are_less_than_ten_in_size(k: int) -> None:
    for sign in (1.0, -1.0):
        values = [0.0] * 16
        values[k] = sign * float(np.nextafter(np.float32(10.0), np.float32(0.0)))
        assert controls.read_controls(controls.KIND.payload(controls=values)).outputs[k] == values[k]
        for value in (sign * 10.0, sign * math.inf, math.nan):
            values[k] = value
            with pytest.raises(RefusedError, match=rf"controls\[{k}\] = "):
                controls.read_controls(controls.KIND.payload(controls=values))


@pytest.mark.parametrize("kind", ["sensor", "controls", "gps", "sticks"])
def test_a_clock_does_not_go_to_the_end_of_its_numbers(kind: str) -> None:
    title, read = {
        "sensor": (sensor.SENSOR_KIND, sensor.SensorReader.read),
        "controls": (controls.KIND, controls.read_controls),
        "gps": (measurements.GPS_KIND, measurements.GpsReader.read),
        "sticks": (rc_inputs.KIND, rc_inputs.SticksReader.read),
    }[kind]
    read(title.payload(time_usec=(1 << 62) - 1))
    with pytest.raises(RefusedError, match=f"time_usec.* {1 << 62}"):
        read(title.payload(time_usec=1 << 62))


@pytest.mark.parametrize(
    ("fields", "taken"),
    [
        ({"lat": 900_000_000, "lon": 1_800_000_000}, True), ({"lat": -900_000_000, "lon": -1_800_000_000}, True),
        ({"lat": 900_000_001}, False), ({"lat": -900_000_001}, False), ({"lon": 1_800_000_001}, False),
        ({"lon": -1_800_000_001}, False), ({"fix_type": 8}, True), ({"fix_type": 9}, False),
    ],
)  # fmt: skip
def test_a_fix_is_on_the_globe_and_of_a_known_type(fields: Any, taken: bool) -> None:
    payload = measurements.GPS_KIND.payload(**fields)
    if taken:
        assert measurements.GpsReader.read(payload)
    else:
        with pytest.raises(RefusedError, match="HIL_GPS"):
            measurements.GpsReader.read(payload)


def test_who_has_just_come_is_told_that_all_samples_are_new() -> None:
    source = Vehicle()
    all_of_it = Measurements(source.fleet, source.index, source.v)
    told = (all_of_it.tick(), all_of_it.everything(), all_of_it.tick())
    flags = [sensor.SensorReader.read(Splitter().feed(frames)[-1].payload)[14] for frames in told]
    assert flags == [0x3F, 0x1BFF, 0x3F]


@given(
    st.integers(-900_000_000, 900_000_000),
    st.integers(-1_800_000_000, 1_800_000_000),
    st.integers(-500_000, 9_000_000),
    st.lists(st.integers(-20_000, 20_000), min_size=3, max_size=3),
    st.sampled_from((1, 3)),
)
def test_gps(lat: int, lon: int, alt: int, velocity: list[int], fix: int) -> None:
    source = Vehicle()
    s = source.v.sensors
    s.gps_count, s.gps_time_us, s.gps_fix, s.gps_satellites = 1, 7500, fix, 10
    s.gps_lat, s.gps_lon, s.gps_alt, s.gps_eph, s.gps_epv = lat, lon, alt, 9999, 150
    s.gps_vel = velocity
    other = across(source)
    assert list(other.v.sensors.gps_vel) == velocity
    for name in ("count", "time_us", "fix", "satellites", "lat", "lon", "alt", "eph", "epv"):
        assert other.v.sensors["gps_" + name] == s["gps_" + name], name


def test_px4_is_told_how_far_off_a_receiver_is_and_ours_its_dilution() -> None:
    """PX4 takes eph and epv of HIL_GPS for standard deviations [cm]."""
    source = Vehicle()
    apply(equipped(load("erle_copter"), "rtk"), source.v)
    s, writer = source.v.sensors, measurements.GpsWriter(reader(source), source.v.physics.airframe)
    told = []
    for is_px4, eph, epv in ((False, 60, 90), (True, 60, 90), (True, 350, 410), (True, 9999, 9999)):
        s.gps_count, s.gps_fix, s.gps_eph, s.gps_epv, writer.is_quiet = 1, 3, eph, epv, is_px4
        fields = measurements.GPS_KIND.decode(writer.payloads()[0])
        told.append((fields.eph, fields.epv))
    assert told == [(60, 90), (1, 1), (350, 410), (9999, 9999)]  # 0.8 cm and 1.5 cm; jammed; without a fix
    gps = measurements.as_accuracy(Vehicle().v.physics.airframe)
    assert gps == (41, 72)


def test_the_same_fix_again_is_not_a_new_one() -> None:
    source, other = Vehicle(), Vehicle()
    airframe = source.v.physics.airframe
    source.v.sensors.gps_count, source.v.sensors.gps_time_us, source.v.sensors.gps_fix = 1, 200_000, 3
    (payload,), taker = measurements.GpsWriter(reader(source), airframe).payloads(), measurements.GpsReader(other.v)
    taker.write(taker.read(payload))
    source.v.sensors.gps_fix = 0  # the receiver is switched off
    taker.write(taker.read(measurements.GpsWriter(reader(source), airframe).payloads()[0]))
    assert other.v.sensors.gps_count == 1 and other.v.sensors.gps_fix == 0


@given(st.integers(0, 400_000), st.integers(0, 32_000))
def test_battery(millivolts: int, centiamperes: int) -> None:
    source = Vehicle()
    s = source.v.sensors
    s.battery_voltage, s.battery_current = 0.001 * millivolts, 0.01 * centiamperes
    t = across(source).v.sensors
    assert (t.battery_voltage, t.battery_current) == (s.battery_voltage, s.battery_current)


def test_a_battery_without_cells_is_refused() -> None:
    with pytest.raises(RefusedError):
        sensor.BatteryReader.read(sensor.BATTERY_KIND.payload(voltages=(65535,) * 10))


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_wheels(left: float, right: float) -> None:
    source = Vehicle()
    source.v.sensors.wheel_count, source.v.sensors.wheel_distance = 1, (left, right)
    other = across(source)
    assert list(other.v.sensors.wheel_distance) == [left, right] and other.v.sensors.wheel_count == 1


@pytest.mark.parametrize("distance", [(math.nan, 0.0), (0.0, math.inf)])
def test_wheels_that_roll_nowhere_are_refused(distance: tuple[float, float]) -> None:
    with pytest.raises(RefusedError, match="distance"):
        sensor.WheelReader.read(sensor.WHEELS_KIND.payload(distance=distance, count=2))


def test_a_whole_scan_and_a_range() -> None:
    source = Vehicle()
    s, samples = source.v.sensors, int(source.v.physics.airframe.lidar_samples)
    assert samples > ranging.PART
    s.lidar_ranges[:samples] = np.linspace(0.1, 9.0, samples)
    s.lidar_ranges[3:7] = np.inf
    s.lidar_count, s.lidar_time_us, s.rangefinder_count, s.rangefinder_range = 1, 25_000, 1, (1.2345678,)
    other = across(source)
    assert (
        first_difference(other.fleet[1]["sensors"]["lidar_ranges"], source.fleet[1]["sensors"]["lidar_ranges"]) is None
    )
    assert other.v.sensors.rangefinder_range[0] == s.rangefinder_range[0]
    assert (other.v.sensors.lidar_count, other.v.sensors.lidar_time_us) == (1, 25_000)
    assert other.v.sensors.rangefinder_count == 1


def test_a_scan_of_another_lidar_is_refused() -> None:
    source = Vehicle()
    taker = ranging.ScanReader(source.v, 100)
    first = ranging.SCAN.payload(name=b"LASER", data=[1.0] * 58, array_id=0)
    taker.read(first)
    for number, data in ((1, [1.0] * 58), (2, [1.0] * 58), (1, [1.0] * 42 + [math.nan] * 15 + [1.0]), (0, [-1.0] * 58)):
        with pytest.raises(RefusedError):
            taker.read(ranging.SCAN.payload(name=b"LASER", data=data, array_id=number))


@pytest.mark.parametrize(("x", "taken"), [(0.0, True), (math.inf, True), (-0.01, False), (math.nan, False)])
def test_a_range_is_no_less_than_nothing(x: float, taken: bool) -> None:
    payload = ranging.VECTOR.payload(name=b"RANGE", x=x)
    if taken:
        assert ranging.RangeReader.read(payload) == x
    else:
        with pytest.raises(RefusedError, match="DEBUG_VECT RANGE: x = "):
            ranging.RangeReader.read(payload)
    assert ranging.RangeReader.read(ranging.VECTOR.payload(name=b"OTHER", x=x)) is None


@pytest.mark.parametrize(("distance", "reading"), [(4999, 49.99), (5000, 50.0), (5001, math.inf)])
def test_a_distance_beyond_the_range_is_infinite(distance: int, reading: float) -> None:
    fields = {"current_distance": distance, "max_distance": 5000}
    assert ranging.DistanceReader.read(ranging.DISTANCE.payload(orientation=25, **fields)) == pytest.approx(reading)
    assert ranging.DistanceReader.read(ranging.DISTANCE.payload(orientation=24, **fields)) is None


def test_a_scan_with_a_part_missing_is_not_shown() -> None:
    source = Vehicle()
    taker = ranging.ScanReader(source.v, 100)
    last = ranging.SCAN.payload(name=b"LASER", data=[1.0] * 42 + [math.nan] * 16, array_id=1)
    taker.write(taker.read(last))  # type: ignore[arg-type]
    assert source.v.sensors.lidar_count == 0


def test_hits_in_this_tick_only() -> None:
    source = Vehicle()
    source.v.time_us = 5000
    ground = source.v.physics.ground
    ground.hit_count, ground.hit_speed, ground.hit_time_us = 3, 1.25, 5000
    other = across(source)
    assert (other.v.physics.ground.hit_count, other.v.physics.ground.hit_speed) == (1, 1.25)
    assert other.v.physics.ground.hit_time_us == 5000
    ground.hit_time_us = 2500
    assert across(source).v.physics.ground.hit_count == 0
    assert truth.HitReader(other.v).read(truth.HITS_KIND.payload(name=b"WHATEVER", x=math.nan)) is None


@given(st.lists(st.floats(-1.0, 1.0, width=32), min_size=16, max_size=16), st.booleans())
def test_controls(outputs: list[float], armed: bool) -> None:
    source, other = Vehicle(), Vehicle()
    source.v.time_us, source.v.actuators.controls, source.v.actuators.armed = 7500, outputs, int(armed)
    given_ = controls.read_controls(controls.controls_writer(reader(source))())
    controls.actuators_writer(other.fleet, other.index)(given_)
    assert given_.time_us == 7500 and given_.is_lockstep and given_.is_armed == armed
    assert other.v.actuators.controls.tobytes() == source.v.actuators.controls.tobytes()
    assert other.v.actuators.armed == armed


@pytest.mark.parametrize(
    ("frame", "lowest", "highest"),
    [("ardupilot_quad", 0.15, 0.95), ("erle_copter", 0.0, 0.838), ("erle_rover", 0.0, 0.8)],
)
def test_parts_of_the_rotors_range(frame: str, lowest: float, highest: float) -> None:
    airframe = load(frame)
    v = KINDS[airframe.kind].record()
    apply(airframe, v)
    span = controls.rotor_range(v.physics.airframe)
    assert span == pytest.approx((lowest, highest))
    given = controls.Controls(1, 1, (0.0, 0.5, 1.0), 129)
    assert controls.stretch(given, *span).outputs == pytest.approx((lowest, 0.5 * (lowest + highest), highest))


def test_an_airframe_without_a_range_has_all_of_it() -> None:
    assert controls.rotor_range(object()) == (0.0, 1.0)


def test_truth() -> None:
    carried = Carried(
        (0.5, 0.5, -0.5, 0.5), (0.25, 0.0, -1.5), -353632620, 1491652370, 584123, (12, -300, 7), (0, 5, -1000)
    )
    assert truth.read_truth(truth.truth_payload(123_000, carried)) == (123_000, carried)
    with pytest.raises(RefusedError, match="attitude x"):
        truth.read_truth(truth.truth_payload(0, carried._replace(attitude=(1.0, math.nan, 0.0, 0.0))))


def test_before_anything_is_known_the_truth_is_at_rest() -> None:
    assert truth.read_truth(truth.truth_payload(0, truth.NOWHERE)) == (0, truth.NOWHERE)
    assert truth.NOWHERE.attitude == (1.0, 0.0, 0.0, 0.0) and not any(truth.NOWHERE.rates + truth.NOWHERE.velocity)


@pytest.mark.parametrize(("field", "limit"), [("rollspeed", 1e3), ("pitchspeed", 1e3), ("yawspeed", 1e3)])
def test_rates_of_a_truth_are_less_than_1000_rad_s(field: str, limit: float) -> None:
    below = float(np.nextafter(np.float32(limit), np.float32(0.0)))
    for sign in (1.0, -1.0):
        assert truth.read_truth(truth.TRUTH_KIND.payload(**{field: sign * below}))
        with pytest.raises(RefusedError, match=f"{field} = "):
            truth.read_truth(truth.TRUTH_KIND.payload(**{field: sign * limit}))


@pytest.mark.parametrize("k", range(4))
def test_parts_of_an_attitude_are_hardly_above_1(k: int) -> None:
    for part, taken in ((1.09, True), (-1.09, True), (1.11, False), (-1.11, False)):
        attitude = [0.0] * 4
        attitude[k] = part
        payload = truth.TRUTH_KIND.payload(attitude_quaternion=attitude)
        if taken:
            assert truth.read_truth(payload)[1].attitude[k] == pytest.approx(part)
        else:
            with pytest.raises(RefusedError, match=f"attitude {'wxyz'[k]}"):
                truth.read_truth(payload)


def test_a_touch_is_slower_than_10_km_s_and_has_a_time() -> None:
    taker = truth.HitReader(Vehicle().v)
    for name, x in ((b"HITGROUND", 9999.0), (b"HITSOLID", -9999.0)):
        assert taker.read(truth.HITS_KIND.payload(name=name, x=x, time_usec=7)) == (7, x, name.decode())
        for bad in (1e4, -1e4, math.nan):
            with pytest.raises(RefusedError, match=r"DEBUG_VECT\.x"):
                taker.read(truth.HITS_KIND.payload(name=name, x=bad))
    with pytest.raises(RefusedError, match="time_usec"):
        taker.read(truth.HITS_KIND.payload(name=b"HITSOLID", time_usec=1 << 62))


def test_pressure_altitude_of_the_standard_atmosphere() -> None:
    assert sensor.pressure_altitude(1013.25) == pytest.approx(0.0)
    assert sensor.pressure_altitude(954.61) == pytest.approx(500.0, abs=1.0)


def test_sticks() -> None:
    other = Vehicle()
    taker = rc_inputs.SticksReader(other.v)
    taker.write(taker.read(rc_inputs.sticks_payload(5000, (1500, 1100, 1900))))
    assert other.v.sensors.rc_channels.tolist() == [1500, 1100, 1900] + [0] * 13
    assert (other.v.sensors.rc_count, other.v.sensors.rc_time_us) == (1, 5000)
    with pytest.raises(RefusedError, match="chan2_raw = 3000"):
        taker.read(rc_inputs.sticks_payload(5000, (1500, 3000)))
    kind, payload = rc_inputs.frame_for(True, 5000, (1500, 1100))
    assert kind.name == "RC_CHANNELS" and kind.decode(payload).chan2_raw == 1100
    fields = kind.decode(payload)
    assert (fields.time_boot_ms, fields.chancount, fields.rssi) == (5, 2, 254), "milliseconds; 254 is the strongest"
    assert (fields.chan1_raw, fields.chan3_raw) == (1500, 0)
    assert rc_inputs.frame_for(False, 5000, (1500,)) == (rc_inputs.KIND, rc_inputs.sticks_payload(5000, (1500,)))


@pytest.mark.parametrize(
    ("pulse", "taken"), [(0, 0), (65535, 0), (800, 800), (2200, 2200), (799, None), (2201, None), (1, None)]
)
@pytest.mark.parametrize("channel", [1, 12])
def test_pulses_are_those_that_receivers_give(channel: int, pulse: int, taken: int | None) -> None:
    """0 and UINT16_MAX: the channel is not used."""
    pulses = [1500] * 12
    pulses[channel - 1] = pulse
    payload = rc_inputs.sticks_payload(7500, (*pulses, 1234))  # of more channels those are left out that have no field
    if taken is None:
        with pytest.raises(RefusedError, match=f"chan{channel}_raw = {pulse}: 800 .. 2200 us"):
            rc_inputs.SticksReader.read(payload)
    else:
        time_us, found = rc_inputs.SticksReader.read(payload)
        assert (time_us, len(found), found[channel - 1]) == (7500, 12, taken)


CUT: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    "HIL_SENSOR": (sensor.SensorReader.read, sensor.SENSOR_KIND, {"time_usec": 2500, "zacc": -9.75}),
    "BATTERY_STATUS": (sensor.BatteryReader.read, sensor.BATTERY_KIND, {"voltages": (12_500,) + (0,) * 9}),
    "DISTANCE_SENSOR": (ranging.DistanceReader.read, ranging.DISTANCE, {"current_distance": 120, "orientation": 25}),
    "DEBUG_VECT": (ranging.RangeReader.read, ranging.VECTOR, {"name": b"RANGE", "x": 1.25}),
    "HIL_RC_INPUTS_RAW": (rc_inputs.SticksReader.read, rc_inputs.KIND, {"time_usec": 2500, "chan1_raw": 1500}),
    "HIL_STATE_QUATERNION": (truth.read_truth, truth.TRUTH_KIND, {"attitude_quaternion": (1.0, 0.0, 0.0, 0.0)}),
    "HIL_ACTUATOR_CONTROLS": (controls.read_controls, controls.KIND, {"time_usec": 2500, "controls": (0.5, 0.25)}),
}
"""Name -> what reads it, its kind, fields before the zeros at its end."""


@pytest.mark.parametrize("name", sorted(CUT))
def test_zeros_at_its_end_that_a_message_comes_without_are_read(name: str) -> None:
    read, kind, fields = CUT[name]
    whole = kind.payload(**fields)
    cut = whole.rstrip(b"\0")
    assert len(cut) < len(whole) and read(cut) == read(whole) is not None


@pytest.mark.parametrize("samples, ranges", [(58, 57), (58, 1), (58, 0), (40, 0)])
def test_a_scan_that_ends_in_contact_is_read(samples: int, ranges: int) -> None:
    taker = ranging.ScanReader(Vehicle().v, samples)
    given = [2.5] * ranges + [0.0] * (samples - ranges) + [math.nan] * (ranging.PART - samples)
    payload = ranging.SCAN.payload(time_usec=2500, name=b"LASER", data=given)
    part = taker.read(payload.rstrip(b"\0"))
    assert part is not None
    assert (part[0], part[1], part[2].tolist()) == (2500, 0, given[:samples])
