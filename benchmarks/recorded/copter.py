# SPDX-License-Identifier: BSD-3-Clause
"""The two recorded flights of a copter, flown with the same commands at the same times, and their metrics."""

from __future__ import annotations

import numpy as np

from sitl.simulation import Simulation

from .metrics import PITCH, ROLL, VX, VY, YAW, Metric, X, Y, Z, crossing, path_rms, speeds, with_distance
from .pilot import POSITION_ONLY, VELOCITY_ONLY, Pilot, items
from .recording import Recording

SQUARE = [(-353629926, 1491652371), (-353629926, 1491655676), (-353632621, 1491655676), (-353632621, 1491652371)]
"""Corners of the recorded AUTO mission [degE7]."""


def guided(simulation: Simulation, pilot: Pilot | None = None) -> Pilot:
    """Take-off 10 m, 20 m north, 3 m/s east for 10 s, stop, three yaw commands, RTL: the recorded GUIDED script."""
    pilot = pilot or Pilot(simulation)
    pilot.boot()
    pilot.arm(2.08)
    pilot.phase("takeoff")
    pilot.send_command("NAV_TAKEOFF", altitude=10.0)
    pilot.fly(25.0)
    pilot.phase("pos_step_20N")
    pilot.setpoint(POSITION_ONLY, position=(20.0, 0.0, -10.0))
    pilot.fly(25.0)
    pilot.phase("vel_3E_10s")
    pilot.stream_setpoint(10.0, VELOCITY_ONLY, (0.0, 3.0, 0.0))
    pilot.phase("vel_zero")
    pilot.stream_setpoint(6.0, VELOCITY_ONLY, (0.0, 0.0, 0.0))
    pilot.phase("yaw_0_abs_ccw")
    pilot.send_command("CONDITION_YAW", 0, 0, -1, 0)
    pilot.fly(12.0)
    pilot.phase("yaw_90_abs")
    pilot.send_command("CONDITION_YAW", 90, 0, 1, 0)
    pilot.fly(12.0)
    pilot.phase("yaw_rel_cw_45_30dps")
    pilot.send_command("CONDITION_YAW", 45, 30, 1, 1)
    pilot.fly(8.0)
    pilot.phase("RTL")
    pilot.choose_mode("RTL")
    pilot.wait_disarmed(90.0)
    return pilot


def auto(simulation: Simulation, pilot: Pilot | None = None) -> Pilot:
    """Upload the recorded square, arm in GUIDED, switch to AUTO and start."""
    pilot = pilot or Pilot(simulation)
    pilot.boot()
    rows = [(0, 16, -353632621, 1491652371, 584.0), (3, 22, 0, 0, 10.0)]
    rows += [(3, 16, lat, lon, 10.0) for lat, lon in SQUARE] + [(3, 21, 0, 0, 0.0)]
    pilot.transfer(items(rows))
    pilot.arm(1.08)
    pilot.phase("mission_start")
    pilot.choose_mode("AUTO")
    pilot.send_command("MISSION_START")
    pilot.wait_disarmed(120.0)
    return pilot


def guided_metrics(ours: Recording, theirs: Recording) -> list[Metric]:
    """The metrics of the GUIDED script."""
    metrics: list[Metric] = []

    def add(name: str, unit: str, phase: str, duration: float, value) -> None:
        metrics.append(Metric(name, unit, value(ours.since(phase, duration)), value(theirs.since(phase, duration))))

    for height in (0.1, 5.0, 9.5, 9.9):
        add(f"take-off: {height} m", "s", "takeoff", 25, lambda r, h=height: crossing(r, Z, -h))
    add("take-off: greatest height", "m", "takeoff", 25, lambda r: float(-r[:, Z].min()))
    for north in (10.0, 19.0, 19.8):
        add(f"20 m north: {north} m", "s", "pos_step_20N", 25, lambda r, n=north: crossing(r, X, n))
    add("20 m north: peak speed", "m/s", "pos_step_20N", 25, lambda r: float(r[:, VX].max()))
    add("20 m north: furthest", "m", "pos_step_20N", 25, lambda r: float(r[:, X].max()))
    add("20 m north: pitch down", "deg", "pos_step_20N", 25, lambda r: float(np.degrees(r[:, PITCH].min())))
    add("3 m/s east: 1 m/s", "s", "vel_3E_10s", 10, lambda r: crossing(r, VY, 1.0))
    add("3 m/s east: 2.85 m/s", "s", "vel_3E_10s", 10, lambda r: crossing(r, VY, 2.85))
    add("3 m/s east: speed at 2.1 s", "m/s", "vel_3E_10s", 10, lambda r: float(np.interp(2.1, r[:, 0], r[:, VY])))
    add("3 m/s east: peak speed", "m/s", "vel_3E_10s", 10, lambda r: float(r[:, VY].max()))
    add("3 m/s east: covered in 10 s", "m", "vel_3E_10s", 10, lambda r: float(r[-1, Y] - r[0, Y]))
    behind = [behind_velocity(r.since("vel_3E_10s", 5.0)) for r in (ours, theirs)]
    metrics.append(Metric("3 m/s east: estimated position behind its own velocity after 5 s", "m", *behind))
    add("3 m/s east: lean", "deg", "vel_3E_10s", 10, lambda r: float(np.degrees(r[:, ROLL].max())))
    add("stop: distance", "m", "vel_zero", 6, lambda r: float(r[-1, Y] - r[0, Y]))
    add("stop: below 0.2 m/s", "s", "vel_zero", 6, lambda r: crossing(r, VY, 0.2))
    add("yaw to 90 deg: within 2 deg", "s", "yaw_90_abs", 12, lambda r: crossing(r, YAW, np.radians(88.0)))
    add("yaw +45 deg at 30 deg/s: within 2 deg", "s", "yaw_rel_cw_45_30dps", 8,
        lambda r: crossing(r, YAW, np.radians(133.0)))  # fmt: skip
    add("RTL: climbs to", "m", "RTL", 60, lambda r: float(-r[:, Z].min()))
    add("RTL: peak speed", "m/s", "RTL", 60, lambda r: float(speeds(r).max()))
    add("RTL: within 2 m of home", "s", "RTL", 60, near_home)
    metrics.append(
        Metric("RTL: disarmed", "s", ours.disarmed - ours.phases["RTL"], theirs.disarmed - theirs.phases["RTL"])
    )
    for phase, duration in (("takeoff", 25.0), ("pos_step_20N", 25.0), ("vel_3E_10s", 16.0), ("RTL", 45.0)):
        rms = path_rms(ours.since(phase, duration), theirs.since(phase, duration))
        metrics.append(Metric(f"{phase}: RMS distance at equal times", "m", rms, 0.0))
    return metrics


def behind_velocity(rows: np.ndarray) -> float:
    """Lag of the estimated position behind the integral of the estimated velocity, along east [m]."""
    t, v = rows[:, 0], rows[:, VY]
    integral = float(np.sum(np.diff(t) * 0.5 * (v[1:] + v[:-1])))
    return integral - float(rows[-1, Y] - rows[0, Y])


def near_home(rows: np.ndarray) -> float:
    """Time at which the horizontal distance to the origin falls below 2 m."""
    return crossing(with_distance(rows, 0.0, 0.0), 1, 2.0)


def auto_metrics(ours: Recording, theirs: Recording) -> list[Metric]:
    """The metrics of the AUTO square."""
    start_o, start_t = ours.phases["mission_start"], theirs.phases["mission_start"]
    times = {seq: t - start_o for t, seq in ours.reached}
    metrics = [
        Metric(f"AUTO: item {seq} reached", "s", times.get(seq, float("nan")), t - start_t) for t, seq in theirs.reached
    ]
    metrics.append(Metric("AUTO: disarmed", "s", ours.disarmed - start_o, theirs.disarmed - start_t))
    rows_o, rows_t = ours.since("mission_start", 60.0), theirs.since("mission_start", 60.0)
    speed = [float(speeds(r).max()) for r in (rows_o, rows_t)]
    metrics.append(Metric("AUTO: peak speed", "m/s", *speed))
    metrics.append(Metric("AUTO: RMS distance at equal times", "m", path_rms(rows_o, rows_t), 0.0))
    return metrics
