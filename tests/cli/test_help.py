# SPDX-License-Identifier: BSD-3-Clause
"""``sitl help`` and ``sitl envs``: what a user reads who has only the installed package."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path

import gymnasium as gym
import pytest

import sitl
from sitl.cli import main
from sitl.cli.help import pages, title
from sitl.envs import ids, listing

PACKAGE = Path(sitl.__file__).parent
DOCS = PACKAGE.parent / "docs"


def texts() -> Iterator[tuple[Path, str]]:
    """Each text of the package that is no docstring, with its file."""
    for file in PACKAGE.rglob("*.py"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        bare = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in bare:
                yield file, node.value


def test_messages_name_pages_that_an_installed_package_has() -> None:
    named = set()
    for file, text in texts():
        assert not re.search(r"\bdocs/[\w/-]+\.md", text), f"{file}: {text!r}: name the page as `sitl help PAGE`"
        named |= set(re.findall(r"sitl help ([\w/-]+)", text))
    assert len(named) >= 8 and named <= set(pages())


def test_every_page_has_a_name_of_its_own() -> None:
    left_out = {*DOCS.glob("templates/*"), *DOCS.rglob("index.md")}
    assert set(pages().values()) == {*DOCS.rglob("*.md")} - left_out
    assert pages()["swarm"] == DOCS / "swarm.md" and pages()["tutorials/swarm"] == DOCS / "tutorials/swarm.md"


def test_the_list_and_a_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(pages()) + 2 and "faults" + " " * 20 + " Fault injection" in "\n".join(lines)
    for topic in ("faults", "docs/faults.md", "faults.md"):
        assert main(["help", topic]) == 0
        assert capsys.readouterr().out == (DOCS / "faults.md").read_text(encoding="utf-8")
    assert main(["help", "CopterHover"]) == 0
    assert "<!--" not in capsys.readouterr().out
    assert title(pages()["CopterHover"]) == "Hover in wind"


def test_a_topic_that_is_no_page(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help", "fault"]) == 2
    assert capsys.readouterr().err == "sitl help: there is no page 'fault'; did you mean 'faults'?\n"
    with pytest.raises(SystemExit) as leave:
        main(["help", "params"])
    assert leave.value.code == 0 and capsys.readouterr().out.startswith("usage: sitl params")


def test_every_environment_is_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["envs", "--json"]) == 0
    listed = {row["id"]: row["aim"] for row in json.loads(capsys.readouterr().out)}
    assert set(listed) == {listing.ANY, *ids.PAPER, *ids.NEW}
    registered = {name for name in gym.registry if name.startswith(("sitl/", "Gazebo"))}
    old = {*ids.FIRST, "sitl/Navigate-v0"}
    assert set(listed) == {name for name in registered - old if "Lidar" not in name}, (
        "the original code's spelling aside"
    )
    assert all(listed.values())


@pytest.mark.parametrize("name", ["sitl/CopterForest-v1", "sitl/CopterHoverDiscrete-v0", "GazeboMazeErleRoverLIDAR-v0"])
def test_a_description_says_what_the_environment_has(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["envs", name, "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    made = gym.make(name)
    assert row["max_episode_steps"] == made.spec.max_episode_steps
    action, session = made.action_space, made.unwrapped.session
    assert len(row["action"]) == (action.n if isinstance(action, gym.spaces.Discrete) else action.shape[0])
    if row["observation"]:
        assert len(row["observation"]) == made.observation_space.shape[0]
    assert row["robot"] == session.robot.name and row["step_s"] == session.seconds
    made.close()
    assert main(["envs", name.removeprefix("sitl/")]) == 0
    said = capsys.readouterr().out
    assert said.startswith(f"{name}: ") and all(move in said for move in row["action"])
    if name in ids.NEW | ids.FIRST:
        (topic,) = re.findall(r"sitl help (\w+)", said)
        assert topic in pages()
        from sitl.agents import baselines

        assert re.findall(r"sitl rollout (\S+)", said)[0] in baselines.names()


def test_an_unknown_environment(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["envs", "CopterHovr-v0"]) == 2
    assert "did you mean 'sitl/CopterHover-v0'?" in capsys.readouterr().err
