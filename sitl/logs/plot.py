# SPDX-License-Identifier: BSD-3-Clause
"""A flight as one picture: plan view, and what tells most of its kind of vehicle over time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from ..core.whole_file import whole_file
from ..errors import MissingExtra
from ..vehicle.kinds import DEFAULT
from .kind import logs_of
from .tlog import LogError
from .tlog_flight import Flight

_TOGETHER_M = 1.0
"""Items that are reached so near to each other share a label in the plan view [m]."""


def new_figure(width: float, height: float, title: str = "") -> Any:
    """An empty matplotlib figure [inches] that needs no screen.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise MissingExtra("pictures need matplotlib: pip install 'gym-sitl[viz]'") from None
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    figure.suptitle(title)
    return figure


def draw(flight: Flight, path: str | Path, title: str = "", kind: str = DEFAULT) -> None:
    """Write the picture (PNG, SVG or PDF by the name's ending).

    Beside the plan view: what the kind of vehicle has there (``sitl.logs.kind``), as altitude, attitude and motors of a
    copter.

    Raises:
        MissingExtra: matplotlib is not installed.
        LogError: the flight holds no position, attitude or outputs; the picture cannot be written.
    """
    position = flight["LOCAL_POSITION_NED"]
    figure = new_figure(9.6, 7.2, title)
    axes = figure.subplots(3, 2, width_ratios=(1, 1.2))
    grid = axes[0, 0].get_gridspec()
    for row in range(3):
        axes[row, 0].remove()
    _plan(figure.add_subplot(grid[:, 0]), flight)
    armed = next((t for t, state in flight.armed if state), position[0, 0])
    start = max(position[0, 0], armed - 5.0)
    panels = logs_of(kind).panels
    for axis, panel in zip(axes[:, 1], panels, strict=True):
        panel(axis, flight)
        axis.grid(alpha=0.3)
        axis.set_xlim(start, position[-1, 0])
        for t, _ in flight.reached:
            axis.axvline(t, color="r", lw=0.6, alpha=0.6)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=4, fontsize=10, frameon=False,
                        columnspacing=1.2, handlelength=1.2)  # fmt: skip
    for t, seq in flight.reached:
        axes[0, 1].annotate(str(seq), (t, axes[0, 1].get_ylim()[1]), color="r", fontsize=10)
    axes[2, 1].set(xlabel="simulated time [s]")
    with whole_file(path, LogError, f"picture {path}") as beside:
        figure.savefig(beside, dpi=110)


def _plan(axis: Any, flight: Flight) -> None:
    position = flight["LOCAL_POSITION_NED"]
    axis.plot(position[:, 2], position[:, 1], lw=1.5)
    axis.plot(position[0, 2], position[0, 1], "ko", ms=5, label="home")
    labels: list[tuple[float, float, list[str]]] = []
    for t, seq in flight.reached:
        north, east = (float(np.interp(t, position[:, 0], position[:, k])) for k in (1, 2))
        axis.plot(east, north, "r.", ms=9)
        near = [names for x, y, names in labels if math.hypot(x - east, y - north) < _TOGETHER_M]
        if near:
            near[0].append(str(seq))
        else:
            labels.append((east, north, [str(seq)]))
    for east, north, names in labels:
        axis.annotate(", ".join(names), (east, north), textcoords="offset points", xytext=(6, 4), color="r")
    axis.set(xlabel="east [m]", ylabel="north [m]", title="plan view (red: mission items reached)")
    axis.set_aspect("equal", adjustable="datalim")
    axis.grid(alpha=0.3)
    axis.legend(loc="upper right")


def altitude(axis: Any, flight: Flight) -> None:
    """Altitude over time."""
    position = flight["LOCAL_POSITION_NED"]
    axis.plot(position[:, 0], -position[:, 3])
    axis.set(ylabel="altitude [m]")


def attitude(axis: Any, flight: Flight) -> None:
    """Roll, pitch and yaw over time; yaw without jumps at south."""
    attitude = flight["ATTITUDE"]
    for column, name in enumerate(("roll", "pitch", "yaw"), 1):
        axis.plot(attitude[:, 0], np.degrees(np.unwrap(attitude[:, column])), lw=0.9, label=name)
    axis.set(ylabel="attitude [deg]")


def motors(axis: Any, flight: Flight) -> None:
    """Outputs 1 to 8 over time, as far as they are used."""
    outputs = flight["SERVO_OUTPUT_RAW"]
    for column in (column for column in range(1, 9) if outputs[:, column].any()):
        axis.plot(outputs[:, 0], outputs[:, column], lw=0.7, label=f"motor {column}")
    axis.set(ylabel="output [us]")


def speed(axis: Any, flight: Flight) -> None:
    """Ground speed over time."""
    position = flight["LOCAL_POSITION_NED"]
    axis.plot(position[:, 0], np.hypot(position[:, 4], position[:, 5]))
    axis.set(ylabel="speed [m/s]")


def heading(axis: Any, flight: Flight) -> None:
    """Heading over time, without jumps at north."""
    attitude = flight["ATTITUDE"]
    axis.plot(attitude[:, 0], np.degrees(np.unwrap(attitude[:, 3])), lw=0.9)
    axis.set(ylabel="heading [deg]")


def outputs(axis: Any, flight: Flight) -> None:
    """Outputs 1 and 3 over time."""
    outputs = flight["SERVO_OUTPUT_RAW"]
    for column, name in ((1, "output 1"), (3, "output 3")):
        axis.plot(outputs[:, 0], outputs[:, column], lw=0.7, label=name)
    axis.set(ylabel="output [us]")
