# SPDX-License-Identifier: BSD-3-Clause
"""One piece of work: a training with its evaluations, in a process of its own."""

from __future__ import annotations

import hashlib
import json
import shutil
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.agents import baselines, learnt, rollout
from sitl.agents.errors import ResumeError
from sitl.agents.evaluate import Played
from sitl.agents.named_policies import RANDOM, Named
from sitl.agents.runs.config import RunConfig, versions
from sitl.agents.runs.files import make_folder, write_bytes, write_json
from sitl.agents.runs.folder import RunFolder
from sitl.agents.runs.local import SendProgress, Stopped
from sitl.agents.runs.training import train_one
from sitl.errors import SitlError

from . import entries, shipped
from .conditions import AUTOPILOTS, NOMINAL, SEED, Program, named, program_of
from .records import Record

SPENT = "spent.json"
"""Processor time of a training, in its folder: it may be interrupted."""


@dataclass(frozen=True)
class Job:
    """What one process does; picklable."""

    name: str
    seed: int | None
    """Of the training; None: the random policy."""
    whats: tuple[str, ...]
    """Conditions that it is evaluated under."""
    train: bool
    """Whether the result of the training is missing."""
    env_digest: str
    runs: Path
    """Folder of runs and of trained policies."""
    until: float = float("inf")
    """Wall time at which it stops, to be gone on with later [s, as ``time.time``]."""
    programs: tuple[Program, ...] = ()
    """Other autopilots."""
    steps: int | None = None
    """Of a training, in place of the recipe's."""

    @property
    def entry(self) -> entries.Entry:
        """The baseline."""
        return entries.load(self.name, self.steps)

    @property
    def key(self) -> str:
        """Key of the training."""
        return self.entry.training_key(self.seed or 0, self.env_digest)

    @property
    def policy(self) -> Path:
        """Where the trained policy is kept."""
        return policy_file(self.runs, self.name, self.seed or 0, self.key)

    @property
    def is_shipped(self) -> bool:
        """Whether the policy of the training is the one in the package."""
        return shipped.key_of(self.name) == self.key

    @property
    def is_here(self) -> bool:
        """Whether that policy need not be trained again."""
        return self.policy.exists() or self.is_shipped


def policy_file(runs: Path, name: str, seed: int, key: str) -> Path:
    """Where the policy of a training is kept: its key is part of the name, so that it is never mistaken for another."""
    return runs / "policies" / f"{name}-{seed}-{key}.npz"


def do(job: Job, send_progress: SendProgress, stopped: Stopped) -> bool | None:
    """Do it, as far as there is time for; sends each result as soon as there is one, and steps of training between.

    Returns:
        Whether all was done; None when it was stopped.
    """

    def stop() -> bool:
        return stopped() or time.time() > job.until

    try:
        return _done(job, send_progress, stop)
    except SitlError as error:  # the others go on
        send_progress(("failed", f"{type(error).__name__}: {error}"))
        return False


def _done(job: Job, send_progress: SendProgress, stop: Stopped) -> bool | None:
    if stop():
        return None
    policy: Named = RANDOM
    if job.seed is not None:
        if not job.policy.exists() and not _shipped(job):
            record = train(job, send_progress, stop)
            if record is None:
                return None
            send_progress(record)
        elif job.train:
            send_progress(_trained(job))
        policy = job.policy
    for what in job.whats:
        if stop():
            return None
        send_progress(evaluate(job, policy, what))
    return True


def _shipped(job: Job) -> bool:
    """Take the policy that comes with the package, where that is the one of this training."""
    if not job.is_shipped:
        return False
    make_folder(job.policy.parent)
    write_bytes(job.policy, baselines.file(job.name).read_bytes())
    return True


def train(job: Job, send_progress: SendProgress, stopped: Stopped) -> Record | None:
    """Train, from where an earlier call was stopped, or anew where that was in a version with another state; None when
    this one was stopped, too."""
    entry, seed = job.entry, job.seed or 0
    run = RunFolder.ensure(job.runs / f"{job.name}-{seed}-{job.key}", entry.training(seed))
    before, began = _spent(run), time.process_time()

    def report(rows: Any) -> None:
        send_progress(("steps", sum(row.steps for row in rows)))

    try:
        done = train_one(run.path, report, stopped)
    except ResumeError as error:  # results are by recipe and environment; where a version began does not matter to them
        send_progress(("anew", str(error)))
        shutil.rmtree(run.path)
        return train(job, send_progress, stopped)
    write_json(run.path / SPENT, before + time.process_time() - began)
    if not done:
        return None
    make_folder(job.policy.parent)
    learnt.save(run, job.policy)
    return _trained(job, run)


def _spent(run: RunFolder) -> float:
    path = run.path / SPENT
    return float(json.loads(path.read_text())) if path.exists() else 0.0


def _trained(job: Job, run: RunFolder | None = None) -> Record:
    entry, seed = job.entry, job.seed or 0
    run = run or RunFolder(job.runs / f"{job.name}-{seed}-{job.key}")
    return {
        "kind": "training", "key": job.key, "name": job.name, "seed": seed, "env": entry.env,
        "recipe": entry.recipe.name, "algorithm": entry.recipe.algorithm,
        "steps": sum(row.steps for row in run.episodes.rows()), "policy": sha256(job.policy),
        "took_s": round(_spent(run), 1), "versions": dict(run.config.versions),
    }  # fmt: skip


def sha256(path: Path) -> str:
    """Of a file, shortened."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]


def evaluate(job: Job, policy: Named, what: str) -> Record:
    """Play the episodes of a condition."""
    condition, entry = named(what), job.entry
    config, count = condition.config(entry.playing()), condition.episodes
    robots = rollout.ROBOTS
    clock, more = time.process_time, {}
    if what in AUTOPILOTS:
        program = program_of(job.name, what, job.programs)
        assert program is not None
        config, robots = config.with_(env_options={**config.env_options, "autopilot": program.option}), 1
        clock, more = time.monotonic, {"program": sha256(program.path)}  # it works in a process of its own
    began = clock()
    played = play(config, policy, count, robots)
    rewards = [round(one.reward, 2) for one in played]
    return {
        "kind": "episodes", "name": job.name, "seed": "random" if job.seed is None else job.seed, "what": what,
        "key": entry.playing_key("random" if job.seed is None else job.seed, what, job.env_digest),
        "reached": bits(one.reached for one in played), "crashed": bits(one.crashed for one in played),
        **({"reward": rewards} if what == NOMINAL else {}), "mean_reward": round(float(np.mean(rewards)), 2),
        "policy": "" if isinstance(policy, str) else sha256(job.policy), "version": versions()["gym-sitl"],
        "took_s": round(clock() - began, 1), **more,
    }  # fmt: skip


def play(config: RunConfig, policy: Named, episodes: int, robots: int) -> list[Played]:
    """Episodes as ``sitl rollout --seed 1000`` plays them."""
    part = rollout.Part(config, policy, SEED, 0, episodes, min(robots, episodes), None)
    played = rollout.play(part, lambda message: None, lambda: False)
    assert played is not None
    return played


def bits(values: Any) -> str:
    """A digit an episode."""
    return "".join("1" if value else "0" for value in values)


def figures(record: Record, what: str) -> npt.NDArray[np.float64]:
    """What episodes were: reached, crashed (1: yes) or reward."""
    return np.array([float(value) for value in record[what]])
