# SPDX-License-Identifier: BSD-3-Clause
"""``sitl envs``: the environments; of one, what it observes and does."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import Any

import gymnasium as gym

from sitl.cli.output import add_json_option, print_json
from sitl.errors import OptionError, did_you_mean

from .ids import FIRST, NEW, PAPER, TASKS, camel_case, task_of

ANY = "sitl/Navigate-v1"
_FEW = 20
"""Columns of an observation that are printed one by one."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "envs",
        description="Without an id, lists the environments. An option of an environment replaces what an id has: "
        "gymnasium.make(ID, world='maze') (sitl help environments).",
    )
    parser.add_argument("id", nargs="?", metavar="ID", help="describe this one: its observation, actions and limits")
    add_json_option(parser, "a list of environments")
    parser.set_defaults(function=envs)


def envs(options: argparse.Namespace) -> int:
    """Print the list, or all about one.

    Raises:
        OptionError: there is no such id.
    """
    listed = dict(ids())
    if options.id is None:
        if options.json:
            print_json([{"id": name, "aim": aim} for name, aim in listed.items()])
        else:
            width = max(map(len, listed))
            print(*(f"{name:{width}s}  {aim}" for name, aim in listed.items()), sep="\n")
            print("\nsitl envs ID tells what one observes and does")
        return 0
    listed |= dict(_first())
    name = next((known for known in listed if options.id in (known, known.removeprefix("sitl/"))), None)
    if name is None:
        raise OptionError(
            f"environment {options.id!r} is not known{did_you_mean(options.id, listed) or '; sitl envs lists them'}"
        )
    row = {"id": name, "aim": listed[name], **description(name)}
    if options.json:
        print_json([row])
    else:
        print(*lines(row), sep="\n")
    return 0


def ids() -> Iterator[tuple[str, str]]:
    """(Id, what is to be done) of every environment."""
    yield ANY, "Any robot, world and task: options say which."
    for name, preset in PAPER.items():
        world, _, robot = preset.partition("-")
        yield name, f"Of the paper: {robot.replace('-', ' ')} in the world {world}, by lidar. Discrete actions."
    for name, listed in NEW.items():
        yield name, _aim(listed.preset)


def _first() -> Iterator[tuple[str, str]]:
    """The same of first versions."""
    yield ANY.replace("v1", "v0"), "Judged by the estimate: use v1."
    for name, listed in FIRST.items():
        yield name, f"{_aim(listed.preset)} First version, for what was published with it: use v1."


def _aim(preset: str) -> str:
    return TASKS[task_of(preset)].aim + (" Discrete actions." if "discrete" in preset else "")


def description(name: str) -> dict[str, Any]:
    """What an environment has, as plain values."""
    made: Any = gym.make(name)
    session = made.unwrapped.session
    action = session.action
    moves = list(action.names) if hasattr(action, "names") else [action.setpoint.columns[c] for c in action.columns]
    row = {
        "robot": session.robot.name,
        "world": session.worlds.text,
        "task": type(session.task).__name__,
        "step_s": session.seconds,
        "max_episode_steps": made.spec.max_episode_steps,
        "observation_space": space_text(made.observation_space),
        "observation": list(getattr(session.observation, "columns", ())),
        "action_space": space_text(made.action_space),
        "action": moves,
        "setpoint": action.setpoint.name,
    }
    made.close()
    return row


def space_text(space: gym.Space[Any]) -> str:
    """A space in a line: of a box, shape and type; its limits are on the environment's page."""
    if isinstance(space, gym.spaces.Dict):
        return f"Dict({', '.join(f'{name}: {space_text(part)}' for name, part in space.items())})"
    return f"Box({space.shape}, {space.dtype})" if isinstance(space, gym.spaces.Box) else str(space)


def lines(row: dict[str, Any]) -> Iterator[str]:
    """A description for people."""
    yield f"{row['id']}: {row['aim']}\n"
    steps, seconds = row["max_episode_steps"], row["step_s"]
    yield f"  robot        {row['robot']} in world {row['world']}, task {row['task']}"
    yield f"  time         steps of {seconds:g} s, truncated after {steps} ({steps * seconds:g} s)"
    yield f"  observation  {row['observation_space']}"
    columns = row["observation"]
    for column in columns if len(columns) <= _FEW else (*columns[:_FEW], "...", columns[-1]):
        yield f"                 {column}"
    yield f"  action       {row['action_space']}, set-point {row['setpoint']}"
    for move in row["action"]:
        yield f"                 {move}"
    version = NEW | FIRST
    preset = task_of(version[row["id"]].preset) if row["id"] in version else None
    if preset is not None:
        policy = preset + "-discrete" if "Discrete" in row["id"] else preset
        command = f"sitl rollout {policy} {row['id']} --episodes 20"
        yield f"\n  {command:72s}  a trained policy that comes with the package"
        yield f"  {f'sitl help {camel_case(preset)}':72s}  its page: reward, ends of an episode, results"
    else:
        yield ""
    yield f'  gymnasium.make("sitl.envs:{row["id"]}")'
