# SPDX-License-Identifier: BSD-3-Clause
"""The recorded drive of a rover, driven with the same commands at the same times, and its metrics."""

from __future__ import annotations

from sitl.core import elementary_arrays as arrays
from sitl.simulation import Simulation

from .metrics import VX, Metric, X, Y, crossing, path_rms, speeds, stopped, with_distance
from .pilot import POSITION_ONLY, VELOCITY_ONLY, Pilot, items
from .recording import Recording

SQUARE = [(-353630824, 1491652371), (-353630824, 1491654574), (-353632621, 1491654574), (-353632621, 1491652371)]
"""Corners of the recorded AUTO mission [degE7]."""
TARGET = (26.555, 19.267)
"""Target of the recorded position step: 20 m east of the rover's position [m]."""
NORTH = (2.0, 0.0, 0.0)
"""The recorded velocity [m/s]."""
FROM_FIRST = "AUTO from item 1 on"
PATHS = (
    ("vel_2N_10s", 10.0, True),
    ("vel_stop_sending", 8.0, True),
    ("pos_step_20E", 25.0, False),
    ("pos_home", 25.0, False),
    (FROM_FIRST, 19.0, False),
    ("HOLD", 6.0, True),
    ("RTL", 25.0, False),
)
"""Phases whose paths are compared, how long [s], and whether positions count from where each began."""


def drive(simulation: Simulation) -> Pilot:
    """2 m/s north for 10 s, silence, 20 m east, home, HOLD, a square in AUTO, 2 m/s again, HOLD, RTL."""
    pilot = Pilot(simulation)
    pilot.boot()
    pilot.arm(2.0)
    pilot.phase("vel_2N_10s")
    pilot.stream_setpoint(10.0, VELOCITY_ONLY, NORTH)
    pilot.phase("vel_stop_sending")
    pilot.fly(8.0)
    pilot.phase("pos_step_20E")
    pilot.setpoint(POSITION_ONLY, position=(*TARGET, 0.0))
    pilot.fly(25.0)
    pilot.phase("pos_home")
    pilot.setpoint(POSITION_ONLY)
    pilot.fly(25.0)
    pilot.phase("HOLD0")
    pilot.choose_mode("HOLD")
    pilot.fly(4.0)
    pilot.transfer(items([(0, 16, *SQUARE[-1], 584.0), *((3, 16, lat, lon, 0.0) for lat, lon in SQUARE)]))
    pilot.phase("AUTO")
    pilot.choose_mode("AUTO")
    pilot.fly(60.0, lambda: bool(pilot.reached) and pilot.reached[-1] == len(SQUARE))
    pilot.fly(10.0)
    pilot.phase("vel_2_before_hold")
    pilot.choose_mode("GUIDED")
    pilot.stream_setpoint(6.0, VELOCITY_ONLY, NORTH)
    pilot.phase("HOLD")
    pilot.choose_mode("HOLD")
    pilot.fly(6.02)
    pilot.phase("RTL")
    pilot.choose_mode("RTL")
    pilot.fly(25.0)
    return pilot


def drive_metrics(ours: Recording, theirs: Recording) -> list[Metric]:
    """The metrics of the drive."""
    metrics: list[Metric] = []

    def add(name: str, unit: str, phase: str, duration: float, value) -> None:
        metrics.append(Metric(name, unit, value(ours.since(phase, duration)), value(theirs.since(phase, duration))))

    def compare_text(name: str, phase: str, text: str) -> None:
        metrics.append(Metric(name, "s", ours.text_time(phase, text), theirs.text_time(phase, text)))

    for speed in (1.0, 1.9):
        add(f"2 m/s north: {speed} m/s", "s", "vel_2N_10s", 10, lambda r, v=speed: crossing(r, VX, v))
    add("2 m/s north: peak speed", "m/s", "vel_2N_10s", 10, lambda r: float(speeds(r).max()))
    add("2 m/s north: speed from 8 s on", "m/s", "vel_2N_10s", 10, lambda r: float(speeds(r[r[:, 0] > 8.0]).mean()))
    add("2 m/s north: covered in 10 s", "m", "vel_2N_10s", 10, lambda r: float(r[-1, X] - r[0, X]))
    compare_text("set-point time-out: said", "vel_stop_sending", "target not received")
    add("set-point time-out: stopped", "s", "vel_stop_sending", 8, stopped)
    add("set-point time-out: covered", "m", "vel_stop_sending", 8, lambda r: float(r[-1, X] - r[0, X]))
    for name, phase, target in (("20 m east", "pos_step_20E", TARGET), ("back", "pos_home", (0.0, 0.0))):
        for near in (3.0, 1.0):
            add(f"{name}: within {near:.0f} m", "s", phase, 25,
                lambda r, d=near, t=target: crossing(with_distance(r, *t), 1, d))  # fmt: skip
        add(f"{name}: stopped", "s", phase, 25, stopped)
        add(f"{name}: peak speed", "m/s", phase, 25, lambda r: float(speeds(r).max()))
        add(f"{name}: error at the end", "m", phase, 25, lambda r, t=target: float(with_distance(r, *t)[-1, 1]))
    for seq in range(1, len(SQUARE) + 1):
        metrics.append(Metric(f"AUTO: item {seq} reached", "s", ours.arrival("AUTO", seq), theirs.arrival("AUTO", seq)))
    for seq in range(2, len(SQUARE) + 1):
        legs = [r.arrival("AUTO", seq) - r.arrival("AUTO", seq - 1) for r in (ours, theirs)]
        metrics.append(Metric(f"AUTO: from item {seq - 1} to {seq}", "s", *legs))
    add("AUTO: velocity along the first leg while it stands", "m/s", "AUTO", 0.2, lambda r: float(r[0, VX]))
    add("AUTO: peak speed", "m/s", "AUTO", 30, lambda r: float(speeds(r).max()))
    add("HOLD: speed at its begin", "m/s", "HOLD", 6, lambda r: float(speeds(r)[0]))
    for speed in (0.5, 0.1):
        add(f"HOLD: below {speed} m/s", "s", "HOLD", 6, lambda r, v=speed: stopped(r, v))
    add("HOLD: covered", "m", "HOLD", 6, lambda r: float(arrays.hypot(r[-1, X] - r[0, X], r[-1, Y] - r[0, Y])))
    add("RTL: peak speed", "m/s", "RTL", 25, lambda r: float(speeds(r).max()))
    add("RTL: within 3 m of home", "s", "RTL", 25, lambda r: crossing(with_distance(r, 0.0, 0.0), 1, 3.0))
    compare_text("RTL: says that it is there", "RTL", "Reached destination")
    for recording in (ours, theirs):
        recording.phases[FROM_FIRST] = recording.phases["AUTO"] + recording.arrival("AUTO", 1)
    for phase, duration, from_start in PATHS:
        rms = path_rms(ours.since(phase, duration), theirs.since(phase, duration), from_start)
        metrics.append(Metric(f"{phase}: RMS distance at equal times", "m", rms, 0.0))
    whole = path_rms(ours.since("AUTO", 29.0), theirs.since("AUTO", 29.0))
    metrics.append(Metric("AUTO from its start on: path at equal times", "m", whole, 0.0))
    return metrics
