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
from .records import Records
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
        records: where results are kept.
        expected: estimated processor time of all that is to do [s].
        jobs: number of processes.
        say: prints a line.
    """

    def __init__(self, records: Records, expected: float, jobs: int, say: Callable[[str], None]) -> None:
        self._records, self._expected, self._jobs, self._say = records, max(expected, 1.0), jobs, say
        self._began, self._steps, self._said = time.monotonic(), {}, {}  # type: ignore[var-annotated]
        self.done, self.failed = 0.0, 0
        """Estimated processor time of what is done [s]; number of jobs that failed."""

    def take(self, job: Job, message: Any) -> None:
        """A message of a job."""
        if isinstance(message, dict):
            self._records.add(message)
            self._say(f"{_title(job)}: {_result(message)}")
            return
        kind, value = message
        if kind == "failed":
            self.failed += 1
            self._say(f"{_title(job)} failed: {value}")
            return
        done = self._steps[job] = self._steps.get(job, 0) + value
        now = time.monotonic()
        if now - self._said.get(job, self._began) > EVERY_S:
            self._said[job] = now
            self._say(f"{_title(job)}: {done:,} of {job.entry.steps or job.entry.recipe.steps or 0:,} steps")

    def ended(self, seconds: float) -> None:
        """Jobs of so much estimated processor time are done."""
        self.done += seconds

    def rest(self) -> str:
        """How long the rest takes: by the estimate, corrected by how long the first part took."""
        spent, left = time.monotonic() - self._began, max(self._expected - self.done, 0.0)
        pace = spent / self.done if self.done > 60.0 else 1.0 / self._jobs
        return duration(pace * left)


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
    progress = Progress(campaign.records, campaign.left(stages), workers.jobs, say)
    complete = True
    for title, _ in stages:
        found = dict(campaign.stages()).get(title, [])  # what earlier stages have made is not asked for again
        jobs: Sequence[Job] = [replace(job, until=until) for job in found]
        say(f"== {title}: {len(jobs)} baselines; about {progress.rest()} left of all")
        estimates = [sum(campaign.seconds(job)) for job in jobs]
        done = workers.each(
            do, jobs, workers.jobs, lambda index, message, jobs=jobs: progress.take(jobs[index], message)
        )
        progress.ended(sum(estimates))
        if None in done or time.time() > until:
            return False
        complete &= all(done)
    return complete
