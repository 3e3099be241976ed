# SPDX-License-Identifier: BSD-3-Clause
"""What is missing, in the order in which it is done: after any stop the tables are as complete as they can be."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from . import entries, shipped
from .conditions import AUTOPILOTS, MAIN, NOMINAL, ROBUST, Program, named, of_group, program_of
from .entries import Entry
from .records import Record, Records
from .references import References
from .work import Job

STEP_S = {"ppo": 2.2e-4, "sac": 5e-3, "dqn": 2.5e-3}
"""Processor time of a step of training where none was measured [s]."""
EPISODE_S, REAL_S = 0.1, 5.0
"""That of an episode of an evaluation; of one of another autopilot [s]."""


@dataclass(frozen=True)
class Campaign:
    """Baselines, results, and what is wanted of them.

    Args:
        chosen: the baselines.
        records: results that there are.
        references: plays of the environments.
        runs: folder of runs and policies.
        seeds: number of trainings of each.
        programs: of other autopilots.
        only_programs: fly trained policies with these programs, and do nothing else.
    """

    chosen: Sequence[Entry]
    records: Records
    references: References
    runs: Path
    seeds: int = 5
    programs: tuple[Program, ...] = ()
    only_programs: bool = False

    # ------------------------------------------------------------------ results

    def training(self, entry: Entry, seed: int) -> Record | None:
        """The result of a training, when it is up to date."""
        return self.records.get(entry.training_key(seed, self.references.digest(entry.plain)))

    def episodes(self, entry: Entry, seed: int | str, what: str) -> Record | None:
        """That of an evaluation, when it is up to date, and of the policy that the training gave."""
        found = self.records.get(entry.playing_key(seed, what, self.references.digest(entry.plain)))
        if found is None or isinstance(seed, str):
            return found
        training = self.training(entry, seed)
        return found if training is not None and training["policy"] == found["policy"] else None

    def wanted_keys(self) -> Iterator[str]:
        """Keys of all results that are up to date."""
        for entry in self.chosen:
            for seed in range(self.seeds):
                yield entry.training_key(seed, self.references.digest(entry.plain))
            for number in ("random", *range(self.seeds)):
                for what in (*of_group(MAIN, entry.plain), *_elsewhere(entry), *AUTOPILOTS):
                    yield entry.playing_key(number, what, self.references.digest(entry.plain))

    # ------------------------------------------------------------------ work

    def stages(self) -> list[tuple[str, list[Job]]]:
        """What is missing: title of a stage -> its jobs, the shortest first."""
        flown = [self._jobs([entry], self.flown_seed(entry), self._real) for entry in self.chosen]
        real = ("other autopilots", self._shortest_first(job for jobs in flown for job in jobs))
        if self.only_programs:
            there = [job for job in real[1] if not job.train and job.is_here]
            return [(real[0], there)] if there else []
        plain = [entry for entry in self.chosen if not entry.is_variant]
        variants = [entry for entry in self.chosen if entry.is_variant]
        found = [
            ("random policy", self._jobs(plain, None, lambda entry: (NOMINAL,))),
            ("training, seed 0", self._jobs(plain, 0, _main)),
            ("robustness, seed 0", self._jobs(plain, 0, _elsewhere)),
            ("variants, seed 0", self._jobs(variants, 0, _all)),
            real,
        ]
        later = range(1, self.seeds)
        # At once, as long as the policy is there: the repository has results of these seeds, not their policies.
        found += [(f"training and robustness, seed {seed}", self._jobs(plain, seed, _all)) for seed in later]
        found += [(f"variants, seed {seed}", self._jobs(variants, seed, _all)) for seed in later]
        return [(title, jobs) for title, jobs in found if jobs]

    def flown_seed(self, entry: Entry) -> int:
        """The training whose policy other autopilots fly: one that they have flown; else that of the policy in the
        package, or the first whose policy is here."""
        flown = [seed for seed in range(self.seeds) if any(self.episodes(entry, seed, what) for what in AUTOPILOTS)]
        jobs = [self._job(entry, seed) for seed in range(self.seeds) if self.training(entry, seed) is not None]
        here = sorted((job for job in jobs if job.is_here), key=lambda job: not job.is_shipped)
        return next(iter([*flown, *(job.seed or 0 for job in here)]), 0)

    def _real(self, entry: Entry) -> tuple[str, ...]:
        return tuple(what for what in AUTOPILOTS if program_of(entry.name, what, self.programs))

    def _jobs(self, some: Sequence[Entry], seed: int | None, wanted: Callable[[Entry], tuple[str, ...]]) -> list[Job]:
        jobs = []
        for entry in some:
            number = "random" if seed is None else seed
            missing = tuple(what for what in wanted(entry) if self.episodes(entry, number, what) is None)
            if missing:
                train = seed is not None and self.training(entry, seed) is None
                job = self._job(entry, seed, missing, train)
                if seed is not None and not train and not job.is_here:
                    again = tuple(dict.fromkeys((*missing, *_all(entry))))
                    job = replace(job, whats=again)  # trained again, it may be another policy on this machine
                jobs.append(job)
        return self._shortest_first(jobs)

    def _job(self, entry: Entry, seed: int | None, whats: tuple[str, ...] = (), train: bool = False) -> Job:
        env = self.references.digest(entry.plain)
        return Job(entry.name, seed, whats, train, env, self.runs, programs=self.programs, steps=entry.steps)

    def _shortest_first(self, jobs: Iterable[Job]) -> list[Job]:
        return sorted(jobs, key=lambda job: sum(self.seconds(job)))

    # ------------------------------------------------------------------ times

    def seconds(self, job: Job) -> tuple[float, float]:
        """Estimated processor time of a job's training, and of its evaluations [s]."""
        trains = job.seed is not None and not job.is_here
        return self.expected(job.entry, None) if trains else 0.0, sum(
            self.expected(job.entry, what) for what in job.whats
        )

    def expected(self, entry: Entry, what: str | None) -> float:
        """Estimated processor time of a training (None), or of an evaluation [s]: as the last time, else by what is
        known of others."""
        if what is None:
            return self._training_s(entry)
        before = [one["took_s"] / len(one["reached"]) for one in self.records.all()
                  if one["name"] == entry.name and one.get("what") == what and "reached" in one]  # fmt: skip
        usual = REAL_S if what in AUTOPILOTS else EPISODE_S
        return float(before[-1] if before else usual) * named(what).episodes

    def _training_s(self, entry: Entry) -> float:
        steps = float(entry.steps or entry.recipe.steps or 0)
        for one in self.records.all():
            if one["kind"] == "training" and one["name"] == entry.name and one["steps"]:
                return float(one["took_s"]) * steps / float(one["steps"])
        row = shipped.kept().get(entry.plain, {})
        if row.get("learnt_s") and row.get("steps"):
            return float(row["learnt_s"]) * steps / float(row["steps"])
        return steps * STEP_S.get(entry.recipe.algorithm, STEP_S["ppo"])

    def left(self, stages: Sequence[tuple[str, Sequence[Job]]]) -> float:
        """Estimated processor time of all jobs of some stages [s]; a training that two need counts once."""
        counted, total = set(), 0.0
        for job in (job for _, jobs in stages for job in jobs):
            training, playing = self.seconds(job)
            total += playing + (training if (job.name, job.seed) not in counted else 0.0)
            counted.add((job.name, job.seed))
        return total


def _main(entry: Entry) -> tuple[str, ...]:
    return (NOMINAL,) if entry.is_variant else of_group(MAIN, entry.plain)


def _elsewhere(entry: Entry) -> tuple[str, ...]:
    return of_group(ROBUST, entry.plain)


def _all(entry: Entry) -> tuple[str, ...]:
    return (*_main(entry), *_elsewhere(entry))


def campaign(
    names: Sequence[str],
    folder: Path,
    runs: Path,
    seeds: int,
    programs: tuple[Program, ...] = (),
    steps: int | None = None,
    only_programs: bool = False,
) -> Campaign:
    """Of baselines by their names."""
    chosen = [entries.load(name, steps) for name in names]
    return Campaign(chosen, Records(folder), References(folder), runs, seeds, programs, only_programs)
