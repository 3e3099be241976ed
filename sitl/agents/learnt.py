# SPDX-License-Identifier: BSD-3-Clause
"""A learnt policy with what it was learnt in, from the folder of a run or from a file of its own."""

from __future__ import annotations

from collections.abc import Container
from pathlib import Path
from typing import NamedTuple

from sitl.core import code_in_files
from sitl.errors import did_you_mean

from . import algorithms, baselines, environments
from .algorithms import Policy
from .deep import onnx_file, policy_file
from .deep.policy import DeepPolicy
from .errors import AgentError
from .runs.config import RunConfig
from .runs.folder import RunFolder


class Learnt(NamedTuple):
    """A policy."""

    config: RunConfig
    """Environment, options and longest episode that it was learnt in."""
    policy: Policy
    step_time: float
    """Simulated time of a step in that environment [s]: the rate that it was learnt at."""


def load(path: Path, replaced: Container[str] = ()) -> Learnt:
    """The policy of a run's folder, or of a file (.npz) that ``save`` wrote.

    Args:
        path: of the folder or file.
        replaced: options of the environment in whose place others come, so that it does not matter what the file says
            of them.

    Raises:
        AgentError: there is none, or it reaches outside of this process and the user has not said so.
    """
    if path.suffix != policy_file.SUFFIX:
        if not path.is_dir():
            raise AgentError(_no_policy(path))
        run = RunFolder(path, replaced)
        kept = code_in_files.without(run.config.env_options, replaced)
        return Learnt(run.config, algorithms.policy_of(run), _step_time(run.config.with_(env_options=kept)))
    about, policy = policy_file.read(path)
    try:
        config = RunConfig(
            about["env"], about["algorithm"], about["options"], episodes=1, max_steps=about["max_steps"],
            versions=about["versions"],
        )  # fmt: skip
        step_time = float(about["step_time"])
    except (KeyError, TypeError, ValueError) as error:
        raise AgentError(f"{path} is no file of a policy: {error}") from None
    refused = code_in_files.refusal(path, config.code_but(replaced))
    if refused is not None:
        raise AgentError(refused)
    return Learnt(config, policy, step_time)


def policy_of(path: Path) -> Policy:
    """The policy alone, whatever it was learnt in.

    Raises:
        AgentError: see ``load``.
    """
    if path.suffix == policy_file.SUFFIX:
        return policy_file.read(path)[1]
    return algorithms.policy_of(RunFolder(path, code_in_files.EVERY))


def _no_policy(path: Path) -> str:
    what = "is not" if path.exists() else "is not there, and no name of"
    hint = did_you_mean(str(path), baselines.names())
    if path.suffix == onnx_file.SUFFIX:
        hint = "; .onnx is for other programs: export it as .npz"
    return (
        f"{path} {what} a policy: a policy is the folder of a run (sitl train), a file {policy_file.SUFFIX} "
        f"of `sitl export`, or the name of a baseline{hint}"
    )


def save(run: RunFolder, path: Path) -> None:
    """Write what a run has learnt: as .npz for this program and for NumPy, or as .onnx for others.

    Raises:
        AgentError: another ending, a table (which is no network), or a file that cannot be written.
        MissingExtra: .onnx needs the package onnx.
    """
    kinds = {policy_file.SUFFIX: policy_file.write, onnx_file.SUFFIX: onnx_file.write}
    if path.suffix not in kinds:
        raise AgentError(f"{path}: a policy is written as {' or '.join(kinds)}")
    policy, config = algorithms.policy_of(run), run.config
    if not isinstance(policy, DeepPolicy):
        raise AgentError(
            f"{run.path}: {config.algorithm} has a table and no network to export; rollout and deploy take the run "
            "folder itself"
        )
    about = {
        "env": config.env, "algorithm": config.algorithm,
        "options": {**config.env_options, **config.evaluation.options},
        "max_steps": config.max_steps, "step_time": _step_time(config), "versions": dict(config.versions),
    }  # fmt: skip
    kinds[path.suffix](path, policy, about)


def _step_time(config: RunConfig) -> float:
    env = environments.make(config)
    try:
        return environments.step_time(env)
    finally:
        env.close()
