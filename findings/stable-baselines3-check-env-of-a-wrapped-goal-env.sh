#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# stable-baselines3 2.9.2 with gymnasium 1.4.0, check_env: it looks for compute_reward on env.unwrapped, and then calls it on env itself.
# Wrappers of Gymnasium 1.x do not pass attributes on, and gymnasium.make wraps every environment. So a goal-conditioned
# environment that is right, made by gymnasium.make, fails with AttributeError of a wrapper; the bare one passes, and HER trains with the
# wrapped one.
# Seen: the lines below. Fails if check_env takes the environment that gymnasium.make returns.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q stable-baselines3==2.9.2 gymnasium==1.4.0
"$work/venv/bin/python" - <<'PYTHON'
import gymnasium as gym
import numpy as np
from gymnasium import spaces
from stable_baselines3 import DQN, HerReplayBuffer
from stable_baselines3.common.env_checker import check_env


class Line(gym.Env):
    """Go to a place on a line."""

    def __init__(self):
        place = spaces.Box(-1.0, 1.0, (1,), np.float32)
        self.observation_space = spaces.Dict(observation=place, achieved_goal=place, desired_goal=place)
        self.action_space = spaces.Discrete(2)

    def compute_reward(self, achieved_goal, desired_goal, info):
        return -(np.abs(achieved_goal - desired_goal)[..., 0] > 0.1).astype(np.float32)

    def look(self):
        return {"observation": self.at.copy(), "achieved_goal": self.at.copy(), "desired_goal": self.goal.copy()}

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.at, self.goal = self.np_random.uniform(-1.0, 1.0, (2, 1)).astype(np.float32)
        return self.look(), {}

    def step(self, action):
        self.at = np.clip(self.at + np.float32(0.2 * action - 0.1), -1.0, 1.0)
        return self.look(), float(self.compute_reward(self.at, self.goal, {})), False, False, {}


gym.register("Line-v0", entry_point=Line, max_episode_steps=20)
check_env(Line())
print("the environment itself: taken")
try:
    check_env(gym.make("Line-v0"))
    raised = None
except AttributeError as error:
    raised = error
print(f"as gymnasium.make returns it: {raised!r}")
assert raised is not None and "compute_reward" in str(raised)
DQN("MultiInputPolicy", gym.make("Line-v0"), replay_buffer_class=HerReplayBuffer, learning_starts=50).learn(100)
print("DQN with HerReplayBuffer trains with it")
PYTHON
