# SPDX-License-Identifier: BSD-3-Clause
"""``sitl envs``: the lines that describe an environment, and which ids are listed."""

from __future__ import annotations

import argparse
import json
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs import listing
from sitl.errors import OptionError

ROW = {
    "id": "sitl/CopterHover-v1", "aim": "Hover.", "robot": "erle_copter", "world": "open", "task": "Hold",
    "step_s": 0.05,
    "max_episode_steps": 200, "observation_space": "Box((3,), float32)", "observation": ["a", "b", "c"],
    "action_space": "Discrete(2)", "action": ["up", "down"], "setpoint": "velocity",
}  # fmt: skip


def lines(**changes: Any) -> list[str]:
    return list(listing.lines({**ROW, **changes}))


def parsed(*words: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    listing.add_parser(parser.add_subparsers())
    return parser.parse_args(["envs", *words])


@pytest.mark.parametrize(
    ("space", "text"),
    [
        (gym.spaces.Box(0.0, 1.0, (2, 3), np.float32), "Box((2, 3), float32)"),
        (gym.spaces.Discrete(4), "Discrete(4)"),
        (gym.spaces.Dict({"a": gym.spaces.Box(0, 9, (1,), np.uint8), "b": gym.spaces.Discrete(2)}),
         "Dict(a: Box((1,), uint8), b: Discrete(2))"),
    ],
)  # fmt: skip
def test_a_space_in_a_line(space: Any, text: str) -> None:
    assert listing.space_text(space) == text


def test_a_description_for_people() -> None:
    said = lines()
    assert said[0] == "sitl/CopterHover-v1: Hover.\n"
    assert said[1] == "  robot        erle_copter in world open, task Hold"
    assert said[2] == "  time         steps of 0.05 s, truncated after 200 (10 s)"
    assert said[3] == "  observation  Box((3,), float32)"
    assert [line.strip() for line in said[4:7]] == ["a", "b", "c"]
    assert said[7] == "  action       Discrete(2), set-point velocity"
    assert [line.strip() for line in said[8:10]] == ["up", "down"]
    assert said[-1] == '  gymnasium.make("sitl.envs:sitl/CopterHover-v1")'


@pytest.mark.parametrize(("count", "shown"), [(20, 20), (21, 22), (400, 22)])
def test_of_many_columns_the_first_twenty_and_the_last_are_shown(count: int, shown: int) -> None:
    said = lines(observation=[f"range {k}" for k in range(count)])
    ranges = [line.strip() for line in said if "range" in line or line.strip() == "..."]
    assert len(ranges) == shown and ranges[19] == "range 19" and ranges[-1] == f"range {count - 1}"
    assert ("..." in ranges) == (count > 20)


def test_an_id_has_its_policy_and_its_page() -> None:
    said = "\n".join(lines())
    assert "sitl rollout copter-hover sitl/CopterHover-v1 --episodes 20 " in said
    assert "sitl help CopterHover" in said
    discrete = "\n".join(lines(id="sitl/CopterHoverDiscrete-v1"))
    assert "sitl rollout copter-hover-discrete sitl/CopterHoverDiscrete-v1" in discrete
    assert "sitl help CopterHover " in discrete
    other = "\n".join(lines(id="sitl/Navigate-v1"))
    assert "rollout" not in other and "sitl help" not in other


def test_ids_and_aims(capsys: pytest.CaptureFixture[str]) -> None:
    options = parsed()
    assert options.function(options) == 0
    said = capsys.readouterr().out
    rows = [line.split("  ", 1) for line in said.splitlines() if line and "sitl envs ID" not in line]
    found = {name.strip(): aim.strip() for name, aim in rows}
    assert found["sitl/Navigate-v1"] == "Any robot, world and task: options say which."
    assert found["GazeboMazeErleRoverLIDAR-v0"].startswith("Of the paper: ")
    assert found["sitl/CopterHoverDiscrete-v1"] == found["sitl/CopterHover-v1"] + " Discrete actions."
    assert said.endswith("\nsitl envs ID tells what one observes and does\n") and "-v0" in said
    assert "sitl/CopterHover-v0" not in found, "first versions are not listed"
    options = parsed("--json")
    assert options.function(options) == 0
    assert {row["id"]: row["aim"] for row in json.loads(capsys.readouterr().out)} == found


def test_a_description_says_what_an_environment_has(capsys: pytest.CaptureFixture[str]) -> None:
    name, seen = "GazeboCircuit2TurtlebotLIDAR-v0", []
    for words in ((name,), (name, "--json")):
        options = parsed(*words)
        assert options.function(options) == 0
        seen.append(capsys.readouterr().out)
    (row,) = json.loads(seen[1])
    assert (row["id"], row["robot"], row["world"], row["task"]) == (name, "turtlebot", "circuit2", "Task")
    assert (row["step_s"], row["max_episode_steps"], row["setpoint"]) == (0.6, 1500, "drive")
    assert (row["action"], row["action_space"]) == (["forward", "left", "right"], "Discrete(3)")
    assert row["observation"] == [] and row["observation_space"] == "MultiDiscrete([21 21 21 21 21])"
    assert seen[0].startswith(f"{name}: Of the paper: turtlebot in the world circuit2, by lidar.")


def test_an_id_that_is_not_known_is_named() -> None:
    options = parsed("CopterHovr-v1")
    with pytest.raises(OptionError, match=r"environment 'CopterHovr-v1' is not known; did you mean"):
        options.function(options)
    options = parsed("xyz")
    with pytest.raises(OptionError, match="environment 'xyz' is not known; sitl envs lists them"):
        options.function(options)
