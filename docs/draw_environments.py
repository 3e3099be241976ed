# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_environments.py [NAME...]``: pictures of the pages in envs/: the task seen from above, and an
episode of the policy that comes with the package."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from make_environment_pages import HERE, TITLES, spelling
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle

from sitl.agents import baselines, environments, learnt
from sitl.envs.page.source import states
from sitl.envs.targets.gates import Gates
from sitl.envs.targets.moving import MovingTask
from sitl.envs.targets.target_task import TargetTask
from sitl.view.scene.bearings import length_for

SEED = 1000
WIDTH, HEIGHT, DPI = 7.2, 5.2, 100
"""Of a picture [inches, dots an inch]."""
COLOURS = 128
GOAL, TRACK, WALL, LOW, TARGET = "#2d9150", "viridis", "#4a5058", "#c4c8cc", "#e67e22"
plt.rcParams.update({"font.size": 12, "axes.titlesize": 13, "legend.fontsize": 11})


def fly(name: str) -> tuple[Any, Any, Any]:
    """The first episode that ``sitl rollout --seed 1000`` plays: the environment at its end, x, y, z and time of each
    step, shape (n, 4), and x, y, z of the target, shape (n, 3)."""
    found = learnt.load(baselines.file(spelling(name)))
    env: Any = gym.make(found.config.env, **found.config.env_options)  # the id and the worlds that it learnt in
    seed = environments.seed_of(SEED, 0)
    observation, _ = env.reset(seed=seed)
    found.policy.begin(seed)
    inner, track, targets = env.unwrapped, [], []
    ended = False
    while not ended:
        track.append((*judged(inner), float(np.asarray(inner.robot.time)[0])))
        targets.append(where(inner.task))
        observation, _, terminated, truncated, _ = env.step(found.policy.act(observation))
        ended = terminated or truncated
    return env, np.array(track), np.array(targets)


def judged(env: Any) -> Any:
    """x, y, z as the task judges them: by the truth, of ids "-v0" by the vehicle's estimate, but for gates [m]."""
    if isinstance(env.task, Gates):
        return states(env.robot)[0, :3]
    return env.session.judge.pose[0, :3].copy()


def where(task: Any) -> Any:
    """x, y, z of the present target [m]."""
    return task.targets[0].copy() if isinstance(task, TargetTask) else np.array([*task.goals[0], np.nan])


def draw_course(ax: Axes, env: Any, targets: Any) -> None:
    """World, arena, gates, places, goal."""
    robot, task = env.unwrapped.robot, env.unwrapped.task
    world = robot.world
    for marking in world.markings:
        ax.add_patch(Polygon(marking.footprint(), color=marking.colour, alpha=0.25, lw=0))
    for solid in world.solids:
        is_met = solid.low <= world.plan_height <= solid.high
        ax.add_patch(Polygon(solid.footprint(), color=WALL if is_met else LOW, lw=0))
    radius = float(getattr(task, "radius", 0.0) or getattr(task, "pad", 0.0))
    if isinstance(task, Gates):
        middle = np.mean([(gate.x, gate.y) for gate in task.gates], axis=0)
        for k, gate in enumerate(task.gates):
            across = 0.5 * gate.width * np.array([-np.sin(gate.yaw), np.cos(gate.yaw)])
            ends = np.array([gate.x, gate.y]) + np.outer((-1, 1), across)
            label = "gate, in its direction" if k == 0 else None
            ax.plot(*ends.T, color=GOAL, lw=4, solid_capstyle="butt", label=label, zorder=5)
            tip = (gate.x + 1.3 * np.cos(gate.yaw), gate.y + 1.3 * np.sin(gate.yaw))
            style = {"arrowstyle": "-|>", "color": GOAL, "lw": 2}
            ax.annotate("", tip, (gate.x, gate.y), arrowprops=style, zorder=5)
            beside = ends[0] if np.hypot(*(ends[0] - middle)) > np.hypot(*(ends[1] - middle)) else ends[1]
            number(ax, beside + 0.6 * (beside - (gate.x, gate.y)), k + 1)
    elif isinstance(task, MovingTask):
        ax.plot(*targets[:, :2].T, color=TARGET, lw=2.5, ls=(0, (2, 1)), label="target's path")
        ax.add_patch(Circle(targets[-1, :2], radius, fill=False, color=TARGET, lw=2, label=f"target, {radius:g} m"))
    else:
        places = task.positions[0] if isinstance(task, TargetTask) else targets[-1:]
        for k, place in enumerate(places):
            label = f"goal, within {radius:g} m" if len(places) == 1 else f"waypoint, within {radius:g} m"
            label = label if k == 0 else ""
            ax.add_patch(Circle(place[:2], max(radius, 0.05), color=GOAL, alpha=0.35, lw=2, label=label))
            if len(places) > 1:
                number(ax, place[:2], k + 1)
    box = getattr(task, "arena", None)
    if box is not None:
        (x0, y0), (x1, y1) = box.low[:2], box.high[:2]
        ax.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, fill=False, ls=":", color="0.5", label="arena"))


def number(ax: Axes, at: Any, value: int) -> None:
    """A number of the course."""
    box = {"boxstyle": "round,pad=0.15", "fc": "white", "ec": GOAL}
    ax.text(*at, str(value), ha="center", va="center", fontsize=11, bbox=box, zorder=6)


def draw_track(ax: Axes, track: Any, figure: Any) -> None:
    """The way, in the colours of its speed."""
    speed = np.linalg.norm(np.diff(track[:, :3], axis=0), axis=1) / np.maximum(np.diff(track[:, 3]), 1e-6)
    dots = ax.scatter(*track[1:, :2].T, c=speed, cmap=TRACK, s=9, zorder=4)
    ax.plot(*track[:, :2].T, color="0.4", lw=0.8, zorder=3)
    ax.plot(*track[0, :2], "s", color="black", ms=8, zorder=5, label="start")
    ax.plot(*track[-1, :2], "*", color="#c0392b", ms=14, zorder=5, label="end")
    figure.colorbar(dots, ax=ax, label="speed [m/s]", fraction=0.04, pad=0.02)


def frame_it(ax: Axes, env: Any, track: Any, targets: Any) -> None:
    """The axes around what matters, with a scale."""
    task, world = env.unwrapped.task, env.unwrapped.robot.world
    points = np.concatenate([track[:, :2], targets[:, :2]])
    if isinstance(task, TargetTask):
        points = np.concatenate([points, task.positions[0, :, :2]])
    if world.solids:
        x0, y0, x1, y1 = world.bounds
        points = np.concatenate([points, [(x0, y0), (x1, y1)]])
    for gate in task.gates if isinstance(task, Gates) else ():
        points = np.concatenate([points, [(gate.x - 1.5, gate.y - 1.5), (gate.x + 1.5, gate.y + 1.5)]])
    room = float(getattr(task, "radius", 0.0))
    low, high = points.min(axis=0) - room, points.max(axis=0) + room
    middle, half = 0.5 * (low + high), np.maximum(0.56 * (high - low), 1.5)
    half = np.maximum(half, (0.0, 0.45 * half[0]))
    half = np.maximum(half, (1.3 * half[1], 0.0))
    ax.set_xlim(middle[0] - half[0], middle[0] + half[0])
    ax.set_ylim(middle[1] - half[1], middle[1] + half[1])
    ax.set_aspect("equal")
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.grid(alpha=0.25)
    length = length_for(0.5 * half[0])
    x, y = middle[0] - 0.94 * half[0], middle[1] - 0.93 * half[1]
    ax.plot((x, x + length), (y, y), color="black", lw=4, solid_capstyle="butt", zorder=6)
    ax.text(x + 0.5 * length, y + 0.03 * half[1], f"{length:g} m", ha="center", va="bottom", zorder=6)


def draw(name: str, path: Path) -> None:
    """Fly and draw one."""
    env, track, targets = fly(name)
    figure, ax = plt.subplots(figsize=(WIDTH, HEIGHT), dpi=DPI, layout="constrained")
    draw_course(ax, env, targets)
    draw_track(ax, track, figure)
    title = f"{name}: trained policy, {track[-1, 3] - track[0, 3]:.1f} s"
    if isinstance(env.unwrapped.task, TargetTask) and env.unwrapped.task.flies:
        low, high = max(track[:, 2].min(), 0.0), track[:, 2].max()
        title += f", z {low:.1f} .. {high:.1f} m"
    ax.set_title(title)
    frame_it(ax, env, track, targets)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    save(figure, path)
    plt.close(figure)
    env.close()


def save(figure: Any, path: Path) -> None:
    """Write a picture with few colours."""
    from PIL import Image

    figure.canvas.draw()
    picture = Image.fromarray(np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy())
    picture.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(path, optimize=True)


def main() -> None:
    """Draw them."""
    (HERE / "images").mkdir(exist_ok=True)
    for name in sys.argv[1:] or TITLES:
        draw(name, HERE / "images" / f"{name}.png")


if __name__ == "__main__":
    main()
