# SPDX-License-Identifier: BSD-3-Clause
"""What cheats are paid, beside what the baseline is."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import closing
from typing import Any, NamedTuple, cast

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode

from sitl.envs.ids import FIRST, NEW

from .cheats import WRONG, Policy, Stage, baseline, cheats_of, nothing, options_of

SEED = 1000
HALF = 0.5
"""No cheat may have this share of the baseline's score."""
HIDE, CIRCLE = "hide behind the estimate", "circle the goal"
"""Cheats of which episodes without success count: one that overshoots into the goal has done the task."""
SEEN = {"Gates", "Land"}
"""Tasks whose goal robots see, and do not know from their estimate: nothing can be hidden behind it."""


class Played(NamedTuple):
    """Episodes of one policy; arrays have a row an episode."""

    returns: npt.NDArray[np.float64]
    is_success: npt.NDArray[np.bool_]
    early: npt.NDArray[np.bool_]
    """Whether a crash, the floor, or the end of the arena ended it."""
    steps: npt.NDArray[np.int64]

    @property
    def mean(self) -> float:
        """Mean return."""
        return float(self.returns.mean())

    def failed(self) -> Played:
        """Those of the episodes that were no success; all, if there are none."""
        rows = ~self.is_success if not self.is_success.all() else self.early | True
        return Played(self.returns[rows], self.is_success[rows], self.early[rows], self.steps[rows])


class Game:
    """Many robots of an id, at the begin of the same episodes for each policy.

    They are started once: every policy plays from a snapshot, which repeats bit for bit.

    Args:
        name: of ``NEW`` or ``FIRST``.
        episodes: how many.
        seed: of the first; episode k has ``seed`` + k.
        options: of the environment.
    """

    def __init__(self, name: str, episodes: int, seed: int = SEED, **options: Any) -> None:
        preset = (NEW | FIRST)[name].preset.removesuffix("-v1")
        given = {**options_of(preset), **options, "autoreset_mode": AutoresetMode.DISABLED}
        self.env: Any = gym.make_vec(name, num_envs=episodes, vectorization_mode="vector_entry_point", **given)
        try:
            self.stage = Stage(self.env, preset)
            self.env.reset(seed=seed)
            self._robots = cast(Any, self.env.unwrapped)
            self._start = self._robots.snapshot()
        except BaseException:
            self.close()
            raise

    def play(self, begin: Callable[[Stage], Policy]) -> Played:
        """Play all episodes with a policy.

        Args:
            begin: makes the policy.
        """
        env, episodes = self.env, self.env.num_envs
        seen = self._robots.restore(self._start)
        policy = begin(self.stage)
        returns, steps = np.zeros(episodes), np.zeros(episodes, np.int64)
        runs, success, early = np.ones(episodes, np.bool_), np.zeros(episodes, np.bool_), np.zeros(episodes, np.bool_)
        while runs.any():
            seen, rewards, terminated, truncated, infos = env.step(policy(seen))
            returns[runs] += rewards[runs]
            steps[runs] += 1
            ended = terminated | truncated
            over = runs & ended
            success[over] = infos["is_success"][over]
            early[over] = terminated[over] & ~infos["is_success"][over]
            runs &= ~over
            for index in np.flatnonzero(ended).tolist():  # it flies on, and nobody looks
                self._robots.restore_one(index, self._start[index])
        return Played(returns, success, early, steps)

    def close(self) -> None:
        """Close the environment."""
        self.env.close()


class Row(NamedTuple):
    """What an id pays."""

    name: str
    baseline: Played
    nothing: Played
    cheats: dict[str, Played]

    def score(self, played: Played) -> float:
        """0 for doing nothing, 1 for the baseline."""
        return (played.mean - self.nothing.mean) / (self.baseline.mean - self.nothing.mean)

    @property
    def best(self) -> tuple[str, float]:
        """The cheat that pays most, and its score."""
        name = max(self.cheats, key=lambda cheat: self.cheats[cheat].mean)
        return name, self.score(self.cheats[name])

    @property
    def best_early(self) -> float:
        """The most that an early end of a cheat was worth; -inf: none ended early."""
        ends = [p.returns[p.early] for p in (self.nothing, *self.cheats.values())]
        return float(max((end.max() for end in ends if len(end)), default=-math.inf))

    @property
    def worst_honest(self) -> float:
        """The least that an episode was worth that went on until the time limit: of the baseline, and of doing
        nothing."""
        ends = [p.returns[~p.early & ~p.is_success] for p in (self.baseline, self.nothing)]
        return float(min((end.min() for end in ends if len(end)), default=math.inf))

    @property
    def faults(self) -> list[str]:
        """What pays that should not."""
        found = [
            f"{cheat}: {self.score(played):.2f} of the baseline's score"
            for cheat, played in self.cheats.items()
            if not self.score(played) < HALF
        ]
        if not self.baseline.mean > self.nothing.mean:
            found.append(f"nothing: {self.nothing.mean:.1f}, the baseline {self.baseline.mean:.1f}")
        if self.baseline.mean > 0.0 and not self.nothing.mean < HALF * self.baseline.mean:
            found.append(f"nothing: {self.nothing.mean:.1f}, more than half of {self.baseline.mean:.1f}")
        if not self.worst_honest > self.best_early:
            found.append(f"an early end: {self.best_early:.1f}, the time limit {self.worst_honest:.1f}")
        return found


def row(name: str, episodes: int) -> Row:
    """Play everything on an id."""
    with closing(Game(name, episodes)) as game:
        stage = game.stage
        played = {cheat: game.play(begin) for cheat, begin in cheats_of(stage).items()}
        played[CIRCLE] = played[CIRCLE].failed()
        honest = game.play(baseline), game.play(nothing)
        hides = not SEEN.intersection(cls.__name__ for cls in type(stage.task).__mro__)
    if hides:
        with closing(Game(name, episodes, faults=WRONG, sensors="gps")) as game:
            played[HIDE] = game.play(baseline).failed()
    return Row(name, *honest, played)


def line(found: Row) -> str:
    """Of the table."""
    best, score = found.best
    worst = "" if math.isinf(found.worst_honest) else f"{found.worst_honest:.1f}"
    early = "" if math.isinf(found.best_early) else f"{found.best_early:.1f}"
    drawn, out, circle = (found.score(found.cheats[key]) for key in ("random", "fly out", CIRCLE))
    hide = f"{found.score(found.cheats[HIDE]):.2f}" if HIDE in found.cheats else ""
    return (
        f"| `{found.name.removeprefix('sitl/')}` | {found.baseline.mean:.1f} | {found.nothing.mean:.1f} | "
        f"{drawn:.2f} | {out:.2f} | {circle:.2f} | {hide} | {best} {score:.2f} | {worst} | {early} |"
    )


HEAD = (
    "| id | baseline | nothing | random | fly out | circle | hide | best cheat | worst at the time limit "
    "| best early end |\n|---|---:|---:|---:|---:|---:|---:|---|---:|---:|"
)
