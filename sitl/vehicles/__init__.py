# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles as data: one file an airframe, or a row of ``ardupilot_frames``; files of users are in ``airframe_file``.

To add one, write its file and name it in ``_MODULES``; another package names it in the entry point group
``sitl.airframes``.
"""

from __future__ import annotations

import importlib
import runpy
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

import numpy as np

from . import airframe_file
from .airframe import Airframe, AirframeError, apply
from .copter_airframe import CopterAirframe, Rotor
from .old_names import key_of_properties
from .rover_airframe import RoverAirframe

__all__ = [
    "Airframe",
    "AirframeError",
    "CopterAirframe",
    "Rotor",
    "RoverAirframe",
    "apply",
    "check_kind",
    "is_file",
    "load",
    "names",
    "of_data",
    "to_data",
    "to_toml",
]

_FRAMES = (
    "ardupilot_x", "ardupilot_hexa", "ardupilot_hexa_x", "ardupilot_octa", "ardupilot_octa_quad", "ardupilot_y6",
    "calibration_copter", "calibration_rover",
)  # fmt: skip
"""Rows of ``ardupilot_frames``."""
_MODULES = (
    "erle_copter", "ardupilot_quad", "erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover", *_FRAMES,
)  # fmt: skip
GROUP = "sitl.airframes"
"""Entry points of airframes of other packages: name -> Airframe."""


def names(kind: str | None = None, *, on_bench: bool = True) -> tuple[str, ...]:
    """Names of the airframes that ``load`` knows: all, or those of a kind of vehicle; without ``on_bench``, those that
    move by themselves.
    """
    known = tuple(dict.fromkeys((*_MODULES, *_installed())))
    if kind is not None:
        known = tuple(name for name in known if load(name).kind == kind)
    return known if on_bench else tuple(name for name in known if not load(name).properties.get("on_bench"))


def load(name: str | Airframe) -> Airframe:
    """An airframe by its name (hyphens and underscores are the same), or by the path of a user's own file: a .toml file
    (data, as ``to_toml`` writes it), or a .py file that defines ``AIRFRAME``; an airframe is returned as it is.

    Raises:
        AirframeError: no airframe of that name (the message lists those there are), or the file cannot be used.
    """
    if isinstance(name, Airframe):
        return name
    if not isinstance(name, str):
        raise AirframeError(f"airframe {name!r} is neither a name, a .toml or .py file nor an Airframe")
    if name.endswith(airframe_file.ENDING):
        return airframe_file.read(name, _classes())
    if name.endswith(".py"):
        return _load_file(Path(name))
    module = name.strip().lower().replace("-", "_")
    if module not in names():
        raise AirframeError(
            f"airframe {name!r} is not known; it is one of {', '.join(names())}, or a .toml or .py file"
        )
    if module in _FRAMES:
        found = importlib.import_module(f"{__name__}.ardupilot_frames").FRAMES[module]
    elif module in _MODULES:
        found = importlib.import_module(f"{__name__}.{module}").AIRFRAME
    else:
        found = _installed()[module].load()
    if not isinstance(found, Airframe):
        raise AirframeError(f"airframe {name!r}: {found!r} is no Airframe")
    return found


def check_kind(airframe: Airframe, kind: str) -> None:
    """Refuses an airframe where another kind of vehicle is wanted.

    Raises:
        AirframeError: it is of another kind; the message lists airframes of the wanted one.
    """
    if airframe.kind != kind:
        raise AirframeError(f"{airframe.title} is a {airframe.kind}; those of a {kind} are {', '.join(names(kind))}")


def is_file(name: str) -> bool:
    """Whether ``load`` takes a text for the path of a file."""
    return name.endswith((airframe_file.ENDING, ".py"))


def to_toml(airframe: Airframe, *, head: Sequence[str] = (), notes: Mapping[str, str] | None = None) -> str:
    """An airframe as the text of a .toml file, of which ``load`` makes the same airframe, bit for bit.

    Args:
        airframe: of a kind that comes with the simulator.
        head: lines that the file begins with, as comments.
        notes: name of a property or parameter -> what stands behind its value, as a comment.
    """
    return airframe_file.written(airframe, head=head, notes=notes)


def _classes() -> dict[str, type[Airframe]]:
    """Kind of vehicle -> class of its airframes: those that come with the simulator, and those of packages that have
    an airframe here."""
    known: dict[str, type[Airframe]] = {cls.kind: cls for cls in (CopterAirframe, RoverAirframe)}
    for point in _installed():
        found = load(point)
        known.setdefault(found.kind, type(found))
    return known


@cache
def _installed() -> dict[str, EntryPoint]:
    return {point.name: point for point in entry_points(group=GROUP)}


def to_data(airframe: Airframe) -> dict[str, Any]:
    """An airframe as JSON has it: "name", "properties", "parameters"."""
    record = airframe.record()
    properties = {name: _plain(record[name]) for name in record.dtype.names or ()}
    return {"name": airframe.name, "properties": properties, "parameters": dict(airframe.parameters)}


def _plain(value: Any) -> Any:
    """As JSON has it."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, np.generic) else value


def of_data(kind: type[Airframe], data: Mapping[str, Any]) -> Airframe:
    """An airframe from a data file: "name", "properties", "parameters", as ``to_data`` has them; "figures" in a file
    of version 0.1.

    Nothing that the data names is loaded or run.

    Args:
        kind: class of the airframe.
        data: as above.

    Raises:
        AirframeError: the data make no airframe.
    """
    try:
        return kind.of_record(str(data["name"]), data[key_of_properties(data)], data["parameters"])
    except AirframeError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise AirframeError(f"data of an airframe that cannot be understood: {error!r}") from None


def _load_file(path: Path) -> Airframe:
    try:
        scope = runpy.run_path(str(path))
    except AirframeError:
        raise
    except OSError as error:
        raise AirframeError(f"airframe file {str(path)!r} cannot be read: {error.strerror or error}") from None
    except Exception as error:  # whatever a user's file raises is a fault of the file
        raise AirframeError(f"airframe file {str(path)!r}: {type(error).__name__}: {error}") from error
    found = scope.get("AIRFRAME")
    if not isinstance(found, Airframe):
        raise AirframeError(f"airframe file {str(path)!r} does not define AIRFRAME, an Airframe")
    return found
