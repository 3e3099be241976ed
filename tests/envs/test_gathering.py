# SPDX-License-Identifier: BSD-3-Clause
"""What one compiled call gathers is what the parts write one by one."""

from __future__ import annotations

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest

from sitl.envs.boxes import Parts
from sitl.envs.parts import Path
from sitl.envs.targets.hold import Hold
from sitl.envs.targets.moving import Follow

ALL = [
    "pose", "velocity", "attitude", "rates", "true_pose", "true_velocity", "heading", "acceleration", "true_wind",
    "height", "scan", "digits", "last_action", "goal", "path",
]  # fmt: skip


def vector(**options):
    made = gym.make_vec(
        "sitl/CopterCourse-v1", num_envs=3, vectorization_mode="vector_entry_point", observation=ALL, **options
    )
    made.action_space.seed(0)
    made.reset(seed=0)
    return made


def written(parts: Parts, robot) -> np.ndarray:
    """The observation, part by part."""
    out = np.empty((robot.count, len(parts.columns)), np.float32)
    for part, where in zip(parts._parts, parts.slices.values()):
        part.write(out[:, where])
    space = parts.space(robot)
    return np.clip(out, space.low, space.high)


@pytest.mark.parametrize("form", ["normalised", "discrete"])
def test_gathered_numbers_are_those_that_parts_write(form):
    env = vector(action=form)
    session = env.unwrapped.session
    for _ in range(5):
        found = env.step(env.action_space.sample())[0]
        assert found.tobytes() == written(session.observation, session.robot).tobytes()


def test_a_copy_gathers_from_its_own_robot():
    env = gym.make("sitl/CopterCourse-v1", observation=ALL).unwrapped
    env.reset(seed=0)
    action = np.full(4, 0.5, np.float32)
    env.step(action)
    others = pickle.loads(pickle.dumps(env)), copy.deepcopy(env)
    wanted = [env.step(action) for _ in range(3)]
    for other in others:
        for step in wanted:
            found = other.step(action)
            assert found[0].tobytes() == step[0].tobytes() and found[1] == step[1]
            assert {k: np.asarray(v).tobytes() for k, v in found[4].items()} == {
                k: np.asarray(v).tobytes() for k, v in step[4].items()
            }


def test_numbers_beyond_their_bounds_are_clipped_and_nan_stays():
    env = vector()
    session = env.unwrapped.session
    at = session.observation.slices["velocity"].start
    session.robot.state[:, 4] = 1e3, -1e3, np.nan
    found = env.unwrapped.observe()[:, at]
    assert found[:2].tolist() == [50.0, -50.0] and np.isnan(found[2])


class FromTheTruth(Path):
    """A part of one's own on one of ours."""

    def write(self, out):
        out[:] = self._task.offsets_from(self.robot.true_state(), 1).reshape(out.shape)

    def prepare(self, session):
        super().prepare(session)
        self.robot = session.robot


def test_a_part_with_a_write_of_its_own_is_written_by_it():
    env = gym.make("sitl/CopterHover-v1", observation=[FromTheTruth(1), "goal"]).unwrapped
    env.reset(seed=1)
    row = env.step(np.zeros(4, np.float32))[0]
    way = env.session.task.targets[0] - env.session.robot.true_state()[0, :3]
    assert np.linalg.norm(row[:3]) == pytest.approx(np.linalg.norm(way), abs=1e-5)
    assert (row[:3] != row[3:]).all()


class HigherGoals(Hold):
    def offsets_from(self, pose, count):
        return super().offsets_from(pose, count) + (0.0, 0.0, 100.0)


class Standing(Follow):
    def along(self, time):
        return self.centre[:, None] + np.zeros((*time.shape, 3))


def test_a_task_with_ways_of_its_own_is_asked_for_them():
    env = gym.make("sitl/CopterHover-v1", task=HigherGoals(), observation=["goal"]).unwrapped
    env.reset(seed=1)
    assert env.step(np.zeros(4, np.float32))[0][2] > 90.0


def test_a_target_moves_as_its_class_says():
    env = gym.make("sitl/CopterFollow-v1", task=Standing(), observation=["path"]).unwrapped
    env.reset(seed=1)
    task = env.session.task
    for _ in range(10):
        row = env.step(np.zeros(4, np.float32))[0]
        assert (task.targets == task.centre).all()
        assert row.reshape(3, 3) == pytest.approx(row[:3] * np.ones((3, 1)))
