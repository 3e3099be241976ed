# SPDX-License-Identifier: BSD-3-Clause
"""A made-up flight with sensors, in plain numpy, to hold the estimator against: no physics, no controllers.

The vehicle stands until ``take_off`` seconds, climbs to 10 m, circles with up to 3 m/s^2 and turns in yaw.
Sensors have the noise, biases, rates and delays of the project's default ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sitl.autopilot.copter.parameters import TABLE
from sitl.autopilot.estimation import update
from sitl.core import compile as compiler
from sitl.core.algebra import euler_of
from sitl.core.earth_field import field_ned
from sitl.core.geodesy import add_offset, offset_ne
from sitl.core.vectors import Quat
from sitl.vehicle.copter import Copter

DT = 0.0025
TAKE_OFF = 50.0
"""When the flight that most tests share leaves the ground [s]."""
LAT, LON, ALT = -35.363262, 149.165237, 584.0
GRAVITY = 9.80665


def new() -> np.ndarray:
    """A fleet of one vehicle at power-on, with default parameters but without the filters behind the estimator."""
    fleet = Copter.fleet(1)
    params = Copter.of(fleet, 0).autopilot.params
    TABLE.set_defaults(params)
    params.EK3.MAG_CAL = 4.0  # biases of the magnetometer are learnt from the start
    params.INS.GYRO_FILTER = params.INS.ACCEL_FILTER = 0.0
    return fleet


def updater() -> Any:
    """``f(fleet)``: one tick of the estimator, compiled unless Numba is switched off."""
    call = compiler.load(update.update, "sitl.vehicle.copter.Copter")
    if call is None:
        return lambda fleet: update.update({0: Copter.of(fleet, 0)}, 0)
    return lambda fleet: call(fleet.ctypes.data, 1, 0)


def _smooth(t: np.ndarray, start: float, span: float) -> np.ndarray:
    x = np.clip((t - start) / span, 0.0, 1.0)
    return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Hamilton products of the rows."""
    aw, ax, ay, az = a.T
    bw, bx, by, bz = b.T
    return np.stack(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ],
        axis=-1,
    )


def _rotate_inverse(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    u = -q[:, 1:]
    t = 2.0 * np.cross(u, v)
    return v + q[:, :1] * t + np.cross(u, t)


@dataclass
class Truth:
    """The flight at the end of each tick."""

    t: np.ndarray
    pos: np.ndarray
    vel: np.ndarray
    q: np.ndarray
    rates: np.ndarray  # mean over the tick, body
    force: np.ndarray  # specific force, mean over the tick, body


def fly(duration: float, take_off: float) -> Truth:
    """A flight of ``duration`` seconds that leaves the ground at ``take_off``."""
    t = DT * np.arange(-1, int(duration / DT) + 1)
    s = _smooth(t, take_off + 8.0, 8.0)
    w = 0.55
    pos = np.stack(
        [
            10.0 * s * np.sin(w * (t - take_off)),
            10.0 * s * (np.cos(w * (t - take_off)) - 1.0),
            -10.0 * _smooth(t, take_off, 8.0) - 3.0 * s * np.sin(0.31 * (t - take_off)),
        ],
        axis=-1,
    )
    vel = np.gradient(pos, DT, axis=0)
    acc = np.gradient(vel, DT, axis=0)
    yaw = 0.3 + s * (1.2 * np.sin(0.4 * (t - take_off)) + 0.15 * (t - take_off - 8.0))
    thrust = acc - np.array([0.0, 0.0, GRAVITY])
    z = -thrust / np.linalg.norm(thrust, axis=1, keepdims=True)
    x = np.stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)], axis=-1)
    y = np.cross(z, x)
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    x = np.cross(y, z)
    q = np.stack(
        [
            np.sqrt(np.maximum(0.0, 1 + x[:, 0] + y[:, 1] + z[:, 2])),
            np.copysign(np.sqrt(np.maximum(0.0, 1 + x[:, 0] - y[:, 1] - z[:, 2])), y[:, 2] - z[:, 1]),
            np.copysign(np.sqrt(np.maximum(0.0, 1 - x[:, 0] + y[:, 1] - z[:, 2])), z[:, 0] - x[:, 2]),
            np.copysign(np.sqrt(np.maximum(0.0, 1 - x[:, 0] - y[:, 1] + z[:, 2])), x[:, 1] - y[:, 0]),
        ],
        axis=-1,
    )
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    step = multiply(q[:-1] * [1, -1, -1, -1], q[1:])
    step *= np.copysign(1.0, step[:, :1])
    n = np.linalg.norm(step[:, 1:], axis=1, keepdims=True)
    rates = 2.0 * np.arctan2(n, step[:, :1]) * step[:, 1:] / np.maximum(n, 1e-12) / DT
    middle = q[:-1] + q[1:] * np.copysign(1.0, np.sum(q[:-1] * q[1:], axis=1, keepdims=True))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    force = _rotate_inverse(middle, np.diff(vel, axis=0) / DT - np.array([0.0, 0.0, GRAVITY]))
    return Truth(t[1:], pos[1:], vel[1:], q[1:], rates, force)


@dataclass
class Noise:
    """Standard deviations of the sensors (docstring of the module)."""

    gyro_density: float = 3.4e-4  # [rad/s/sqrt(Hz)]
    gyro_bias: float = 0.0087  # [rad/s]
    gyro_walk: float = 4e-5  # [rad/s/sqrt(s)]
    acc_density: float = 4e-3  # [m/s^2/sqrt(Hz)]
    acc_bias: float = 0.02  # [m/s^2]
    acc_walk: float = 6e-3  # [m/s^2/sqrt(s)], correlated over 300 s
    gps_white: float = 0.1  # [m]
    gps_slow: float = 0.4  # [m], correlated over gps_slow_time
    gps_slow_time: float = 120.0  # [s]
    gps_vel: float = 0.05  # [m/s]
    gps_vel_d: float = 0.08  # [m/s]
    gps_delay: float = 0.12  # [s]
    gps_start: float = 9.8  # [s], first fix
    baro: float = 0.13  # [m]
    mag: float = 0.003  # [gauss]
    mag_bias: float = 0.004  # [gauss]


@dataclass
class Flight:
    """Sensors of a flight, ready to be played."""

    truth: Truth
    gyro: np.ndarray
    acc: np.ndarray
    mag: np.ndarray
    pressure: np.ndarray
    fixes: dict[int, tuple[int, ...]]  # tick of arrival: lat, lon, alt, vn, ve, vd
    take_off: float
    result: dict[str, np.ndarray] = field(default_factory=dict)


def sense(truth: Truth, take_off: float, seed: int, noise: Noise | None = None) -> Flight:
    """Sensors of a flight."""
    o = noise or Noise()
    r = np.random.default_rng(seed)
    n = len(truth.t)
    root = 1.0 / np.sqrt(DT)
    gyro_walk = np.cumsum(r.normal(0, o.gyro_walk * np.sqrt(DT), (n, 3)), axis=0)
    gyro_bias = r.normal(0, o.gyro_bias, 3) + gyro_walk
    gyro = truth.rates + gyro_bias + r.normal(0, o.gyro_density * root, (n, 3))
    walk = np.cumsum(r.normal(0, o.acc_walk * np.sqrt(DT), (n, 3)) * np.exp(truth.t / 300.0)[:, None], axis=0)
    acc_bias = r.normal(0, o.acc_bias, 3) + walk * np.exp(-truth.t / 300.0)[:, None]
    acc = truth.force + acc_bias + r.normal(0, o.acc_density * root, (n, 3))
    field_now = _rotate_inverse(truth.q, np.tile(field_ned(LAT, LON), (n, 1)))
    mag = field_now + r.normal(0, o.mag_bias, 3) + r.normal(0, o.mag, (n, 3))
    altitude = ALT - truth.pos[:, 2] + r.normal(0, o.baro, n)
    pressure = 1013.25 * (1.0 - 0.0065 * altitude / 288.15) ** 5.255876
    fixes = {}
    slow = r.normal(0, o.gps_slow, 3)
    keep = np.exp(-0.2 / o.gps_slow_time)
    for k in range(int(o.gps_start / DT), n, 80):
        slow = keep * slow + np.sqrt(1 - keep * keep) * o.gps_slow * r.normal(size=3)
        p = truth.pos[k] + slow + r.normal(0, o.gps_white, 3)
        v = truth.vel[k] + r.normal(0, (o.gps_vel, o.gps_vel, o.gps_vel_d), 3)
        lat, lon = add_offset(LAT * 1e7, LON * 1e7, p[0], p[1])
        arrival = k + round(o.gps_delay / DT)
        fixes[arrival] = (int(lat), int(lon), int(1000 * (ALT - p[2])), *(int(x) for x in np.rint(100 * v)))
    samples = (x.astype("f4") for x in (gyro, acc, mag, pressure))
    return Flight(truth, *samples, fixes, take_off)


KEPT = ("pos", "vel", "q", "rates", "acc_ned")


def load_tick(sensors: Any, flight: Flight, k: int) -> None:
    """Put tick ``k`` into a sensors record."""
    sensors["time_us"] = 2500 * (k + 1)
    sensors["gyro"] = flight.gyro[k]
    sensors["acc"] = flight.acc[k]
    if k % 8 == 1:
        sensors["abs_pressure"] = flight.pressure[k]
        sensors["baro_count"] += 1
    if k % 5 == 1:
        sensors["mag"] = flight.mag[k]
        sensors["mag_count"] += 1
    if k in flight.fixes:
        lat, lon, alt, vn, ve, vd = flight.fixes[k]
        sensors["gps_lat"], sensors["gps_lon"], sensors["gps_alt"] = lat, lon, alt
        sensors["gps_vel"] = (vn, ve, vd)
        sensors["gps_fix"], sensors["gps_satellites"], sensors["gps_eph"] = 3, 10, 121
        sensors["gps_time_us"] = 2500 * (k + 1)
        sensors["gps_count"] += 1


def play(flight: Flight, fleet: np.ndarray, tick: Any = None, spoil: Any = None) -> dict[str, np.ndarray]:
    """Play a flight into the estimator; ``spoil(k, sensors)`` may damage what it is about to read."""
    tick = tick or updater()
    v = fleet[0]
    sensors, autopilot = v["sensors"], v["autopilot"]
    estimate = autopilot["estimate"]
    n = len(flight.truth.t)
    out = {name: np.empty((n, estimate[name].shape[0])) for name in KEPT}
    flown = flight.truth.t > flight.take_off
    for k in range(n):
        load_tick(sensors, flight, k)
        if spoil:
            spoil(k, sensors)
        fleet["time_us"] = 2500 * (k + 1)
        autopilot["arming"]["armed"] = 1 if flown[k] else 0
        tick(fleet)
        for name in KEPT:
            out[name][k] = estimate[name]
    out["euler"] = np.array([euler_of(Quat(*q)) for q in out["q"]])
    return out


def attitude_error(q: np.ndarray, truth: np.ndarray) -> np.ndarray:
    """Angle between two attitudes [rad]."""
    return 2.0 * np.arccos(np.clip(np.abs(np.sum(q * truth, axis=1)), 0.0, 1.0))


def events(fleet: np.ndarray) -> list[tuple[float, int]]:
    """(seconds, code) of the events so far."""
    e = fleet[0]["autopilot"]["events"]
    return [(1e-6 * int(e["time_us"][k % 64]), int(e["code"][k % 64])) for k in range(int(e["count"]))]


def true_position(fleet: np.ndarray, truth: Truth) -> np.ndarray:
    """True positions from the estimator's origin, NED [m]: a GPS origin is itself a few decimetres off."""
    e = fleet[0]["autopilot"]["estimate"]
    n, east = offset_ne(int(e["origin_lat"]), int(e["origin_lon"]), LAT * 1e7, LON * 1e7)
    return truth.pos + np.array([n, east, 0.0])


def rms(x: np.ndarray) -> float:
    """Root of the mean square of the rows' lengths."""
    return float(np.sqrt(np.mean(np.sum(np.atleast_2d(x.T).T ** 2, axis=-1))))
