#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# gymnasium 1.4.0, wrappers.vector.VectorizeTransformAction (so ClipAction, too): where the action space stays the same, the
# transformed actions are written into the array that the caller gave to step(). A learner that keeps this array, as a replay
# or rollout buffer does, has other actions than those that its policy chose, and the log-probabilities do not belong to them. With
# another action space (RescaleAction) the caller's array stays as it was; so it does with the wrappers of single environments.
# Seen: the lines below. Fails if the first array stays as it was, or the second one does not.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q gymnasium==1.4.0
"$work/venv/bin/python" - <<'PYTHON'
import gymnasium as gym
import numpy as np
from gymnasium.wrappers import TransformAction
from gymnasium.wrappers.vector import RescaleAction, VectorizeTransformAction

robots = gym.make_vec("MountainCarContinuous-v0", num_envs=3)
space = robots.single_action_space
halved = VectorizeTransformAction(robots, wrapper=TransformAction, func=lambda a: 0.5 * a, action_space=space)
halved.reset(seed=1)
chosen = np.array([[0.8], [-0.4], [0.2]], np.float32)
halved.step(chosen)
print(f"the same space: chosen 0.8, -0.4, 0.2; after step() {chosen.ravel().tolist()}")
assert np.allclose(chosen, [[0.4], [-0.2], [0.1]])
halved.step(chosen)
assert np.allclose(chosen, [[0.2], [-0.1], [0.05]]), "the same array again: halved again"

rescaled = RescaleAction(gym.make_vec("MountainCarContinuous-v0", num_envs=3), -2.0, 2.0)
rescaled.reset(seed=1)
chosen = np.array([[0.8], [-0.4], [0.2]], np.float32)
rescaled.step(chosen)
print(f"another space: after step() {chosen.ravel().tolist()}")
assert np.allclose(chosen, [[0.8], [-0.4], [0.2]])
PYTHON
