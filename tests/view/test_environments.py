# SPDX-License-Identifier: BSD-3-Clause
"""Environments on the page: what is drawn is what the environment says, and learning notices nothing."""

from __future__ import annotations

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from sitl.agents.runs.files import read_arrays
from sitl.cli import main
from sitl.core.vectors import Vec3
from sitl.view.axes import to_scene

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
from sitl.envs.page.page import EnvPage
from sitl.envs.page.source import poses, states
from sitl.envs.page.watchers import Directly, InClips
from sitl.view.layout import GRID, ONE
from sitl.view.page import Page

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"


def test_human_opens_the_page_and_draws_the_robot(capsys: pytest.CaptureFixture[str]) -> None:
    env = gym.make(CIRCUIT2, render_mode="human")
    env.reset(seed=1)
    assert "page: http://127.0.0.1:" in capsys.readouterr().out
    inner = env.unwrapped
    watcher = inner._watcher
    assert isinstance(watcher, Directly)
    total = sum(float(env.step(action)[1]) for action in (0, 1, 0, 2))
    page = watcher.page
    page.capture(1.0)
    page.wait_drawn()
    frame, state = page.frame, states(inner.robot)
    assert frame is not None and frame.mode == "episode 1"
    assert tuple(page.scene.vehicle.body.position) == pytest.approx(tuple(state[0, :3]), abs=1e-6)
    assert frame.signals["return"] == pytest.approx(total) and frame.signals["action[0]"] == 2.0
    assert frame.scan is not None and len(frame.scan) == np.sum(inner.robot.scan[0] <= inner.robot.range_max)
    page.plots.add("observation[0]")
    assert env.render() is None
    env.close()
    env.close()


def test_many_robots_are_a_grid_or_share_one_world() -> None:
    env = gym.make_vec(CIRCUIT2, num_envs=9, render_mode="human")
    env.reset(seed=1)
    env.step(np.zeros(9, int))
    page = env.unwrapped._watcher.page
    source, state = page.env_source, states(env.unwrapped.robot)

    def drawn() -> np.ndarray:
        page.capture(1.0)
        page.wait_drawn()
        node, which = page.scene.company.nodes[0]
        assert which.tolist() == list(range(9))
        return np.array(node.batched_positions)

    assert source.layout == GRID
    apart = drawn() - state[:, :3]
    assert np.allclose(apart, source.stage.copies, atol=1e-4) and len(np.unique(apart.round(3), axis=0)) == 9
    page.layout.value = ONE
    assert np.allclose(drawn(), state[:, :3], atol=1e-4)
    page.vehicle_number.value = 5
    drawn()
    assert page.frame is not None and page.frame.company is not None and page.frame.company.chosen == 4
    assert tuple(page.scene.vehicle.body.position) == pytest.approx(tuple(state[4, :3]), abs=1e-6)
    env.close()


@pytest.mark.parametrize("count", [1, 3])
def test_clips_are_taken_when_somebody_looks_and_are_played(monkeypatch: pytest.MonkeyPatch, count: int) -> None:
    seen = [False]
    monkeypatch.setattr(Page, "is_seen", property(lambda self: seen[0]))
    env = gym.make_vec(CIRCUIT2, num_envs=count) if count > 1 else gym.make(CIRCUIT2)
    inner = env.unwrapped
    page = EnvPage(inner.session, CIRCUIT2)
    watcher = InClips(page, inner.step_time)
    inner.watch(watcher)
    watcher.clips.speed.value = "50"

    def drive() -> None:
        env.reset(seed=1)
        for _ in range(12):
            env.step(np.zeros(count, int) if count > 1 else 0)

    drive()
    assert watcher._taken is None and watcher.clips.played == 0, "nobody looks"
    seen[0] = True
    for _ in range(1_000_000):
        drive()
        if watcher.clips.played:
            break
    assert page.frame is not None and page.frame.time_us > 0
    env.close()
    page.close()


def test_observations_and_rewards_are_the_same_bits_with_a_page() -> None:
    def run(mode: str | None) -> list[bytes]:
        env = gym.make(CIRCUIT2, render_mode=mode)
        out = [np.asarray(env.reset(seed=4)[0]).tobytes()]
        for k in range(40):
            observation, reward, ended, _, _ = env.step(k % 3)
            out += [np.asarray(observation).tobytes(), np.float64(reward).tobytes()]
            if ended:
                out.append(np.asarray(env.reset()[0]).tobytes())
        env.close()
        return out

    assert run("human") == run(None)


def test_a_pose_is_turned_into_the_simulators_axes() -> None:
    state = np.zeros((1, 12))
    state[0, :4] = 3.0, 2.0, 1.0, 0.5 * np.pi
    pos, _ = poses(state, 0.25)
    assert pos[0] == pytest.approx((3.0, -1.75, -1.0)), "the body is 0.25 m behind its base, which looks to the left"
    assert to_scene(Vec3(*pos[0])) == pytest.approx((3.0, 1.75, 1.0))


def test_a_training_that_is_shown_learns_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["train", CIRCUIT2, "--episodes", "6", "--max-steps", "30", "--seed", "2"]
    tables = []
    for name, more in (("shown", ["--view"]), ("unseen", [])):
        assert main([*words, "--out", str(tmp_path / name), *more]) == 0
        tables.append(read_arrays(tmp_path / name / "model.npz"))
    assert capsys.readouterr().out.count("page: http://127.0.0.1:") == 1
    assert all(np.array_equal(tables[0][name], tables[1][name]) for name in tables[0])
    assert main([*words, "--out", str(tmp_path / "many"), "--view", "--jobs", "2"]) == 2
