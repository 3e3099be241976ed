# SPDX-License-Identifier: BSD-3-Clause
"""Sensors as they measure: IMU, pressure; and the simulator's truth."""

from __future__ import annotations

from ...autopilot.sensor_calibration import field_of
from ...autopilot.vibration import vibration_levels
from ...core.algebra import euler_of
from ...core.border import BAROS_DIFFER, IMUS_DIFFER, ONE_BARO
from ...core.constants import GRAVITY
from ...core.elementary import pow
from ...core.kernels import law
from ...core.vectors import Euler, Quat, Vec3
from ...physics.carried import MILLIG, Carried, carried
from ...vehicle.record import Vehicle
from ..wire.message import Message, consecutive
from .units import boot_ms, int16, int16s

MILLIG_PER_ACC = 1000.0 / GRAVITY
ALL_BUT_DIFFERENTIAL_PRESSURE = 0x1BFF
"""fields_updated of HIGHRES_IMU"""


class RawImu(Message, name="RAW_IMU"):
    time_usec: int
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")
    gyro: Vec3 = consecutive("xgyro", "ygyro", "zgyro")
    mag: Vec3 = consecutive("xmag", "ymag", "zmag")
    temperature: int


@law
def raw_imu(m: RawImu, v: Vehicle) -> bool:
    """RAW_IMU: mG, mrad/s, mgauss (ArduPilot sends scaled values here), centidegrees Celsius."""
    s, c = v.sensors, v.autopilot.calibrated
    acc, gyro, mag = c.acc, c.gyro, c.mag
    m.time_usec = v.time_us
    m.acc = int16s(acc * MILLIG_PER_ACC)
    m.gyro = int16s(gyro * 1000.0)
    m.mag = int16s(mag * 1000.0)
    m.temperature = int16(s.temperature * 100.0)
    return True


class ScaledImu(Message, name="SCALED_IMU"):
    time_boot_ms: int
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")
    gyro: Vec3 = consecutive("xgyro", "ygyro", "zgyro")
    mag: Vec3 = consecutive("xmag", "ymag", "zmag")
    temperature: int


class ScaledImu2(ScaledImu, name="SCALED_IMU2"):
    pass


class ScaledImu3(Message, name="SCALED_IMU3"):
    time_boot_ms: int
    mag: Vec3 = consecutive("xmag", "ymag", "zmag")


@law
def fill_imu(m: ScaledImu | ScaledImu2, v: Vehicle, acc: Vec3, gyro: Vec3) -> None:
    """What an IMU shows: mG, mrad/s, centidegrees Celsius."""
    m.time_boot_ms = boot_ms(v.time_us)
    m.acc = int16s(acc * MILLIG_PER_ACC)
    m.gyro = int16s(gyro * 1000.0)
    m.temperature = int16(v.sensors.temperature * 100.0)


@law
def fill_field(m: ScaledImu | ScaledImu2 | ScaledImu3, field: Vec3) -> None:
    """What a compass shows [mgauss]."""
    m.mag = int16s(field * 1000.0)


@law
def scaled_imu(m: ScaledImu, v: Vehicle) -> bool:
    """SCALED_IMU: mG, mrad/s, mgauss."""
    c = v.autopilot.calibrated
    fill_imu(m, v, c.acc, c.gyro)
    fill_field(m, c.mag)
    return True


@law
def scaled_imu2(m: ScaledImu2, v: Vehicle) -> bool:
    """SCALED_IMU2: the second IMU and compass."""
    c = v.autopilot.calibrated
    differ = v.sensors.imu_state & IMUS_DIFFER != 0
    fill_imu(m, v, c.acc2 if differ else c.acc, c.gyro2 if differ else c.gyro)
    fill_field(m, field_of(1, v.sensors, v.autopilot.params))
    return True


@law
def scaled_imu3(m: ScaledImu3, v: Vehicle) -> bool:
    """SCALED_IMU3: the third compass [mgauss]; there is no third IMU, whose fields are 0."""
    m.time_boot_ms = boot_ms(v.time_us)
    fill_field(m, field_of(2, v.sensors, v.autopilot.params))
    return True


class HighresImu(Message, name="HIGHRES_IMU"):
    time_usec: int
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")
    gyro: Vec3 = consecutive("xgyro", "ygyro", "zgyro")
    mag: Vec3 = consecutive("xmag", "ymag", "zmag")
    abs_pressure: float
    pressure_alt: float
    temperature: float
    fields_updated: int


@law
def highres_imu(m: HighresImu, v: Vehicle) -> bool:
    """HIGHRES_IMU: m/s^2, rad/s, gauss, hPa, pressure altitude in the standard atmosphere [m], degC."""
    s, c = v.sensors, v.autopilot.calibrated
    acc, gyro, mag, pressure = c.acc, c.gyro, c.mag, s.abs_pressure
    m.time_usec = v.time_us
    m.acc = acc
    m.gyro = gyro
    m.mag = mag
    m.abs_pressure = pressure
    m.pressure_alt = 44330.77 * (1.0 - pow(pressure / 1013.25, 0.1902632)) if pressure >= 0.0 else 0.0
    m.temperature = s.temperature
    m.fields_updated = ALL_BUT_DIFFERENTIAL_PRESSURE
    return True


class ScaledPressure(Message, name="SCALED_PRESSURE"):
    time_boot_ms: int
    press_abs: float
    temperature: int


@law
def scaled_pressure(m: ScaledPressure, v: Vehicle) -> bool:
    """SCALED_PRESSURE: hPa, centidegrees Celsius."""
    m.time_boot_ms = boot_ms(v.time_us)
    m.press_abs = v.sensors.abs_pressure
    m.temperature = int16(v.sensors.temperature * 100.0)
    return True


class ScaledPressure2(ScaledPressure, name="SCALED_PRESSURE2"):
    pass


@law
def scaled_pressure2(m: ScaledPressure2, v: Vehicle) -> bool:
    """SCALED_PRESSURE2: the second barometer, hPa, centidegrees Celsius; both show the same but for faults."""
    s = v.sensors
    m.time_boot_ms = boot_ms(v.time_us)
    m.press_abs = s.abs_pressure2 if s.baro_state & BAROS_DIFFER != 0 else s.abs_pressure
    m.temperature = int16(s.temperature * 100.0)
    return s.baro_state & ONE_BARO == 0


class SimState(Message, name="SIMSTATE"):
    euler: Euler = consecutive("roll", "pitch", "yaw")
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")
    gyro: Vec3 = consecutive("xgyro", "ygyro", "zgyro")
    lat: int
    lng: int


@law
def fill_simstate(m: SimState, truth: Carried) -> None:
    """SIMSTATE of a truth, from wherever it comes."""
    q, rates, force = truth.attitude, truth.rates, truth.acceleration
    m.euler = euler_of(Quat(q[0], q[1], q[2], q[3]))
    m.acc = MILLIG * Vec3(force[0], force[1], force[2])
    m.gyro = Vec3(rates[0], rates[1], rates[2])
    m.lat = truth.lat
    m.lng = truth.lon


@law
def simstate(m: SimState, v: Vehicle) -> bool:
    """SIMSTATE: the simulator's truth: angles [rad], specific force [m/s^2] and rates [rad/s] of the body, degE7."""
    fill_simstate(m, carried(v))
    return True


class SimStateWithSpeed(Message, name="SIM_STATE"):
    q: Quat = consecutive("q1", "q2", "q3", "q4")
    euler: Euler = consecutive("roll", "pitch", "yaw")
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")
    gyro: Vec3 = consecutive("xgyro", "ygyro", "zgyro")
    lat: float
    lon: float
    alt: float
    velocity: Vec3 = consecutive("vn", "ve", "vd")
    lat_int: int
    lon_int: int


@law
def fill_sim_state(m: SimStateWithSpeed, truth: Carried) -> None:
    """SIM_STATE of a truth, from wherever it comes; ``lat`` and ``lon`` are degE7, too, as ArduPilot has them."""
    q, rates, force, velocity = truth.attitude, truth.rates, truth.acceleration, truth.velocity
    m.q = Quat(q[0], q[1], q[2], q[3])
    m.euler = euler_of(Quat(q[0], q[1], q[2], q[3]))
    m.acc = MILLIG * Vec3(force[0], force[1], force[2])
    m.gyro = Vec3(rates[0], rates[1], rates[2])
    m.lat = m.lat_int = truth.lat
    m.lon = m.lon_int = truth.lon
    m.alt = truth.alt * 1e-3
    m.velocity = 1e-2 * Vec3(velocity[0], velocity[1], velocity[2])


@law
def sim_state(m: SimStateWithSpeed, v: Vehicle) -> bool:
    """SIM_STATE: the simulator's truth: attitude, specific force [m/s^2] and rates [rad/s] of the body, degE7, altitude
    [m], velocity NED [m/s]."""
    fill_sim_state(m, carried(v))
    return True


class VibrationMessage(Message, name="VIBRATION"):
    time_usec: int
    vibration: Vec3 = consecutive("vibration_x", "vibration_y", "vibration_z")
    clipping_0: int
    clipping_1: int


@law
def vibration(m: VibrationMessage, v: Vehicle) -> bool:
    """VIBRATION: level on each axis [m/s^2], filtered at 5 and 2 Hz as ArduPilot's; samples beyond 15.5 g, by IMU."""
    shakes = v.autopilot.vibration
    m.time_usec = v.time_us
    m.vibration = vibration_levels(shakes)
    m.clipping_0 = shakes.clips
    m.clipping_1 = shakes.clips + shakes.more_clips
    return True


MESSAGES = (
    raw_imu, scaled_imu, scaled_imu2, scaled_imu3, highres_imu, scaled_pressure, scaled_pressure2, simstate, sim_state,
    vibration,
)  # fmt: skip
