# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles as data: one file an airframe. To add one, write its file and name it in ``_MODULES``."""

from __future__ import annotations

import importlib
import runpy
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .airframe import Airframe, AirframeError, apply
from .copter_airframe import CopterAirframe, Rotor
from .rover_airframe import RoverAirframe

__all__ = ["Airframe", "AirframeError", "CopterAirframe", "Rotor", "RoverAirframe", "apply", "load", "names", "of_data"]

_MODULES = {
    "copter": ("erle_copter", "ardupilot_quad"),
    "rover": ("erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover"),
}
"""Kind of vehicle -> its airframes, the one that is taken when none is named first."""


def names(kind: str | None = None) -> tuple[str, ...]:
    """Names of the airframes that ``load`` knows: all, or those of a kind ("copter", "rover")."""
    return tuple(name for k, of_kind in _MODULES.items() if kind in (None, k) for name in of_kind)


def load(name: str | Airframe) -> Airframe:
    """An airframe by its name (hyphens and underscores are the same), or by the path of a Python file of the user's
    own that defines ``AIRFRAME``; an airframe is returned as it is.

    Raises:
        AirframeError: no airframe of that name (the message lists those there are), or the file cannot be used.
    """
    if isinstance(name, Airframe):
        return name
    if not isinstance(name, str):
        raise AirframeError(f"airframe {name!r} is neither a name, a .py file nor an Airframe")
    if name.endswith(".py"):
        return _load_file(Path(name))
    module = name.strip().lower().replace("-", "_")
    if module not in names():
        raise AirframeError(f"airframe {name!r} is not known; it is one of {', '.join(names())}, or a .py file")
    found: Airframe = importlib.import_module(f"{__name__}.{module}").AIRFRAME
    return found


def of_data(kind: str, data: Mapping[str, Any]) -> Airframe:
    """An airframe from a data file: "name", "figures", "parameters", as ``recording.identity.of_airframe`` has them.

    Nothing that the data names is loaded or run.

    Raises:
        AirframeError: there is no such kind; the data make no airframe.
    """
    known: dict[str, type[Airframe]] = {"copter": CopterAirframe, "rover": RoverAirframe}
    if kind not in known:
        raise AirframeError(f"airframe of the kind {kind!r}: it is one of {', '.join(known)}")
    try:
        return known[kind].of_record(str(data["name"]), data["figures"], data["parameters"])
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
        raise AirframeError(f"airframe file {str(path)!r} does not define AIRFRAME, a CopterAirframe or RoverAirframe")
    return found
