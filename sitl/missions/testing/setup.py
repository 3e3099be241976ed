# SPDX-License-Identifier: BSD-3-Clause
"""How a vehicle of a test is made."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from inspect import signature
from pathlib import Path

from sitl import vehicles
from sitl.autopilot.params import parm_files
from sitl.client.endpoint import Inbox
from sitl.core.compile import Progress
from sitl.envs.mavlink.foreign import Foreign, launch
from sitl.errors import OptionError, did_you_mean
from sitl.foreign.choice import NATIVE as OURS
from sitl.foreign.choice import choose
from sitl.physics.engines import NATIVE
from sitl.plants.local import stand_alone
from sitl.scenario import StartPose
from sitl.simulation import Simulation
from sitl.vehicle.core_entry import Core, load_core
from sitl.vehicle.kinds import DEFAULT, KINDS
from sitl.vehicles import Airframe
from sitl.worlds import World

from .. import library
from ..files import load
from .missions import find

__tracebackhide__ = True

PATIENCE_S = 30.0
"""Wall time without a sign of life of another autopilot after which it is lost [s]."""
WIND = ("SIM_WIND_SPD", "SIM_WIND_DIR", "SIM_WIND_TURB")
_cores: dict[str, Core] = {}
compiling: Progress | None = None
"""Called when the core of a kind of vehicle must be compiled first."""


@dataclass(frozen=True)
class Setup:
    """All that a simulation is made of."""

    frame: str | Airframe
    home: tuple[float, float, float, float] | None = None
    seed: int | None = None
    estimator: str = "ekf"
    params: tuple[tuple[str, float], ...] = ()
    world: str | Path | World | None = None
    start: StartPose | None = None
    physics: str = NATIVE
    autopilot: str = OURS
    has_files: bool = False
    """Whether some parameters are of files, which are taken as a vehicle takes them."""

    @property
    def kind(self) -> str:
        """ "copter" or "rover"."""
        return vehicles.load(self.frame).kind

    def build(self) -> Simulation | Foreign:
        """The simulation at power-on, or another autopilot that has just been started on our physics."""
        choice = choose(self.autopilot, self.kind)
        if choice is not None:
            if self.estimator != "ekf":
                raise OptionError(f"estimator {self.estimator!r}: autopilot {choice.name} has estimators of its own")
            params = self._parameters()
            plant = stand_alone(
                self.frame, home=self.home, seed=self.seed, params=choice.for_physics(params), world=self.world,
                start=self.start, physics=self.physics,
            )  # fmt: skip
            return launch(choice, plant, params, Inbox(), PATIENCE_S)
        simulation = Simulation(
            self.frame, home=self.home, seed=self.seed, estimator=self.estimator, params=self._parameters(),
            world=self.world, start=self.start, physics=self.physics,
            core=_core(self.kind) if self.physics == NATIVE else None,
        )  # fmt: skip
        return simulation

    def _parameters(self) -> dict[str, float]:
        values = dict(self.params)
        return parm_files.FileValues(values) if self.has_files else values


def _core(kind: str) -> Core:
    """Loaded once a process."""
    if kind not in _cores:
        _cores[kind] = load_core(KINDS[kind], compiling)
    return _cores[kind]


@dataclass(frozen=True)
class Defaults:
    """What holds for all tests of a run. Parameters that a kind of vehicle does not have are left out there."""

    seed: int | None = None
    physics: str = NATIVE
    autopilot: str = OURS
    params: parm_files.FileValues = field(default_factory=parm_files.FileValues)
    folders: tuple[Path, ...] = (Path(),)
    """Where files are looked for."""


def setup(
    defaults: Defaults,
    kind: str | None = None,
    *,
    frame: str | Path | Airframe | None = None,
    home: Sequence[float] | None = None,
    seed: int | None = None,
    estimator: str = "ekf",
    params: parm_files.Given | None = None,
    world: str | Path | World | None = None,
    start: StartPose | None = None,
    physics: str | None = None,
    autopilot: str | None = None,
    wind: float | Sequence[float] | None = None,
    mission: str | Path | None = None,
    **unknown: object,
) -> Setup:
    """A set-up from what a test says and what holds for all.

    Args:
        kind: "copter" or "rover"; None: what the frame or the mission says, or a copter.
        frame: airframe name, a .toml or .py file, or an airframe; None: the kind's first.
        home: latitude, longitude [deg], altitude [m], heading [deg].
        params: values, or a file of parameters (docs/reference/parameter-files.md).
        world, start: as ``Simulation`` takes them.
        autopilot: "native", or another one ("ardupilot:PROGRAM"; ``sitl.foreign.choice``).
        wind: speed [m/s], or (speed, where it comes from [deg], turbulence [m/s]).
        mission: a file, or a name of the library, whose home, and in the library whose frame, world and parameters,
            the vehicle gets.
        unknown: what there is no option for, to be named.

    Raises:
        OptionError, AirframeError, ParameterError: what cannot be taken.
    """
    for name in unknown:
        raise OptionError(f"option {name!r} is none of {', '.join(OPTIONS)}{did_you_mean(name, OPTIONS)}")
    values: dict[str, float] = {}
    if mission is not None:
        file = load(find(mission, defaults.folders))
        entry = library.entries().get(str(mission))
        kind = kind or (entry.kind if entry else file.kind)
        if entry is not None:
            frame, values = frame or entry.frame, dict(entry.params)
            world, start = (world, start) if world is not None else (entry.world, start or entry.start)
        if home is None and file.home is not None:
            home = (*file.home, 0.0)
    if isinstance(params, str | Path):
        params = parm_files.load(_beside(params, defaults.folders))
    params = parm_files.given(params)
    values = values | params
    if wind is not None:
        given = [float(x) for x in (wind if isinstance(wind, Sequence) else (wind,))]
        if not 1 <= len(given) <= 3 or not all(map(math.isfinite, given)):
            raise OptionError(f"wind {wind!r} is neither a speed nor (speed, direction, turbulence)")
        values.update(zip(WIND, given))
    if frame is None:
        frame = KINDS[kind or DEFAULT].default_frame
    elif not isinstance(frame, Airframe):
        frame = str(_beside(frame, defaults.folders)) if vehicles.is_file(str(frame)) else str(frame)
    if kind is not None:
        vehicles.check_kind(vehicles.load(frame), kind)
    if isinstance(world, str | Path) and str(world).endswith(".toml"):
        world = _beside(world, defaults.folders)
    values = defaults.params | values
    if values.sources and (autopilot or defaults.autopilot) == OURS:
        table = KINDS[vehicles.load(frame).kind].firmware.table
        if not isinstance(params, parm_files.FileValues):  # what the test itself says is not taken that lightly
            if strange := [name for name in params if name not in table]:
                raise parm_files.ParameterError(parm_files.unknown(vehicles.load(frame).kind, strange, table))
            parm_files.check(table, params)
        parm_files.report(table, values)
    location = tuple(float(x) for x in home) if home is not None else None
    if location is not None and len(location) != 4:
        raise OptionError(f"home {home!r} is not (latitude, longitude, altitude, heading)")
    return Setup(
        frame, location, defaults.seed if seed is None else seed, estimator, tuple(sorted(values.items())), world,
        tuple(start) if isinstance(start, list) else start, physics or defaults.physics,
        autopilot or defaults.autopilot, bool(values.sources),
    )  # type: ignore[arg-type]  # fmt: skip


OPTIONS = (
    *(name for name, option in signature(setup).parameters.items() if option.kind is option.KEYWORD_ONLY),
    *("ready", "after", "name", "link_faults"),  # those that the factory takes itself
)
"""What a marker or a call of the factory may say."""


def _beside(name: str | Path, folders: Sequence[Path]) -> Path:
    """A file in one of the folders, or as it is named."""
    return next((folder / name for folder in folders if (folder / name).is_file()), Path(name))
