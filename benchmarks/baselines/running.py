# SPDX-License-Identifier: BSD-3-Clause
"""Runs the jobs of a campaign, keeps each result as it comes, and says how long the rest takes."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from sitl.agents.runs.backends import Workers

from .campaign import Campaign
from .conditions import NOMINAL
from .shipped import share
from .work import Job, do

EVERY_S = 30.0
"""Wall time between two lines of progress of a training."""


def duration(seconds: float) -> str:
    """For people: "2 h 05 min", "7 min", "40 s"."""
    minutes = round(seconds / 60.0)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60:02d} min"
    return f"{minutes} min" if seconds >= 90.0 else f"{seconds:.0f} s"


class Progress:
    """Takes what jobs send, keeps results, prints a line for each.

    Args:
        campaign: whose results they are.
        expected: estimated processor time of all that is to do [s].
        jobs: number of processes.
        say: prints a line.
    """

    def __init__(self, campaign: Campaign, expected: float, jobs: int, say: Callable[[str], None]) -> None:
        self._campaign, self._expected, self._jobs, self._say = campaign, max(expected, 1.0), jobs, say
        self._began = time.monotonic()
        self._steps: dict[Job, int] = {}
        self._said: dict[Job, float] = {}
        self._done = 0.0
        """Estimated processor time of results that have come [s]."""

    def take(self, job: Job, message: Any) -> None:
        """A message of a job."""
        if isinstance(message, dict):
            self._done += self._campaign.expected(job.entry, message.get("what"))
            self._campaign.records.add(message)
            self._steps.pop(job, None)
            self._say(f"{_title(job)}: {_result(message)}; about {self.rest()} left")
            return
        kind, value = message
        if kind == "failed":
            self._say(f"{_title(job)} failed: {value}")
            return
        if kind == "anew":
            self._steps.pop(job, None)
            self._say(f"{_title(job)} begins anew: {value}")
            return
        done = self._steps[job] = self._steps.get(job, 0) + value
        now = time.monotonic()
        if now - self._said.get(job, self._began) > EVERY_S:
            self._said[job] = now
            self._say(f"{_title(job)}: {done:,} of {_steps_of(job):,} steps; about {self.rest()} left")

    def rest(self) -> str:
        """How long the rest takes: by the estimate, corrected by how long the first part took."""
        trained = (min(steps / max(_steps_of(job), 1), 1.0) * self._campaign.expected(job.entry, None)
                   for job, steps in self._steps.items())  # fmt: skip
        spent, done = time.monotonic() - self._began, self._done + sum(trained)
        pace = spent / done if done > 60.0 else 1.0 / self._jobs
        return duration(pace * max(self._expected - done, 0.0))


def _steps_of(job: Job) -> int:
    return job.entry.steps or job.entry.recipe.steps or 0


def _title(job: Job) -> str:
    return f"{job.name}, {'random policy' if job.seed is None else f'seed {job.seed}'}"


def _result(record: dict[str, Any]) -> str:
    if record["kind"] == "training":
        return f"trained, {record['steps']:,} steps in {duration(record['took_s'])} of processor time"
    solved = record["reached"].count("1")
    shown = share(solved, len(record["reached"]))
    return f"{record['what']}: success {shown}" if record["what"] != NOMINAL else f"success {shown}"


def run(campaign: Campaign, workers: Workers, until: float, say: Callable[[str], None]) -> bool:
    """Do what is missing, stage after stage, until a wall time [s]; returns whether all is done."""
    stages = campaign.stages()
    progress = Progress(campaign, campaign.left(stages), workers.jobs, say)
    complete = True
    for title, _ in stages:
        found = dict(campaign.stages()).get(title, [])  # what earlier stages have made is not asked for again
        jobs: Sequence[Job] = [replace(job, until=until) for job in found]
        say(f"== {title}: {len(jobs)} baselines; about {progress.rest()} left of all")
        done = workers.each(
            do, jobs, workers.jobs, lambda index, message, jobs=jobs: progress.take(jobs[index], message)
        )
        if None in done:
            return False
        complete &= all(done)
    return complete
