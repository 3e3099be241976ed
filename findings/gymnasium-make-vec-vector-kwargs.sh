#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# gymnasium 1.4.0, make_vec: one call asks for an autoreset mode of most ids, and raises for some. vector_kwargs is for the vector
# environment's constructor, and so vector_kwargs={"autoreset_mode": ...} works with SyncVectorEnv and AsyncVectorEnv. An id with a
# vector_entry_point uses that by default, and for it make_vec refuses any vector_kwargs: "can be passed arguments only through
# kwargs". There the same argument goes straight to make_vec, which in turn fails for ids without a vector_entry_point: it reaches
# the single environment's constructor. A program that takes any id must look at spec(id).vector_entry_point first.
# Seen: the lines below. Fails if one of the calls is taken otherwise.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q gymnasium==1.4.0
"$work/venv/bin/python" - <<'PYTHON'
import gymnasium as gym
from gymnasium.vector import AutoresetMode, VectorEnv


class Custom(VectorEnv):
    """Takes the mode as an argument, as an id's vector_entry_point may."""

    def __init__(self, num_envs, max_episode_steps=None, autoreset_mode=AutoresetMode.NEXT_STEP):
        self.num_envs, self.metadata = num_envs, {"autoreset_mode": autoreset_mode}


gym.register("Custom-v0", entry_point="gymnasium.envs.classic_control:PendulumEnv", vector_entry_point=Custom)
mode = AutoresetMode.SAME_STEP
found = {}
for name in ("Pendulum-v1", "Custom-v0"):
    for how, given in (("vector_kwargs", {"vector_kwargs": {"autoreset_mode": mode}}), ("kwargs", {"autoreset_mode": mode})):
        try:
            found[name, how] = gym.make_vec(name, num_envs=2, **given).metadata["autoreset_mode"].value
        except (gym.error.Error, TypeError) as error:
            found[name, how] = type(error).__name__
        print(f"{name}, {how}: {found[name, how]}")
assert found["Pendulum-v1", "vector_kwargs"] == found["Custom-v0", "kwargs"] == "SameStep"
assert found["Custom-v0", "vector_kwargs"] == "Error" and found["Pendulum-v1", "kwargs"] == "TypeError"
PYTHON
