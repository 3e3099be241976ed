# SPDX-License-Identifier: BSD-3-Clause
"""Short runs of deep agents."""

from __future__ import annotations

import sitl.envs  # noqa: F401 (registers the environments)
from sitl.agents.deep import checkpoint, training
from sitl.agents.runs.config import RunConfig
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.watch import Watch

CIRCUIT2 = "GazeboCircuit2TurtlebotLIDAR-v0"
NAVIGATE = "sitl/Navigate-v0"
SMALL = {"robots": 4, "width": 8, "batch": 16, "check_every": 150, "check_episodes": 2}
OF = {
    "ppo": {"rollout": 16, "epochs": 2},
    "dqn": {"memory": 400, "warm_up": 40, "target_period": 50},
    "sac": {"memory": 400, "warm_up": 40},
}


def new(path, algorithm="ppo", env=CIRCUIT2, **fields):
    """The folder of a run of 400 steps in episodes of at most 50, unless told otherwise."""
    chosen = training.settings(algorithm, {**SMALL, **OF[algorithm], **fields.pop("settings", {})})
    options = {"observation": "scan", **fields.pop("env_options", {})}
    if algorithm == "sac":
        options = {"action": "continuous", "task": "wander", **options}
    length = {"episodes": None, "steps": 400, "max_steps": 50, **fields}
    return RunFolder.create(path, RunConfig(env, algorithm, env_options=options, settings=chosen, **length))


def train(run, episodes=None):
    """Train to the end, or until so many episodes are done."""
    seen = []
    training.train(run, Watch(seen.extend, lambda: episodes is not None and len(seen) >= episodes))
    return seen


def weights(run, name=checkpoint.MODEL):
    """What the networks of a model are, as bytes."""
    model, _ = checkpoint.load(run.path / name, run.config.algorithm)
    return {name: values.numpy().tobytes() for name, values in model.policy.state_dict().items()}
