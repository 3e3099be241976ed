# SPDX-License-Identifier: BSD-3-Clause
"""A flight as one picture: plan view, altitude, attitude, motors."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .flight import Flight


class MissingExtra(RuntimeError):
    """An optional dependency is not installed; the message says which extra brings it."""


def draw(flight: Flight, path: str | Path, title: str = "") -> None:
    """Write the picture (PNG, SVG or PDF by the name's ending).

    Raises:
        MissingExtra: matplotlib is not installed.
        LogError: the flight holds no position, attitude or motor outputs.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("pictures need matplotlib: pip install 'gym-sitl[viz]'") from None

    position, attitude, motors = flight["LOCAL_POSITION_NED"], flight["ATTITUDE"], flight["SERVO_OUTPUT_RAW"]
    figure = Figure(figsize=(12, 8), layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(title)
    axes = figure.subplots(3, 2, width_ratios=(1, 1.2))
    grid = axes[0, 0].get_gridspec()
    for row in range(3):
        axes[row, 0].remove()
    plan = figure.add_subplot(grid[:, 0])
    plan.plot(position[:, 2], position[:, 1], lw=1.5)
    plan.plot(position[0, 2], position[0, 1], "ko", ms=5, label="home")
    for t, seq in flight.reached:
        north, east = (np.interp(t, position[:, 0], position[:, k]) for k in (1, 2))
        plan.plot(east, north, "r.", ms=9)
        plan.annotate(str(seq), (east, north), textcoords="offset points", xytext=(6, 4), color="r")
    plan.set(xlabel="east [m]", ylabel="north [m]", title="plan view (red: mission items reached)")
    plan.set_aspect("equal", adjustable="datalim")
    plan.grid(alpha=0.3)
    plan.legend(loc="upper right")

    armed = next((t for t, state in flight.armed if state), position[0, 0])
    start = max(position[0, 0], armed - 5.0)
    altitude, angles, pulses = axes[0, 1], axes[1, 1], axes[2, 1]
    altitude.plot(position[:, 0], -position[:, 3])
    altitude.set(ylabel="altitude [m]")
    for column, name in enumerate(("roll", "pitch", "yaw"), 1):
        angles.plot(attitude[:, 0], np.degrees(attitude[:, column]), lw=0.9, label=name)
    angles.set(ylabel="attitude [deg]")
    for column in range(1, 5):
        pulses.plot(motors[:, 0], motors[:, column], lw=0.7, label=f"motor {column}")
    pulses.set(ylabel="output [us]", xlabel="simulated time [s]")
    for axis in (altitude, angles, pulses):
        axis.grid(alpha=0.3)
        axis.set_xlim(start, position[-1, 0])
        for t, seq in flight.reached:
            axis.axvline(t, color="r", lw=0.6, alpha=0.6)
            if axis is altitude:
                axis.annotate(str(seq), (t, axis.get_ylim()[1]), color="r", fontsize=8)
    angles.legend(loc="upper right", ncols=3, fontsize=8)
    pulses.legend(loc="upper right", ncols=4, fontsize=8)
    figure.savefig(path, dpi=110)
