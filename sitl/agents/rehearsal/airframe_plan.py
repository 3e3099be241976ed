# SPDX-License-Identifier: BSD-3-Clause
"""The changes that an airframe's file makes: the vehicle itself, and what its log leaves open."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from sitl import vehicles
from sitl.vehicles import Airframe, AirframeError

from ..errors import AgentError
from .change import Change
from .plan import Plan

GROUP = "vehicle"


def airframe_plan(path: str | Path) -> Plan:
    """The plan of an airframe with intervals: as it is, each property at both ends of its interval, and all drawn.

    Args:
        path: of the file, as ``sitl identify`` writes it, or the name of an airframe.

    Raises:
        AgentError: it cannot be read, or has no intervals.
    """
    airframe = airframe_of(path)
    if not airframe.intervals:
        raise AgentError(
            f"{airframe.title} has no intervals, which say how far off its properties may be: `sitl identify` writes "
            "them as a table [intervals]"
        )
    return Plan(Path(str(path)).stem, tuple(_changes(str(path), airframe)), summary=airframe.description)


def airframe_of(path: str | Path) -> Airframe:
    """The airframe of a file, or of a name.

    Raises:
        AgentError: it cannot be read.
    """
    try:
        return vehicles.load(str(path))
    except AirframeError as error:
        raise AgentError(str(error)) from None


def _changes(frame: str, airframe: Airframe) -> Iterator[Change]:
    options = {"frame": frame}
    yield Change(f"airframe {airframe.name}", GROUP, options=options)
    for name, ends in airframe.intervals.items():
        for word, value in zip(("least", "greatest"), ends):
            yield Change(f"{word} {name}", GROUP, set={name: value}, options=options)
    yield Change("drawn within the intervals", "together", identified=True, options=options)
