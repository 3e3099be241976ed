# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/make_environment_pages.py``: writes a page for each flight and driving task, from its code."""

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
from sitl.envs.arena import Arena
from sitl.envs.boxes import GoalConditioned
from sitl.envs.ids import TASKS, camel_case
from sitl.envs.presets import PRESETS
from sitl.envs.targets.gates import Gates
from sitl.envs.targets.landing import Land
from sitl.envs.tasks_v1 import RECEIVERS
from sitl.envs.worlds import TEST

HERE = Path(__file__).parent / "envs"
TITLES = {
    camel_case(preset): (task.title, task.aim.replace("info has", "`info` has")) for preset, task in TASKS.items()
}
MANY = 12
"""Columns of one kind beyond which a table has one row for all."""
OUT_PAYS = {
    "CopterReachGoal", "RoverReachGoal", "CopterCourse", "CopterGates", "CopterRace", "RoverWaypoint", "RoverCourse",
    "RoverSlalom",
}  # fmt: skip
"""In v0 it pays more to leave the arena than to do nothing."""
CRASH_PAYS = {"CopterRooms", "RoverLabyrinth", "RoverRace"}
"""In v0 it pays more to crash than to do nothing."""
UNUSED = {"Land": ("radius", "settle", "scale")}
"""Arguments of base classes that a task does not use."""


def number(value: float) -> str:
    """Five digits at most."""
    return f"{value:.5g}"


def observations(env: Any) -> list[str]:
    """A table of the columns of the observation."""
    parts = env.session.observation
    space = env.observation_space["observation"] if isinstance(parts, GoalConditioned) else env.observation_space
    rows = ["| index | part | meaning | min | max |", "|---:|---|---|---:|---:|"]
    for name, at in parts.slices.items():
        columns = parts.columns[at]
        shown = range(len(columns)) if len(columns) <= MANY else (0,)
        for k in shown:
            first = at.start + k
            what = columns[k] if len(columns) <= MANY else f"{columns[0]} ... {columns[-1]}"
            label = str(first) if len(columns) <= MANY else f"{first} .. {at.stop - 1}"
            rows.append(f"| {label} | `{name}` | {what} | {number(space.low[first])} | {number(space.high[first])} |")
    if isinstance(parts, GoalConditioned):
        rows += [
            "",
            'This is `observation["observation"]`. `"achieved_goal"` is the position of the robot, `"desired_goal"`',
            "that of the goal: x, y, z in the world's frame [m].",
        ]
    return rows


def actions(continuous: Any, discrete: Any) -> list[str]:
    """Tables of both forms."""
    action = continuous.session.action
    rows = ["Continuous, scaled linearly:", "", "| index | meaning | at -1 | at +1 |", "|---:|---|---:|---:|"]
    for k, (column, (low, high)) in enumerate(zip(action.columns, action.limits, strict=True)):
        rows.append(f"| {k} | {action.setpoint.columns[column]} | {number(low)} | {number(high)} |")
    table = discrete.session.action
    assert isinstance(table, Discrete)
    rows += ["", "Discrete:", "", f"| action | name | {' | '.join(table.setpoint.columns)} |"]
    rows.append("|---:|---|" + "---:|" * table.setpoint.width)
    for k, (name, row) in enumerate(zip(table.names, np.asarray(table.table).tolist(), strict=True)):
        rows.append(f"| {k} | {name} | {' | '.join(number(value) for value in row)} |")
    return rows


def spelling(name: str) -> str:
    """Of an id's word as policies have it: "copter-hover" for "CopterHover"."""
    return re.sub(r"(?<!^)([A-Z])", r"-\1", name).lower()


def baselines_of(name: str) -> list[tuple[str, Any]]:
    """Names and figures of the trained policies of both forms."""
    found = json.loads((HERE / "baselines.json").read_text(encoding="utf-8"))
    return [(key, found[key]) for key in (spelling(name), f"{spelling(name)}-discrete") if key in found]


def baseline(name: str) -> list[str]:
    """What the policies that come with the package reach, of both forms."""
    rows = baselines_of(name)
    if not rows:
        return []
    lines = ["", "## Baseline", "", "| policy | algorithm | training steps | mean return | success | random policy |"]
    lines.append("|---|---|---:|---:|---:|---:|")
    for key, row in rows:
        reward, drawn = ("{} ± {}".format(*row[what]) for what in ("reward", "drawn"))
        solved = f"{row['solved']} of {row['episodes']}"
        lines.append(f"| `{key}` | {row['algorithm'].upper()} | {row['steps']:,} | {reward} | {solved} | {drawn} |")
    return [
        *lines, "",
        "± is the 95 % confidence interval of the mean; *random policy* is its mean return in the same episodes.",
        f"They are of `{rows[0][1]['env']}`: `sitl rollout {rows[0][0]} --episodes {rows[0][1]['episodes']} "
        f"--seed {rows[0][1]['seed']}` repeats the first row; [baselines](../baselines.md) has more. What v1 pays, and",
        "how often they succeed there, is in [rewards](../rewards.md).",
    ]  # fmt: skip


def chosen(task: Any, names: str) -> str:
    """Values of arguments in this environment, as far as the task tells."""
    values = [vars(task).get(name.strip(), vars(task).get(f"_{name.strip()}")) for name in names.split(",")]
    kinds = bool | int | float | str | tuple
    plain = [value for value in values if isinstance(value, kinds) and not isinstance(value, Arena)]
    return ", ".join(str(value) for value in plain) if len(plain) == len(values) else ""


def arguments(task: Any) -> list[tuple[str, str]]:
    """Names and descriptions of the task's arguments; those of base classes come last."""
    found: dict[str, str] = {}
    for cls in type(task).__mro__:
        _, _, text = ((cls.__doc__ and inspect.getdoc(cls)) or "").partition("\nArgs:\n")
        lines = [line.strip().partition(": ") for line in re.sub(r"\n {8}", " ", text).splitlines() if ": " in line]
        found |= {name: what for name, _, what in lines if name not in found}
    hidden = ("others", "rewards", *UNUSED.get(type(task).__name__, ()))
    return [(name, what) for name, what in found.items() if name not in hidden]


def page(name: str) -> str:
    """The page of an id without "sitl/" and its version."""
    title, summary = TITLES[name]
    continuous, discrete = (gym.make(f"sitl/{name}{form}-v1") for form in ("", "Discrete"))
    env: Any = continuous.unwrapped
    task, spec = env.task, continuous.spec
    text = (inspect.getdoc(type(task)) or "").partition("\nArgs:\n")[0]
    box = task.arena
    seconds = spec.max_episode_steps * env.step_time
    setpoint, frame = env.session.action.setpoint.name, "forward, left, up: x, y, z axes turned by the robot's yaw"
    shows = "The task seen from above, and an episode of the trained policy in the colours of its speed"
    picture = f"![{shows}](images/{name}.png)"
    lines = [
        f"# {title}", "", "<!-- Made by python docs/make_environment_pages.py -->", "", summary, "",
        "```python", "import gymnasium as gym", "", f'env = gym.make("sitl.envs:sitl/{name}-v1")          # continuous',
        f'env = gym.make("sitl.envs:sitl/{name}Discrete-v1")  # discrete', "```", "",
        picture if (HERE / "images" / f"{name}.png").exists() else "", "",
        "| | |", "|---|---|",
        f"| robot | `{env.robot.name}`, with the whole autopilot |",
        f"| world | {world(spelling(name), env)} |",
        f"| action space | `{continuous.action_space}` or `{discrete.action_space}`: {setpoint} set-points |",
        f"| observation space | {space(continuous.observation_space)} |",
        f"| step | {number(env.step_time)} s ({number(1.0 / env.step_time)} Hz) |",
        f"| time limit | {spec.max_episode_steps} steps ({number(seconds)} s), then `truncated` |",
        f"| arena | x {number(box.low[0])} .. {number(box.high[0])}, y {number(box.low[1])} .. {number(box.high[1])}, "
        f"z {number(box.low[2])} .. {number(box.high[2])} m{' in the first world' if env.session.varies else ''} |",
        "", "## Observations", "",
        f"{frame[0].upper()}{frame[1:]}. Values are clipped to min and max; they are not normalised.",
        "`env.unwrapped.session.observation.columns` has the names.", "", *observations(env),
        "", "## Actions", "", *actions(env, discrete.unwrapped),
        "", "## Reward", "", text.strip().replace("``", "`"), "",
        "## Start and end", "",
        "An episode starts at the world's start pose" + (", in the air." if name.startswith("Copter") else "."),
        "It terminates",
        "", *ends(task), "", *judged(spelling(name), task),
        "", f"## Arguments of the task: `task={type(task).__name__}(...)`", "",
        f"`from {type(task).__module__} import {type(task).__name__}`", "",
        "| argument | value here | meaning |", "|---|---:|---|",
        *(f"| `{a}` | {chosen(task, a)} | {b.strip().replace('``', '`')} |" for a, b in arguments(task)),
        "", "All [options](../environments.md) of `sitl/Navigate-v1` can be changed, too: observations, set-points,",
        "worlds, wind, faults, a vehicle at a connection.",
        *baseline(name),
        "", "## Version history", "", *versions(name, task), "",
    ]  # fmt: skip
    continuous.close()
    discrete.close()
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines))


def ceiling(task: Any) -> str:
    """Where a task ends above its ceiling."""
    height = getattr(task, "ceiling", None) if task.flies else None
    return "" if height is None else f", or higher than {number(height)} m above the floor"


def ends(task: Any) -> list[str]:
    """What ends an episode."""
    lines = [f"- with a crash, when the robot touches an obstacle: reward {number(task.crash_reward)};"]
    if task.floor_ends and task.flies:
        lines.append("- when a copter sinks to the floor, which is a crash, too;")
    if task.out_ends:
        lines.append(
            f"- more than 5 m outside of the arena{ceiling(task)}: {number(task.out_reward)} is added to the reward;"
        )
    return [*lines, "- as the section on the reward says."]


def judged(preset: str, task: Any) -> list[str]:
    """By what a task judges, and what neither floor nor arena do."""
    lines = [
        "Reward, success and end are judged by where the robot really is. Observations are what the autopilot",
        'estimates; `info["estimate_error"]` is the estimate minus the truth, `info["true_pose"]` the truth.',
        '`judge="estimate"` judges by the estimate, as a vehicle at a connection is, whose true position is unknown.',
    ]
    if isinstance(task, Gates | Land):
        lines += ["The robot sees the goal: `goal` and `path` are exact, also where the estimate is not."]
    elif not getattr(task, "is_sparse", False):
        lines += ["`goal` and `path` are told from the estimate: its error is the agent's."]
    if preset in RECEIVERS:
        why = "There are no satellites in a house" if RECEIVERS[preset] == "uwb" else (
            "Success is finer than what an ordinary GPS tells"
        )  # fmt: skip
        lines += [
            f'{why}, so the robot has another receiver: `sensors="'
            f'{RECEIVERS[preset]}"` ([sensor sets](../vehicles.md#sensor-sets)); `sensors="gps"` is the ordinary one.',
        ]
    elif not isinstance(task, Gates | Land):
        lines += ["The receiver is an ordinary GPS; the radius of success, 1 m, is what it can do."]
    if not task.out_ends:
        lines += [
            "Nothing is won outside of the arena: an episode goes on there, and on the floor, which is no obstacle and",
            "does not let a copter go.",
        ]
    if getattr(task, "is_sparse", False):
        lines += [
            '`"achieved_goal"` is the estimate. `compute_reward(achieved, desired, info)` takes the `"estimate_error"`',
            "of `info` off it, and is then the reward of the step, exactly; without it, as from a replay buffer that",
            "keeps no infos, it judges by the estimate.",
        ]
    return lines


def versions(name: str, task: Any) -> list[str]:
    """What changed from version to version, and why."""
    pays = {"leave the arena": OUT_PAYS, "crash": CRASH_PAYS}
    why = [f"In v0 it pays more to {what} than to do nothing." for what, names in pays.items() if name in names]
    lost = (
        "" if isinstance(task, Gates | Land) else " Its judge is the autopilot's estimate, an error of 0.7 m included."
    )
    return [
        "- v1: judged by the truth. From whatever state, ending an episode early is worth less than whatever else",
        "  until the time limit, and staying near the goal is worth less than half of reaching it: see",
        "  [rewards](../rewards.md).",
        "- v0: first version, kept bit for bit for what was published with it; do not use it for anything new." + lost,
        *(f"  {line}" for line in why),
    ]


def world(preset: str, env: Any) -> str:
    """Where it is."""
    if preset not in TEST:
        return f"`{env.world.name}`"
    first = gym.spec(f"sitl/{camel_case(preset)}-v0").kwargs["preset"]
    return (
        f"each episode in one of `{env.session.worlds.text}`; policies are judged in others, "
        f'`world=sitl.envs.worlds.TEST["{preset}"]`; in v0 always `{PRESETS[first]()["world"]}`'
    )


def space(of: Any) -> str:
    """A space without its bounds."""
    if isinstance(of, gym.spaces.Dict):
        return ", ".join(f"`{name}`: {space(part)}" for name, part in of.items())
    return f"`Box({of.shape}, {of.dtype})`"


def index() -> str:
    """The page that lists them."""
    rows = ["# Flight and driving tasks", "", "<!-- Made by python docs/make_environment_pages.py -->", ""]
    rows += [
        "Each task has a continuous id, `sitl/NAME-v1`, and a discrete one, `sitl/NAMEDiscrete-v1`. The whole",
        "autopilot is in the loop. [Environments](../environments.md) explains what they have in common.",
        "*Trained policy* is the success rate of the [baseline](../baselines.md) of the continuous id in 200 episodes",
        "of v0. Tasks among solids are in another world in each episode of v1, and in one world in v0.",
        "[Rewards](../rewards.md) says how v1 differs from v0, and measures both.",
    ]
    for robot in ("Copter", "Rover"):
        rows += [
            "",
            f"## {robot}",
            "",
            "| task | id | step | time limit | trained policy |",
            "|---|---|---:|---:|---:|",
        ]
        for name in (name for name in TITLES if name.startswith(robot)):
            spec = gym.spec(f"sitl/{name}-v1")
            env: Any = gym.make(spec)
            seconds = env.unwrapped.step_time * (spec.max_episode_steps or math.nan)
            step = number(env.unwrapped.step_time)
            found = dict(baselines_of(name)).get(spelling(name))
            solved = f"{100 * found['solved'] / found['episodes']:.1f} %" if found else "none"
            link = f"[{TITLES[name][0]}]({name}.md)"
            rows.append(f"| {link} | `sitl/{name}-v1` | {step} s | {number(seconds)} s | {solved} |")
            env.close()
    return "\n".join(rows) + "\n"


def main() -> None:
    """Write all of them."""
    known = {name.removeprefix("sitl/").removesuffix("-v1") for name in sitl.envs.NEW if "Discrete" not in name}
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
