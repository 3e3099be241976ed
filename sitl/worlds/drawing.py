# SPDX-License-Identifier: BSD-3-Clause
"""A world as a picture from above, and as a few lines of text."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path

from ..core.whole_file import whole_file
from ..errors import MissingExtra
from .shapes import Cylinder
from .world import World

_NAMES_UP_TO = 40
"""Solids whose names are still readable in a picture."""


def summary(world: World) -> str:
    """What the world is, in lines of text."""
    x1, y1, x2, y2 = world.bounds
    boxes = sum(not isinstance(s, Cylinder) for s in world.solids)
    lines = [
        f"{world.name}: {world.description}".rstrip(": "),
        f"  solids    {boxes} boxes, {len(world.solids) - boxes} cylinders",
        f"  extent    x {x1:.2f} .. {x2:.2f}, y {y1:.2f} .. {y2:.2f} m",
    ]
    if world.solids:
        lows, highs = [s.low for s in world.solids], [s.high for s in world.solids]
        lines.append(f"  heights   {min(lows):.2f} .. {max(highs):.2f} m above z = 0")
    lines.append(f"  floor     z = {world.floor_z:g} m, friction {world.friction:g}")
    for start in world.starts:
        x, y, z = start.position
        who = start.robot or "any robot"
        lines.append(
            f"  start     {start.name}: x {x:g}, y {y:g}, z {z:g} m, yaw {math.degrees(start.yaw):.2f} deg ({who})"
        )
    for lap in world.laps:
        keeps = f", {lap.clearance:g} m from walls" if lap.clearance is not None else ""
        lines.append(f"  lap       {lap.name}: {lap.length:g} m{keeps}")
    if world.source:
        lines.append(f"  source    {world.source}")
    return "\n".join(lines)


def check_installed() -> None:
    """Check that pictures can be drawn.

    Raises:
        MissingExtra: matplotlib is not installed.
    """
    if importlib.util.find_spec("matplotlib") is None:
        raise MissingExtra("pictures need matplotlib: pip install 'gym-sitl[viz]'")


def draw(world: World, path: str | Path, height: float | None = None) -> None:
    """Write the plan (PNG, SVG or PDF by the name's ending), cut at a height [m] (the world's own when None).

    Black: solid at that height. Blue: solid at others. Green: start poses.

    Raises:
        MissingExtra: matplotlib is not installed.
        SitlError: the picture cannot be written.
    """
    check_installed()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 7.2), layout="constrained")
    FigureCanvasAgg(figure)
    plan(figure.add_subplot(), world, world.plan_height if height is None else height)
    with whole_file(path, title=repr(str(path))) as beside:
        figure.savefig(beside, dpi=110)


def plan(axes: object, world: World, height: float, names: bool = True) -> None:
    """Draw the plan at a height [m] into axes of matplotlib."""
    from matplotlib.axes import Axes
    from matplotlib.patches import Polygon

    assert isinstance(axes, Axes)
    for marking in world.markings:
        axes.add_patch(Polygon(marking.footprint(), facecolor=marking.colour, alpha=0.5, lw=0))
    cut = sorted(world.solids, key=lambda s: s.low <= height <= s.high)  # black over blue
    for solid in cut:
        shape = solid.footprint()
        if solid.low <= height <= solid.high:
            axes.add_patch(Polygon(shape, facecolor="black", edgecolor="black", lw=0.8))
        else:
            axes.add_patch(Polygon(shape, facecolor="#a8d0e6", edgecolor="#4a90b8", lw=0.5))
        if names and len(world.solids) <= _NAMES_UP_TO:
            axes.annotate(solid.name, solid.centre[:2], color="#d02020", fontsize=6, ha="center", va="center")
    x1, y1, x2, y2 = world.bounds
    margin = 0.05 * max(x2 - x1, y2 - y1, 1.0)
    for start in world.starts:
        x, y, _ = start.position
        tip = (x + 2.0 * margin * math.cos(start.yaw), y + 2.0 * margin * math.sin(start.yaw))
        axes.annotate("", tip, (x, y), arrowprops={"arrowstyle": "-|>", "color": "green", "lw": 1.5})
        axes.plot(x, y, "o", color="#20e020", markeredgecolor="green", ms=6)
    axes.set(xlim=(x1 - margin, x2 + margin), ylim=(y1 - margin, y2 + margin), xlabel="x [m]", ylabel="y [m]")
    axes.set_aspect("equal")
    axes.set_title(f"{world.name}, cut at z = {height:g} m (blue: solid at other heights)", fontsize=9)
    axes.grid(alpha=0.3)
