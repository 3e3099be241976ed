# SPDX-License-Identifier: BSD-3-Clause
"""Vehicles as data: one file an airframe. To add one, write its file and name it in ``_MODULES``."""

from __future__ import annotations

import importlib

from .airframe import Airframe, AirframeError, Rotor, apply

__all__ = ["Airframe", "AirframeError", "Rotor", "apply", "load", "names"]

_MODULES = ("erle_copter", "ardupilot_quad")


def names() -> tuple[str, ...]:
    """Names of the airframes that ``load`` knows."""
    return _MODULES


def load(name: str) -> Airframe:
    """An airframe by its name (hyphens and underscores are the same).

    Raises:
        AirframeError: no airframe of that name; the message lists those there are.
    """
    module = name.strip().lower().replace("-", "_")
    if module not in _MODULES:
        raise AirframeError(f"airframe {name!r} is not known; it is one of {', '.join(_MODULES)}")
    found: Airframe = importlib.import_module(f"{__name__}.{module}").AIRFRAME
    return found
