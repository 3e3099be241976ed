# SPDX-License-Identifier: BSD-3-Clause
"""Datasets of expert flights in Minari's form (https://minari.farama.org), for imitation and offline learning."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np

from sitl.envs.costs import TOTAL
from sitl.envs.navigate import Navigate
from sitl.envs.options import EnvOptionError
from sitl.envs.senses import SENSES, SensingRobot
from sitl.errors import MissingExtra
from sitl.version import __version__

from . import baselines, environments
from .errors import AgentError
from .experts import AUTOPILOTS, Expert, Learnt
from .named_policies import RANDOM

BASELINE = "baseline"
"""The expert that is the shipped policy of the environment."""
ESTIMATE, TRUTH = "estimate", "truth"
"""``infos`` of an episode: the robot's state as it believes and as it is, shape (steps + 1, 12), from the reset on."""
COLUMNS = [column for sense in SENSES.values() for column in sense.columns]
"""Name and unit of each number of a state."""


class Recorded(NamedTuple):
    """What was written."""

    dataset: Any
    """The dataset, a ``minari.MinariDataset``."""
    rewards: tuple[float, ...]
    """Sum of rewards of each episode."""
    successes: int
    """Episodes that ended with ``info["is_success"]``."""
    steps: int
    """Of all episodes."""


class _Drawn(Expert):
    """Draws its actions: no expert, but what one is compared with."""

    name, about = RANDOM, "drawn actions"

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        self._space = env.action_space

    def begin(self, seed: int) -> None:
        """See ``Expert``."""
        self._space.seed(seed)

    def act(self, observation: Any) -> Any:
        """See ``Expert``."""
        return self._space.sample()


def record(
    env: str,
    dataset: str | None = None,
    *,
    expert: str = "guided",
    episodes: int = 100,
    seed: int = 0,
    options: Mapping[str, Any] | None = None,
    max_steps: int | None = None,
    on_progress: Callable[[int], None] = lambda steps: None,
) -> Recorded:
    """Let an expert fly episodes, and write them as a dataset of Minari, where Minari keeps its own.

    Every step is the environment's: reset with an episode's seed and given its actions, the environment gives the
    same observations and rewards again. The same arguments give the same dataset, bit for bit.

    ``infos`` of its episodes has a row for the reset and one for each step: "is_success"; the robot's state by the
    estimate and by the truth (``ESTIMATE``, ``TRUTH``), where they are known; "cost" and "cost_NAME" where the option
    ``costs`` names some.

    Args:
        env: id of the environment.
        dataset: id of the dataset, "namespace/name-v0"; None: "sitl/ENV/EXPERT-vN" of the environment "ENV-vN".
        expert: "guided", "auto", "pilot" (see ``experts``), "baseline" (the policy that comes with the program),
            "random", the folder of a run, or the file of a policy.
        episodes: how many.
        seed: of all; that of episode k is ``environments.seed_of(seed, k)``.
        options: of the environment.
        max_steps: of an episode; None: as the id has it.
        on_progress: called after each episode with its steps.

    Raises:
        AgentError: no such environment, option or expert, or one that cannot act there; there is such a dataset.
        MissingExtra: Minari is not installed.
    """
    try:
        import h5py  # noqa: F401 (of Minari's form of files)
        import minari
    except ImportError as error:
        raise MissingExtra(f"datasets need Minari ({error}): pip install 'gym-sitl[minari]'") from None
    made = _made(env, dict(options or {}), max_steps)
    try:
        chosen = _expert(expert, made)
        name = dataset or name_of(env, chosen.name)
        try:
            taken = name in minari.list_local_datasets()
            minari.dataset.minari_dataset.parse_dataset_id(name)
        except ValueError as error:
            raise AgentError(f"dataset {name!r}: {error}") from None
        if taken:
            raise AgentError(f"there is a dataset {name!r} already: choose another name, or delete it")
        flights, rewards, successes = [], [], 0
        for k in range(episodes):
            flight = _flown(made, chosen, k, environments.seed_of(seed, k))
            flights.append(flight)
            rewards.append(float(np.sum(flight.rewards)))
            successes += bool(flight.infos["is_success"][-1])
            on_progress(len(flight.rewards))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # that there is no author's address
            written = minari.create_dataset_from_buffers(
                name,
                flights,
                made,
                algorithm_name=chosen.name,
                description=f"{episodes} episodes of {env}, flown by {chosen.about}.",
                requirements=[f"gym-sitl=={__version__}"],
                data_format="hdf5",
            )
        written.storage.update_metadata(
            {
                "expert": chosen.name,
                "environment": env,
                "options": json.dumps(dict(options or {}), sort_keys=True, default=str),
                "seed": seed,
                "episode_seeds": json.dumps([environments.seed_of(seed, k) for k in range(episodes)]),
                "successes": successes,
                "state_columns": json.dumps(COLUMNS),
                "mean_reward": float(np.mean(rewards)),
                "versions": json.dumps({"gym-sitl": __version__, "gymnasium": gym.__version__}),
            }
        )
    finally:
        made.close()
    return Recorded(written, tuple(rewards), successes, sum(len(flight.rewards) for flight in flights))


def name_of(env: str, expert: str) -> str:
    """What the dataset of an expert's flights in an environment is called by default."""
    name, _, version = env.rpartition(":")[2].rpartition("/")[2].rpartition("-v")
    return f"sitl/{name}/{expert}-v{version}" if name and version.isdigit() else f"sitl/{env}/{expert}-v0"


def _made(env: str, options: dict[str, Any], max_steps: int | None) -> gym.Env[Any, Any]:
    try:
        return gym.make(env, max_episode_steps=max_steps, **options)
    except (gym.error.Error, EnvOptionError, TypeError, ModuleNotFoundError) as error:
        raise AgentError(f"{env}: {error}") from None


def _expert(name: str, env: gym.Env[Any, Any]) -> Expert:
    if name in AUTOPILOTS:
        return AUTOPILOTS[name](env)
    if name == RANDOM:
        return _Drawn(env)
    path = baselines.find(_baseline_of(env) if name == BASELINE else name)
    if not path.exists():
        known = ", ".join((*AUTOPILOTS, BASELINE, RANDOM))
        raise AgentError(f"expert {name!r} is none of {known}, a shipped policy, or the folder or file of a policy")
    return Learnt(env, path)


def _baseline_of(env: gym.Env[Any, Any]) -> str:
    preset = "" if env.spec is None else str(env.spec.kwargs.get("preset", ""))
    name = baselines.of_preset(preset)
    if name not in baselines.names():
        named = "the environment" if env.spec is None else env.spec.id
        known = ", ".join(baselines.names())
        raise AgentError(f"expert {BASELINE!r}: no policy of {named} is shipped; there are {known}")
    return name


def _flown(env: gym.Env[Any, Any], expert: Expert, number: int, seed: int) -> Any:
    """Fly an episode; a ``minari.data_collector.EpisodeBuffer``."""
    from minari.data_collector import EpisodeBuffer

    observation, _ = env.reset(seed=seed)
    expert.begin(seed)
    seen, actions, rewards, terminations, truncations = [observation], [], [], [], []
    records: list[dict[str, Any]] = [_record(env, {})]
    ended = False
    while not ended:
        actions.append(expert.act(observation))
        observation, reward, terminated, truncated, info = env.step(actions[-1])
        seen.append(observation)
        rewards.append(float(reward))
        terminations.append(terminated)
        truncations.append(truncated)
        records.append(_record(env, info))
        ended = terminated or truncated
    for name in records[-1]:
        records[0].setdefault(name, 0.0)  # a reset costs nothing
    observations = {name: [row[name] for row in seen] for name in seen[0]} if isinstance(seen[0], dict) else seen
    infos = {name: np.array([row[name] for row in records]) for name in records[-1]}
    return EpisodeBuffer(number, seed, None, observations, actions, rewards, terminations, truncations, infos)


def _record(env: gym.Env[Any, Any], info: dict[str, Any]) -> dict[str, Any]:
    """What a dataset keeps of a moment besides observation and reward."""
    found: dict[str, Any] = {"is_success": bool(info.get("is_success", False))}
    found |= {name: float(cost) for name, cost in info.items() if name == TOTAL or name.startswith(f"{TOTAL}_")}
    navigate = env.unwrapped
    if isinstance(navigate, Navigate) and isinstance(navigate.robot, SensingRobot):
        found[ESTIMATE] = navigate.robot.state[0].copy()
        if getattr(navigate.robot, "knows_truth", False):
            found[TRUTH] = navigate.robot.true_state()[0].copy()
    return found


def where() -> Path:
    """The folder of all datasets: $MINARI_DATASETS_PATH, or Minari's own."""
    from minari.storage.datasets_root_dir import get_dataset_path

    return get_dataset_path()
