# SPDX-License-Identifier: BSD-3-Clause
"""What is simulated: one vehicle, where it stands, its world, what moves it.

The command line, environments, missions, recordings and hosts of foreign autopilots describe a simulation by it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from numbers import Integral
from pathlib import Path
from typing import Any, TypedDict

from . import vehicles, worlds
from .autopilot.params import parm_files
from .errors import OptionError, did_you_mean
from .physics.engines import NATIVE
from .physics.native import atmosphere
from .physics.native.power_on import DEFAULT_HOME, Home
from .vehicle.faults import Failure
from .vehicle.kind import Kind
from .vehicle.kinds import DEFAULT, KINDS
from .vehicles import Airframe
from .worlds import World

ESTIMATORS = ("ekf", "truth")
StartPose = str | Sequence[float]
"""Name of a start pose of the world, or x, y, z [m], yaw [deg] in the world's frame."""


class Options(TypedDict, total=False):
    """The fields of a ``Scenario`` besides its frame, as keyword arguments."""

    home: Home | None
    seed: int | None
    estimator: str
    params: parm_files.Given | None
    world: str | Path | World | None
    start: StartPose | None
    physics: str
    faults: Sequence[str | Failure]
    terrain: str | None


@dataclass(frozen=True, eq=False)
class Scenario:
    """What is simulated. It is checked as far as it can be without loading the world or the physics.

    Args:
        frame: airframe name (``sitl.vehicles.names()``), path of a file that defines one, or an Airframe.
        home: where it stands at power-on: latitude, longitude [deg], altitude [m] from -2000 to 11000, heading [deg];
            None: Canberra.
        seed: seed of all sensor noise and turbulence; None: 0.
        estimator: "ekf", or "truth" for work on controllers.
        params: values under ArduPilot's names, over the airframe's own and the defaults; or a file of parameters, which
            are taken as a vehicle takes them (docs/reference/parameter-files.md). They are kept as a dictionary.
        world: name (``sitl.worlds.names()``), path of a .toml file, or a World. Its origin is at ``home``, and the
            vehicle stands at ``start``; home's heading does not count.
        start: name of one of the world's start poses, or x, y, z [m], yaw [deg] in the world's frame; None: the
            world's own for this airframe.
        physics: "native", "pybullet", "jsbsim", or where the physics is: "hil:tcp:HOST:PORT" (``sitl physics``),
            "json:HOST:PORT" (a simulator with ArduPilot's JSON interface). Home, seed, world and start of a physics
            elsewhere are its own.
        faults: what fails, and when after power-on: "gps@12", or several: ["gps@12", "motor:2=0.5@20..30"]
            (docs/faults.md). It is kept as a tuple of texts.
        terrain: where the autopilot has the heights of the ground from, besides ground stations: "flat", an SRTM tile
            (.hgt), an array (.npy); the simulated ground follows them (docs/terrain.md).

    Raises:
        OptionError, sitl.vehicles.AirframeError: a value that cannot be taken, named.
    """

    frame: str | Airframe = KINDS[DEFAULT].default_frame
    home: Home | None = None
    seed: int | None = None
    estimator: str = ESTIMATORS[0]
    params: parm_files.Given | None = field(default_factory=dict)
    world: str | Path | World | None = None
    start: StartPose | None = None
    physics: str = NATIVE
    faults: Sequence[str | Failure] = ()
    terrain: str | None = None

    def __post_init__(self) -> None:
        if self.estimator not in ESTIMATORS:
            raise OptionError(f"estimator {self.estimator!r} is not known; it is one of {', '.join(ESTIMATORS)}")
        try:
            object.__setattr__(self, "params", parm_files.given(self.params))
        except (TypeError, ValueError) as error:
            if isinstance(error, parm_files.ParameterError):
                raise
            raise OptionError(f"params = {self.params!r}: values by name or a file of parameters are needed") from None
        faults = (self.faults,) if isinstance(self.faults, str | Failure) else self.faults
        try:
            object.__setattr__(self, "faults", tuple(str(Failure.of(fault)) for fault in faults))
        except TypeError:
            raise OptionError(f"faults = {faults!r}: a fault such as gps@12 or a list of faults is needed") from None
        if self.home is not None:
            object.__setattr__(self, "home", checked_home(self.home))
        if self.seed is not None:
            object.__setattr__(self, "seed", checked_seed(self.seed))

    @classmethod
    def of(cls, frame: Scenario | str | Airframe | None = None, **options: Any) -> Scenario:
        """A scenario as functions take it: one that is made already, with ``options`` over its fields, or a frame.

        Raises:
            OptionError: an option that there is not; the message lists those there are.
        """
        known = [f.name for f in fields(cls)]
        for name in options:
            if name not in known:
                raise OptionError(f"option {name!r} is none of {', '.join(known)}{did_you_mean(name, known)}")
        if isinstance(frame, Scenario):
            return replace(frame, **options) if options else frame
        return cls(**options) if frame is None else cls(frame, **options)

    @property
    def parameters(self) -> dict[str, float]:
        """``params`` as they are kept."""
        assert isinstance(self.params, dict)
        return self.params

    @cached_property
    def airframe(self) -> Airframe:
        """The vehicle.

        Raises:
            AirframeError: there is no such airframe.
        """
        return vehicles.load(self.frame)

    @property
    def kind(self) -> Kind:
        """Of vehicle.

        Raises:
            UnknownKindError: no package defines it.
        """
        return KINDS[self.airframe.kind]

    @property
    def home_or_default(self) -> Home:
        """Where the vehicle stands when the physics is in this process."""
        return self.home or DEFAULT_HOME

    @property
    def seed_or_default(self) -> int:
        """0 when none is given."""
        return self.seed or 0

    def load_world(self) -> World | None:
        """The world, if there is one.

        Raises:
            OptionError: a start pose without a world.
            WorldError: no such world.
        """
        if self.world is None:
            if self.start is not None:
                raise OptionError(f"start {self.start!r} needs a world; without one a vehicle starts at its home")
            return None
        return worlds.load(self.world)

    # ------------------------------------------------------------------ as JSON

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON has it; ``from_json`` makes the same scenario of that.

        An airframe that has no name here is kept with its properties. A world made by a program is kept by its name
        alone ("file" is None): ``from_json`` needs it again.
        """
        airframe, start = self.airframe, self.start
        frame: str | None
        if isinstance(self.frame, str):
            frame = self.frame
        else:
            named = airframe.name in vehicles.names() and vehicles.load(airframe.name) is airframe
            frame = airframe.name if named else None
        of_files = {"params_of_files": True} if isinstance(self.params, parm_files.FileValues) else {}
        return {
            "vehicle": airframe.kind,
            "frame": frame,
            "airframe": vehicles.to_data(airframe),
            "home": list(self.home_or_default),
            "seed": self.seed_or_default,
            "estimator": self.estimator,
            "physics": self.physics,
            "world": _world_to_json(self.world),
            "start": start if start is None or isinstance(start, str) else [float(number) for number in start],
            "params": {name: float(value) for name, value in self.parameters.items()},
            **of_files,
            "faults": list(map(str, self.faults)),
            "terrain": self.terrain,
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any], **options: Any) -> Scenario:
        """A scenario of what ``to_json`` gave; ``options`` stand over it. No file that the data name is run.

        Raises:
            OptionError, sitl.vehicles.AirframeError: the data make no scenario.
        """
        if options.get("frame") is None:
            options["frame"] = _frame_of(data)
        if options.get("world") is None and data["world"] is not None:
            options["world"] = data["world"]["file"]
            if options["world"] is None:
                raise OptionError(f"world {data['world']['name']!r} was made by a program; it has to be given")
        start, params = data["start"], data["params"]
        if not isinstance(params, dict):
            raise OptionError(f"parameters of a recording are a table, not {params!r}")
        found: dict[str, Any] = {
            "home": tuple(data["home"]),
            "seed": data["seed"],
            "estimator": data["estimator"],
            "params": parm_files.FileValues(params) if data.get("params_of_files") else params,
            "start": tuple(start) if isinstance(start, list) else start,
            "physics": data["physics"],
            "faults": data.get("faults", ()),
            "terrain": data.get("terrain"),
        }
        return cls(**{**found, **{name: value for name, value in options.items() if value is not None}})


def _frame_of(data: Mapping[str, Any]) -> str | Airframe:
    """Ours by its name, any other from its properties: a file may be Python, which would run, or have changed since."""
    frame = data["frame"]
    if isinstance(frame, str) and not vehicles.is_file(frame):
        return frame
    return vehicles.of_data(KINDS[data["vehicle"]].airframe, data["airframe"])


def _world_to_json(world: str | Path | World | None) -> dict[str, Any] | None:
    if world is None:
        return None
    found = worlds.load(world)
    if not isinstance(world, str | Path):
        return {"file": found.name if found.name in worlds.names() and worlds.load(found.name) is found else None,
                "name": found.name}  # fmt: skip
    return {"file": str(world), "name": found.name}


def checked_home(home: Home) -> Home:
    """``home`` as floats; OptionError when it is not four numbers, not on the globe, or where there is no model of the
    air: the standard atmosphere is that of the troposphere.
    """
    try:
        lat, lon, alt, heading = (float(number) for number in home)
    except (TypeError, ValueError):
        wanted = "(latitude, longitude, altitude, heading) in degrees and metres"
        raise OptionError(f"home {home!r} is not {wanted}") from None
    if not (abs(lat) <= 90 and abs(lon) <= 180 and math.isfinite(alt) and math.isfinite(heading)):
        raise OptionError(f"home {home}: latitude is within +-90, longitude within +-180 degrees, the rest finite")
    if not atmosphere.LOWEST <= alt <= atmosphere.HIGHEST:
        limits = f"{atmosphere.LOWEST:.0f} to {atmosphere.HIGHEST:.0f} m"
        raise OptionError(f"home {home}: altitude is within {limits} above mean sea level, where the air is modelled")
    return (lat, lon, alt, heading)


def checked_seed(seed: int) -> int:
    """``seed``; OptionError when it is not a whole number."""
    if not isinstance(seed, Integral):
        raise OptionError(f"seed {seed!r} is not a whole number")
    return int(seed)
