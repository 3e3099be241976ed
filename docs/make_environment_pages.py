# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_environment_pages.py``: writes a page for each environment with places, from its code."""

from __future__ import annotations

import inspect
import json
import math
import re
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

import sitl.envs
from sitl.envs.actions import Discrete
from sitl.envs.boxes import GoalConditioned

HERE = Path(__file__).parent / "envs"
TITLES = {
    "CopterHover": ("Hover in wind", "Hold a place near the start while wind and gusts push."),
    "CopterReachGoal": ("Copter, goal-conditioned", "Be at a drawn place; sparse rewards, for hindsight replay."),
    "RoverReachGoal": ("Rover, goal-conditioned", "Be at a drawn place; sparse rewards, for hindsight replay."),
    "CopterWaypoint": ("Fly to a waypoint", "One place, drawn in the arena."),
    "CopterCourse": ("Fly a course of waypoints", "Five places one after another, each drawn anew."),
    "CopterGates": ("Race through gates", "An oval of six gates, in their direction, against the clock."),
    "CopterRace": ("Race three laps", "The same gates three times; `info` has the times of laps."),
    "CopterTrajectory": ("Follow a figure of eight", "A point moves along a curve at a drawn speed; be where it is."),
    "CopterFollow": ("Follow a moving target", "A target wanders; be where it is."),
    "CopterLand": ("Land on a pad", "Come down softly on a pad beside the start."),
    "CopterLandMoving": ("Land on a moving pad", "The pad moves at 0.5 m/s."),
    "CopterForest": ("Fly through a forest", 'One place among trees, by lidar (`world="forest:seed=7"`: others).'),
    "CopterRooms": ("Fly through rooms", "One place in a house of rooms and doors, by lidar."),
    "RoverWaypoint": ("Drive to a waypoint", "One place, drawn in the arena."),
    "RoverCourse": ("Drive a course of waypoints", "Four places one after another, each drawn anew."),
    "RoverLabyrinth": ("Drive through a labyrinth", "One place in a maze, by lidar."),
    "RoverSlalom": ("Drive a slalom", 'Poles that are passed on alternate sides (`world="slalom:seed=7"`: others).'),
    "RoverRace": ("Race two laps", 'A track between walls; `info` has laps\' times (`world="track:seed=7"`: others).'),
    "RoverParking": ("Park in a bay", 'Stand in a free bay between cars (`world="car_park:seed=7"`: others).'),
}  # fmt: skip
MANY = 12
"""Columns of one kind beyond which a table has one row for all."""


def number(value: float) -> str:
    """As short as can be."""
    return f"{value:.4g}"


def observations(env: Any) -> list[str]:
    """A table of the numbers that are seen."""
    parts = env.session.observation
    space = env.observation_space["observation"] if isinstance(parts, GoalConditioned) else env.observation_space
    rows = ["| number | what | least | greatest |", "|---:|---|---:|---:|"]
    for name, at in parts.slices.items():
        columns = parts.columns[at]
        shown = range(len(columns)) if len(columns) <= MANY else (0,)
        for k in shown:
            first = at.start + k
            what = columns[k] if len(columns) <= MANY else f"{columns[0]} ... {columns[-1]}"
            label = str(first) if len(columns) <= MANY else f"{first} .. {at.stop - 1}"
            rows.append(f"| {label} | `{name}`: {what} | {number(space.low[first])} | {number(space.high[first])} |")
    if isinstance(parts, GoalConditioned):
        rows += [
            "",
            'These are `"observation"`; `"achieved_goal"` and `"desired_goal"` are x, y, z in the world\'s frame [m].',
        ]
    return rows


def actions(continuous: Any, discrete: Any) -> list[str]:
    """Tables of both forms."""
    action = continuous.session.action
    rows = ["| number | what | at -1 | at 1 |", "|---:|---|---:|---:|"]
    for k, (column, (low, high)) in enumerate(zip(action.columns, action.limits, strict=True)):
        rows.append(f"| {k} | {action.setpoint.columns[column]} | {number(low)} | {number(high)} |")
    table = discrete.session.action
    assert isinstance(table, Discrete)
    rows += ["", "The form `Discrete`:", "", f"| action | name | {' | '.join(table.setpoint.columns)} |"]
    rows.append("|---:|---|" + "---:|" * table.setpoint.width)
    for k, (name, row) in enumerate(zip(table.names, np.asarray(table.table).tolist(), strict=True)):
        rows.append(f"| {k} | {name} | {' | '.join(number(value) for value in row)} |")
    return rows


def spelling(name: str) -> str:
    """Of an id's word as policies have it: "copter-hover" for "CopterHover"."""
    return re.sub(r"(?<!^)([A-Z])", r"-\1", name).lower()


def baseline(name: str) -> list[str]:
    """What the policies that come with the program reach, of both forms."""
    found = json.loads((HERE / "baselines.json").read_text(encoding="utf-8"))
    rows = [(key, found[key]) for key in (spelling(name), f"{spelling(name)}-discrete") if key in found]
    if not rows:
        return []
    lines = ["", "## Baseline", "", "| policy | algorithm | steps learnt | reward | solved | reward of drawn actions |"]
    lines.append("|---|---|---:|---:|---:|---:|")
    for key, row in rows:
        reward, drawn = ("{} ± {}".format(*row[what]) for what in ("reward", "drawn"))
        solved = f"{row['solved']} of {row['episodes']}"
        lines.append(f"| `{key}` | {row['algorithm'].upper()} | {row['steps']:,} | {reward} | {solved} | {drawn} |")
    return [*lines, "", f"`sitl rollout {rows[0][0]} --episodes {rows[0][1]['episodes']} --seed {rows[0][1]['seed']}` "
            "plays them again ([baselines](../baselines.md))."]  # fmt: skip


def chosen(task: Any, names: str) -> str:
    """Values of arguments in this environment, as far as the task tells."""
    values = [vars(task).get(name.strip(), vars(task).get(f"_{name.strip()}")) for name in names.split(",")]
    plain = [value for value in values if isinstance(value, bool | int | float | str | tuple)]
    return ", ".join(str(value) for value in plain) if len(plain) == len(values) else ""


def page(name: str) -> str:
    """The page of an id without "sitl/" and "-v0"."""
    title, summary = TITLES[name]
    continuous, discrete = (gym.make(f"sitl/{name}{form}-v0") for form in ("", "Discrete"))
    env: Any = continuous.unwrapped
    task, spec = env.task, continuous.spec
    text, _, arguments = (inspect.getdoc(type(task)) or "").partition("\nArgs:\n")
    arguments = re.sub(r"\n {8}", " ", arguments)
    described = [line.strip().partition(":") for line in arguments.splitlines() if ":" in line]
    box = task.arena
    seconds = spec.max_episode_steps * env.step_time
    lines = [
        f"# {title}", "", "<!-- Made by python docs/make_environment_pages.py -->", "", summary, "",
        f"`sitl/{name}-v0` takes actions in [-1, 1], `sitl/{name}Discrete-v0` the number of an action.", "",
        f"![an episode of the baseline](images/{name}.png)" if (HERE / "images" / f"{name}.png").exists() else "", "",
        "| | |", "|---|---|",
        f"| robot, world | {env.robot.name} in `{env.world.name}` |",
        f"| action space | `{continuous.action_space}` or `{discrete.action_space}`, "
        f"{env.session.action.setpoint.name} set-points |",
        f"| a step | {number(env.step_time)} s: {number(1.0 / env.step_time)} Hz |",
        f"| an episode | {spec.max_episode_steps} steps, {number(seconds)} s, then it is truncated |",
        f"| arena | x {number(box.low[0])} .. {number(box.high[0])}, y {number(box.low[1])} .. {number(box.high[1])}, "
        f"z {number(box.low[2])} .. {number(box.high[2])} m |",
        "", "## Observations", "",
        "`env.unwrapped.session.observation.columns` names them.", "", *observations(env),
        "", "## Actions", "", *actions(env, discrete.unwrapped),
        "", "## Reward, start and end", "", text.strip().replace("``", "`"), "",
        f"An episode ends in a crash (reward {number(task.crash_reward)}), or more than 5 m outside of the arena "
        f"({number(task.out_reward)}), or as said above. It starts at the world's start"
        + (" in the air." if name.startswith("Copter") else "."),
        "", f"## Arguments of the task (`task={type(task).__name__}(...)`)", "",
        "| argument | here | |", "|---|---:|---|",
        *(f"| `{a}` | {chosen(task, a)} | {b.strip().replace('``', '`')} |" for a, _, b in described),
        "", "All [options](../environments.md) of `sitl/Navigate-v0` can be replaced, too: observations, set-points,",
        "worlds, wind, faults, a vehicle at a connection.",
        *baseline(name),
        "", "## History", "", "v0: the first version.", "",
    ]  # fmt: skip
    continuous.close()
    discrete.close()
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines))


def index() -> str:
    """The page that lists them."""
    rows = ["# Environments with places", "", "<!-- Made by python docs/make_environment_pages.py -->", ""]
    rows += ["| id | task | step | episode |", "|---|---|---:|---:|"]
    for name, (title, _) in TITLES.items():
        spec = gym.spec(f"sitl/{name}-v0")
        env: Any = gym.make(spec)
        seconds = env.unwrapped.step_time * (spec.max_episode_steps or math.nan)
        link, step = f"[`sitl/{name}-v0`, `...Discrete-v0`]({name}.md)", number(env.unwrapped.step_time)
        rows.append(f"| {link} | {title} | {step} s | {number(seconds)} s |")
        env.close()
    return "\n".join(rows) + "\n"


def main() -> None:
    """Write all of them."""
    known = {name.removeprefix("sitl/").removesuffix("-v0") for name in sitl.envs.NEW if "Discrete" not in name}
    if known != set(TITLES):
        raise SystemExit(
            f"TITLES in {Path(__file__).name}: environments without one: {sorted(known - set(TITLES))}; "
            f"titles of none: {sorted(set(TITLES) - known)}"
        )
    HERE.mkdir(exist_ok=True)
    (HERE / "index.md").write_text(index(), encoding="utf-8")
    for name in TITLES:
        (HERE / f"{name}.md").write_text(page(name), encoding="utf-8")


if __name__ == "__main__":
    main()
