# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.engines``: the same flights, firmware and parameters on every physics engine.

Each vehicle goes through two scripts: commands in GUIDED, and a mission. All values are of the simulator's truth, not
of the estimate, at equal times since the beginning of each phase.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from sitl.core.algebra import euler_of
from sitl.errors import SitlError
from sitl.logs.plot import new_figure
from sitl.physics.engines import BACKENDS, NATIVE
from sitl.simulation import Simulation

from .recorded import copter
from .recorded.metrics import shown
from .recorded.pilot import POSITION_ONLY, VELOCITY_ONLY, Pilot, items

HOME = (-35.363262, 149.165237, 584.0, 0.0)
ROVER_SQUARE = copter.SQUARE
Array = np.ndarray[Any, Any]

COLUMNS = ("t", "north", "east", "down", "vn", "ve", "vd", "roll", "pitch", "yaw", "output", "energy")
"""Seconds, metres NED, m/s, radians; mean of the motors' outputs in use (a rover's throttle); Wh drawn since boot."""


class Witness(Pilot):
    """A pilot that records the simulator's truth."""

    def __init__(self, simulation: Simulation) -> None:
        super().__init__(simulation)
        self.truth: list[tuple[float, ...]] = []
        self._wh = 0.0

    def note(self) -> None:
        super().note()
        v = self.simulation.v
        body, battery = v.physics.body, v.physics.battery
        output = self.simulation.kind.motor_output(v)
        self._wh += float(battery.voltage) * float(battery.current) * 0.04 / 3600.0
        row = (*body.pos, *body.vel, *euler_of(body.q))
        self.truth.append((self.now, *row, output, self._wh))


def copter_guided(simulation: Simulation) -> Witness:
    """The GUIDED script of the recorded flight."""
    pilot = Witness(simulation)
    copter.guided(simulation, pilot)
    return pilot


def copter_mission(simulation: Simulation) -> Witness:
    """The mission of the recorded flight."""
    pilot = Witness(simulation)
    copter.auto(simulation, pilot)
    return pilot


def rover_guided(simulation: Simulation) -> Witness:
    """Velocity north for 10 s, then stop, then a place to the right and behind, then RTL."""
    pilot = Witness(simulation)
    pilot.boot()
    pilot.arm(2.0)
    pilot.phase("velocity")
    pilot.stream_setpoint(10.0, VELOCITY_ONLY, (1.2, 0.0, 0.0))
    pilot.phase("stop")
    pilot.stream_setpoint(5.0, VELOCITY_ONLY, (0.0, 0.0, 0.0))
    pilot.phase("position")
    pilot.setpoint(POSITION_ONLY, position=(5.0, 15.0, 0.0))
    pilot.fly(25.0)
    pilot.phase("RTL")
    pilot.choose_mode("RTL")
    pilot.fly(30.0)
    return pilot


def rover_mission(simulation: Simulation) -> Witness:
    """A square of 30 m in AUTO."""
    pilot = Witness(simulation)
    pilot.boot()
    pilot.transfer(items([(0, 16, *ROVER_SQUARE[-1], 584.0), *((3, 16, lat, lon, 0.0) for lat, lon in ROVER_SQUARE)]))
    pilot.arm(1.0)
    pilot.phase("mission")
    pilot.choose_mode("AUTO")
    pilot.fly(180.0, lambda: bool(pilot.reached) and pilot.reached[-1] == len(ROVER_SQUARE))
    pilot.phase("arrived")
    pilot.fly(5.0)
    return pilot


Script = Callable[[Simulation], Witness]
FLIGHTS: dict[str, dict[str, Script]] = {
    "erle_copter": {"GUIDED": copter_guided, "AUTO": copter_mission},
    "erle_rover": {"GUIDED": rover_guided, "AUTO": rover_mission},
}


@dataclass
class Flown:
    """One flight on one engine."""

    rows: Array
    """Columns as ``COLUMNS``, every 40 ms."""
    phases: dict[str, float]
    reached: list[tuple[float, int]]
    ended: float
    """Time at which the script ended: disarmed, or its last wait [s]."""

    def phase(self, name: str, until: float) -> Array:
        """Rows of a phase, shape (rows, columns), time [s] counted from its begin."""
        start = self.phases[name]
        rows: Array = self.rows[(self.rows[:, 0] >= start - 1e-9) & (self.rows[:, 0] < until)].copy()
        rows[:, 0] -= start
        return rows

    def parts(self) -> dict[str, Array]:
        """The rows of every phase, each of shape (rows, columns), time [s] first."""
        names = list(self.phases)
        ends = [*(self.phases[name] for name in names[1:]), self.ended]
        return {name: self.phase(name, end) for name, end in zip(names, ends)}


def fly(frame: str, script: Script, physics: str, seed: int = 0, **options: Any) -> Flown:
    """Fly one script on one engine."""
    simulation = Simulation(frame, home=HOME, seed=seed, physics=physics, **options)
    try:
        pilot = script(simulation)
    finally:
        simulation.close()
    return Flown(np.array(pilot.truth), pilot.phases, pilot.telemetry.reached, pilot.now)


@dataclass(frozen=True)
class Difference:
    """Differences between the flights of two engines over all phases, at equal times since the start of each phase."""

    path_rms: float
    """RMS distance between the paths [m]."""
    path_max: float
    """Greatest distance between the paths [m]."""
    lean_rms: float
    """RMS difference of roll and pitch together [deg]."""
    heading_rms: float
    """[deg]"""
    output_mean: float
    """Mean difference of the motors' mean output [fraction of the full range]."""
    energy: float
    """[% of the other's]"""
    duration: float
    """Duration from the first phase to the end [s]."""
    items: float
    """Greatest difference in the time at which a mission item was reached [s]."""


def difference(ours: Flown, other: Flown) -> Difference:
    """``ours`` against ``other``."""
    gaps: list[Array] = []
    for name, rows in ours.parts().items():
        theirs = other.parts()[name]
        t = rows[rows[:, 0] <= theirs[-1, 0], 0]
        mine, them = rows[: len(t)], np.column_stack([np.interp(t, theirs[:, 0], column) for column in theirs.T])
        them[:, 9] = np.interp(t, theirs[:, 0], np.unwrap(theirs[:, 9]))
        gaps.append(mine - them)
    gap = np.concatenate(gaps)
    distance = np.linalg.norm(gap[:, 1:4], axis=1)
    turned = np.degrees((gap[:, 9] + np.pi) % (2.0 * np.pi) - np.pi)
    first, theirs_first = min(ours.phases.values()), min(other.phases.values())
    used = [
        float(f.rows[-1, 11] - np.interp(min(f.phases.values()), f.rows[:, 0], f.rows[:, 11])) for f in (ours, other)
    ]
    times = {item: t - theirs_first for t, item in other.reached}
    late = [abs(t - first - times[item]) for t, item in ours.reached if item in times]
    return Difference(
        float(np.sqrt(np.mean(distance**2))),
        float(distance.max()),
        float(np.degrees(np.sqrt(np.mean(gap[:, 7] ** 2 + gap[:, 8] ** 2)))),
        float(np.sqrt(np.mean(turned**2))),
        float(np.mean(gap[:, 10])),
        100.0 * (used[0] / used[1] - 1.0),
        (ours.ended - first) - (other.ended - theirs_first),
        max(late, default=0.0),
    )


ROWS = (
    ("path, RMS", "m", "path_rms"),
    ("path, greatest distance", "m", "path_max"),
    ("lean, RMS", "deg", "lean_rms"),
    ("heading, RMS", "deg", "heading_rms"),
    ("mean output of the motors", "% of full", "output_mean"),
    ("energy drawn", "%", "energy"),
    ("duration", "s", "duration"),
    ("mission items, latest or earliest by", "s", "items"),
)


def table(flown: dict[str, dict[str, Flown]]) -> str:
    """Differences from native physics as Markdown; ``flown[flight][engine]``."""
    others = [name for name in next(iter(flown.values())) if name != NATIVE]
    columns = [(flight, engine) for flight in flown for engine in others]
    lines = [
        "| difference from native | unit | " + " | ".join(f"{flight}: {engine}" for flight, engine in columns) + " |",
        "|---|---|" + "---|" * len(columns),
    ]
    found = {key: difference(flown[key[0]][key[1]], flown[key[0]][NATIVE]) for key in columns}
    for title, unit, name in ROWS:
        scale = 100.0 if name == "output_mean" else 1.0
        cells = [shown(scale * getattr(found[key], name)) for key in columns]
        lines.append(f"| {title} | {unit} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def plot(flown: dict[str, dict[str, Flown]], title: str, path: Path) -> None:
    """Plot each flight with all engines: plan, height or speed, pitch or heading, output, and the distance of each from
    native physics."""
    figure = new_figure(12.0, 6.4 * len(flown), title)
    axes = figure.subplots(2 * len(flown), 3, squeeze=False).reshape(len(flown), 6)
    for row, (flight, engines) in zip(axes, flown.items()):
        native = engines[NATIVE]
        flies = bool(native.rows[:, 3].min() < -1.0)
        for k, (engine, f) in enumerate(engines.items()):
            start = min(f.phases.values())
            rows = f.rows[f.rows[:, 0] >= start]
            t = rows[:, 0] - start
            style: dict[str, Any] = {"label": engine, "color": f"C{k}", "lw": 3.0 - 1.0 * k, "alpha": 0.8}
            row[0].plot(rows[:, 2], rows[:, 1], **style)
            row[1].plot(t, -rows[:, 3] if flies else np.hypot(rows[:, 4], rows[:, 5]), **style)
            row[2].plot(t, np.degrees(rows[:, 8] if flies else np.unwrap(rows[:, 9])), **style)
            row[3].plot(t, rows[:, 10], **style)
            if f is not native:
                row[4].plot(t, np.linalg.norm(_places(f, t) - _places(native, t), axis=1), color=f"C{k}", label=engine)
        row[0].set(xlabel="east [m]", ylabel="north [m]", title=f"{flight}: plan", aspect="equal")
        titles = "height [m]" if flies else "speed [m/s]", "pitch [deg]" if flies else "heading [deg]"
        for axis, text in zip(row[1:5], (*titles, "mean output of the motors", "distance from native's path [m]")):
            axis.set(xlabel="t [s]", title=text)
        row[5].set_axis_off()
        row[5].legend(*row[0].get_legend_handles_labels(), loc="center", fontsize=14, frameon=False)
        for axis in row[:5]:
            axis.grid(alpha=0.25)
            axis.title.set_size(13)
            axis.tick_params(labelsize=12)
            axis.xaxis.label.set_size(12)
    figure.savefig(path, dpi=80)


def _places(flown: Flown, t: Array) -> Array:
    """Positions at times since the first phase, north, east, down [m], shape (n, 3)."""
    rows, start = flown.rows, min(flown.phases.values())
    return np.column_stack([np.interp(t, rows[:, 0] - start, rows[:, k]) for k in (1, 2, 3)])


def fly_all(frame: str, engines: list[str]) -> dict[str, dict[str, Flown]]:
    """Fly all flights of a frame on each engine."""
    flights = FLIGHTS[frame].items()
    return {name: {engine: fly(frame, script, engine) for engine in engines} for name, script in flights}


def main() -> None:
    """Print the tables; draw the pictures."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.engines", description=__doc__)
    parser.add_argument("frame", nargs="?", choices=sorted(FLIGHTS), help="vehicle (default: all)")
    parser.add_argument(
        "--engine", action="append", choices=BACKENDS[1:], help="beside native (repeatable; default all)"
    )
    parser.add_argument("--plots", type=Path, metavar="DIR", help="also draw FRAME-engines.png there")
    options = parser.parse_args()
    for frame in [options.frame] if options.frame else sorted(FLIGHTS):
        try:
            flown = fly_all(frame, [NATIVE, *(options.engine or BACKENDS[1:])])
        except SitlError as error:
            parser.error(str(error))
        print(f"{frame}\n\n{table(flown)}\n")
        if options.plots:
            plot(flown, f"{frame} on {len(next(iter(flown.values())))} engines", options.plots / f"{frame}-engines.png")


if __name__ == "__main__":
    main()
