# SPDX-License-Identifier: BSD-3-Clause
"""``python -m missions.compare``: our flights beside the recorded ones, as a Markdown table."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from sitl.simulation import ESTIMATORS, Simulation, load_core

from . import flights
from .recording import COLUMNS, Recording, recorded

HOME = (-35.363262, 149.165237, 584.0, 0.0)
X, Y, Z, VX, VY = (COLUMNS.index(c) for c in ("x", "y", "z", "vx", "vy"))
ROLL, PITCH, YAW = (COLUMNS.index(c) for c in ("roll", "pitch", "yaw"))


@dataclass
class Figure:
    """One figure of a flight, ours and ArduPilot's."""

    name: str
    unit: str
    ours: float
    theirs: float

    @property
    def percent(self) -> float:
        """Difference in percent of ArduPilot's."""
        return 100.0 * (self.ours - self.theirs) / abs(self.theirs) if self.theirs else float("nan")


def crossing(rows: np.ndarray, column: int, level: float) -> float:
    """Time at which a column first crosses ``level`` (interpolated); NaN when it never does."""
    t, values = rows[:, 0], rows[:, column] - level
    beyond = np.nonzero(values * (np.sign(values[0]) or -1.0) <= 0)[0]
    if not len(beyond):
        return float("nan")
    k = max(int(beyond[0]), 1)
    step = values[k] - values[k - 1]
    return float(t[k] if step == 0 else t[k - 1] - values[k - 1] * (t[k] - t[k - 1]) / step)


def path_rms(ours: np.ndarray, theirs: np.ndarray) -> float:
    """RMS distance [m] between the two positions at equal times since the phase's start."""
    t = theirs[theirs[:, 0] <= ours[-1, 0], 0]
    gaps = [np.interp(t, ours[:, 0], ours[:, c]) - theirs[: len(t), c] for c in (X, Y, Z)]
    return float(np.sqrt(np.mean(np.sum(np.square(gaps), axis=0))))


def guided_figures(ours: Recording, theirs: Recording) -> list[Figure]:
    """The figures of the GUIDED script."""
    figures: list[Figure] = []

    def add(name: str, unit: str, phase: str, duration: float, value) -> None:
        figures.append(Figure(name, unit, value(ours.since(phase, duration)), value(theirs.since(phase, duration))))

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
    figures.append(Figure("3 m/s east: estimated position behind its own velocity after 5 s", "m", *behind))
    add("3 m/s east: lean", "deg", "vel_3E_10s", 10, lambda r: float(np.degrees(r[:, ROLL].max())))
    add("stop: distance", "m", "vel_zero", 6, lambda r: float(r[-1, Y] - r[0, Y]))
    add("stop: below 0.2 m/s", "s", "vel_zero", 6, lambda r: crossing(r, VY, 0.2))
    add("yaw to 90 deg: within 2 deg", "s", "yaw_90_abs", 12, lambda r: crossing(r, YAW, np.radians(88.0)))
    add("yaw +45 deg at 30 deg/s: within 2 deg", "s", "yaw_rel_cw_45_30dps", 8,
        lambda r: crossing(r, YAW, np.radians(133.0)))  # fmt: skip
    add("RTL: climbs to", "m", "RTL", 60, lambda r: float(-r[:, Z].min()))
    add("RTL: peak speed", "m/s", "RTL", 60, lambda r: float(np.hypot(r[:, VX], r[:, VY]).max()))
    add("RTL: within 2 m of home", "s", "RTL", 60, near_home)
    figures.append(
        Figure("RTL: disarmed", "s", ours.disarmed - ours.phases["RTL"], theirs.disarmed - theirs.phases["RTL"])
    )
    for phase, duration in (("takeoff", 25.0), ("pos_step_20N", 25.0), ("vel_3E_10s", 16.0), ("RTL", 45.0)):
        rms = path_rms(ours.since(phase, duration), theirs.since(phase, duration))
        figures.append(Figure(f"{phase}: RMS distance at equal times", "m", rms, 0.0))
    return figures


def behind_velocity(rows: np.ndarray) -> float:
    """How far [m] the estimated position is behind the integral of the estimated velocity, along east."""
    t, v = rows[:, 0], rows[:, VY]
    integral = float(np.sum(np.diff(t) * 0.5 * (v[1:] + v[:-1])))
    return integral - float(rows[-1, Y] - rows[0, Y])


def near_home(rows: np.ndarray) -> float:
    """Time at which the horizontal distance to the origin falls below 2 m."""
    distance = np.column_stack((rows[:, 0], np.hypot(rows[:, X], rows[:, Y])))
    return crossing(distance, 1, 2.0)


def auto_figures(ours: Recording, theirs: Recording) -> list[Figure]:
    """The figures of the AUTO square."""
    start_o, start_t = ours.phases["mission_start"], theirs.phases["mission_start"]
    times = {seq: t - start_o for t, seq in ours.reached}
    figures = [
        Figure(f"AUTO: item {seq} reached", "s", times.get(seq, float("nan")), t - start_t) for t, seq in theirs.reached
    ]
    figures.append(Figure("AUTO: disarmed", "s", ours.disarmed - start_o, theirs.disarmed - start_t))
    rows_o, rows_t = ours.since("mission_start", 60.0), theirs.since("mission_start", 60.0)
    speed = [float(np.hypot(r[:, VX], r[:, VY]).max()) for r in (rows_o, rows_t)]
    figures.append(Figure("AUTO: peak speed", "m/s", *speed))
    figures.append(Figure("AUTO: RMS distance at equal times", "m", path_rms(rows_o, rows_t), 0.0))
    return figures


def figures(estimator: str = "ekf", seed: int = 0) -> list[Figure]:
    """Fly both scripts on ArduPilot's quad and compare."""
    core = load_core()

    def fly(script) -> Recording:
        simulation = Simulation("ardupilot_quad", home=HOME, seed=seed, estimator=estimator, core=core)
        return script(simulation).recording()

    found = guided_figures(fly(flights.guided), recorded("copter_guided"))
    return found + auto_figures(fly(flights.auto), recorded("copter_auto"))


def table(found: list[Figure]) -> str:
    """The figures as Markdown."""
    lines = ["| figure | unit | ours | ArduPilot | difference |", "|---|---|---|---|---|"]
    for f in found:
        theirs = f"{f.theirs:.2f}" if f.theirs else ""
        lines.append(
            f"| {f.name} | {f.unit} | {f.ours:.2f} | {theirs} | {f'{f.percent:+.1f} %' if f.theirs else ''} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m missions.compare", description=__doc__)
    parser.add_argument("estimator", nargs="?", choices=ESTIMATORS, default="ekf")
    parser.add_argument("--seed", type=int, default=0, help="of all sensor noise (default 0)")
    options = parser.parse_args()
    print(table(figures(options.estimator, options.seed)))


if __name__ == "__main__":
    main()
