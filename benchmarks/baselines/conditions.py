# SPDX-License-Identifier: BSD-3-Clause
"""What baselines are evaluated under: as they were trained, and in worse or other conditions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from sitl.agents import baselines, environments
from sitl.agents.rehearsal.change import scaled
from sitl.agents.runs.config import RunConfig
from sitl.envs import ids
from sitl.envs.options import COMMON
from sitl.envs.presets import PRESETS
from sitl.envs.robots.vehicles import AutopilotOptions
from sitl.foreign.choice import ARDUPILOT, PX4

MAIN, ROBUST, REAL = "main", "robustness", "autopilot"
"""Groups: each is a table."""
NOMINAL, ESTIMATE, UNSEEN = "nominal", "estimate", "worlds-unseen"
AUTOPILOTS = {ARDUPILOT: "ArduPilot", PX4: "PX4"}
"""Conditions of another autopilot, a real program on our physics -> title in a table."""
EPISODES, ROBUST_EPISODES, WORLD_EPISODES, REAL_EPISODES = 200, 50, 100, 10
SEED = 1000
"""Of the episodes: episode k is the one that ``sitl rollout --seed 1000`` plays as number k."""
KINDS = ("copter", "rover")
WIND = {"wind_direction": (0.0, 360.0), "wind_turbulence": (0.0, 1.0)}
SENSORS = {"gps": "own GPS", "uwb": "beacons (UWB)", "rtk": "RTK", "mocap": "motion capture"}


@dataclass(frozen=True)
class Condition:
    """One of them."""

    title: str
    """In a table."""
    group: str = ROBUST
    episodes: int = ROBUST_EPISODES
    options: Mapping[str, Any] = field(default_factory=dict)
    """Of the environment, in place of its own."""
    scale: Mapping[str, float] = field(default_factory=dict)
    """Figure of the robot -> factor."""
    draw: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    """Figure of the robot -> range that it is drawn from."""
    kinds: tuple[str, ...] = KINDS
    """Kinds of vehicle that have it."""
    seeds: tuple[int, int] | None = None
    """First and last seed of the worlds, in place of those that the id has."""

    def fits(self, name: str) -> bool:
        """Whether a baseline (without variant) is evaluated under it: the vehicle has it, the environment knows its
        options, and its world is one of many."""
        known = set(self.options) <= {*COMMON, *AutopilotOptions.names()}
        return name.partition("-")[0] in self.kinds and known and (self.seeds is None or world_of(name) is not None)

    def config(self, plain: RunConfig) -> RunConfig:
        """The run in whose environment it is.

        Args:
            plain: of the baseline, without any of this.
        """
        options = {**plain.env_options, **self.options}
        if self.seeds is not None:
            options["world"] = worlds_of(preset_of(plain.env), *self.seeds)
        if self.scale or self.draw:
            env = environments.make(plain)
            try:
                session: Any = env.unwrapped.session  # type: ignore[attr-defined]
                drawn = dict(session.randomisation.ranges)
                for figure, factor in self.scale.items():
                    value = scaled(session.robot, figure, factor)
                    drawn[figure] = (value, value)
            finally:
                env.close()
            options["randomise"] = {**drawn, **self.draw}
        return plain.with_(env_options=options)

    def described(self) -> Any:
        """What results depend on, as JSON."""
        return {"options": dict(self.options), "scale": dict(self.scale), "draw": dict(self.draw), "seeds": self.seeds}


def preset_of(env: str) -> str:
    """The preset of an id."""
    return ids.NEW[env].preset


@cache
def world_of(name: str) -> str | None:
    """The world of a baseline's id where a seed makes it ("rooms:seed=1"); None: it is the only one of its sort."""
    task = name.removesuffix(baselines.DISCRETE)
    world = PRESETS[f"{task}-v1"]()["world"]
    return world if isinstance(world, str) and "seed=" in world else None


def worlds_of(preset: str, first: int, last: int) -> str:
    """Worlds of an id's kind, for the option ``world``: "rooms:seed=1..100"."""
    world = world_of(ids.task_of(preset))
    assert world is not None
    return re.sub(r"seed=\d+(\.\.\d+)?", f"seed={first}..{last}", world)


CONDITIONS: dict[str, Condition] = {
    NOMINAL: Condition("as trained", MAIN, EPISODES),
    ESTIMATE: Condition("judged by the estimate", MAIN, EPISODES, {"judge": "estimate"}),
    UNSEEN: Condition("worlds that no policy has seen", MAIN, WORLD_EPISODES, seeds=(1001, 1100)),
    **{f"latency-{seconds}": Condition(f"latency {seconds} s", options={"latency": seconds})
       for seconds in (0.1, 0.2, 0.3, 0.4)},
    **{f"wind-{speed}": Condition(f"wind {speed} m/s", draw={"wind_speed": (float(speed), float(speed)), **WIND},
                                  kinds=("copter",)) for speed in (4, 8, 12)},
    "mass-80": Condition("mass -20 %", scale={"mass": 0.8}),
    "mass-120": Condition("mass +20 %", scale={"mass": 1.2}),
    "motor-80": Condition("a motor at 80 %", options={"faults": {"motor:2=0.8": 0.0}}, kinds=("copter",)),
    **{f"sensors-{sensors}": Condition(title, options={"sensors": sensors}) for sensors, title in SENSORS.items()},
    "boots-1": Condition("one boot", options={"boots": 1}),
}  # fmt: skip
"""Name -> condition, in the order of tables."""


def named(name: str) -> Condition:
    """A condition, or that of a program of another autopilot."""
    if name in AUTOPILOTS:
        return Condition(AUTOPILOTS[name], REAL, REAL_EPISODES, {"autopilot": name})
    return CONDITIONS[name]


@dataclass(frozen=True)
class Program:
    """A program of another autopilot."""

    autopilot: str
    """One of ``AUTOPILOTS``."""
    path: Path

    def flies(self, name: str) -> bool:
        """Whether it flies a baseline: "arducopter" those of copters, a PX4 those of copters, too."""
        kind = name.partition("-")[0]
        return kind in self.path.name if self.autopilot == ARDUPILOT else kind == "copter"

    @property
    def option(self) -> str:
        """It as an environment's option ``autopilot``."""
        return f"{self.autopilot}:{self.path}"


def program_of(name: str, what: str, programs: tuple[Program, ...]) -> Program | None:
    """The one of some programs that flies a baseline under a condition of ``AUTOPILOTS``."""
    return next((one for one in programs if one.autopilot == what and one.flies(name)), None)


def of_group(group: str, name: str) -> tuple[str, ...]:
    """Names of the conditions of a group that a baseline is evaluated under."""
    return tuple(key for key, one in CONDITIONS.items() if one.group == group and one.fits(name))
