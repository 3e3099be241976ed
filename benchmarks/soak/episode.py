# SPDX-License-Identifier: BSD-3-Clause
"""Flies the deeds of an episode, and looks after each of them whether all is as it must be."""

from __future__ import annotations

import signal
import traceback
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.bridge.frame import Splitter
from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.core.mavlink import MavResult
from sitl.simulation import Simulation, Snapshot

from .deeds import Deed

FINITE = ("autopilot.estimate", "autopilot.home", "autopilot.modes", "physics.body")
"""Parts of the record in which every number must be one."""
FORMS = ("f8", "f4")
PERIOD_S = 0.02
"""A rover's motors are at rest within this after it is disarmed; a copter's within a tick [s]."""
HANG_S = 60.0
"""Wall time that a deed may take [s]."""
COMMANDS = {"COMMAND_LONG", "COMMAND_INT"}


class BrokenError(Exception):
    """Something that must hold does not."""


class Traffic:
    """A tap: commands that the vehicle heard, and its answers."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation, self._splitter = simulation, Splitter()
        self._systems: set[int] = set()
        """System ids that the vehicle has had: answers may be on their way while MAV_SYSID is set."""
        self.heard, self.answered = Counter[int](), Counter[int]()

    def frame(self, time_us: int, raw: bytes) -> None:
        """One frame, in or out."""
        system = self._simulation.bridge.system
        self._systems.add(system)
        for frame in self._splitter.feed(raw):
            name = frame.kind.name
            if name not in (*COMMANDS, "SET_MODE", "COMMAND_ACK"):
                continue
            fields: Any = frame.kind.decode(frame.payload)
            is_own = frame.system in self._systems and frame.component == 1
            if name == "COMMAND_ACK" and is_own:
                self.answered[fields.command] += fields.result != MavResult.IN_PROGRESS
            elif name != "COMMAND_ACK" and not is_own and fields.target_system in (0, system):
                self.heard[fields.command if name in COMMANDS else frame.kind.id] += 1


class Numbers:
    """All numbers with a fraction in FINITE.

    Args:
        fleet: of one vehicle.
    """

    def __init__(self, fleet: npt.NDArray[Any]) -> None:
        self._chosen = _chosen(fleet.dtype)
        self._views = [fleet.view(np.uint8).reshape(-1).view(form) for form in FORMS]

    def not_finite(self) -> list[str]:
        """Names of those that are not finite."""
        return [
            names[k]
            for view, (at, names) in zip(self._views, self._chosen, strict=True)
            for k in np.flatnonzero(~np.isfinite(view[at])).tolist()
        ]


@cache
def _chosen(dtype: np.dtype[Any]) -> list[tuple[npt.NDArray[np.int64], list[str]]]:
    """Places of FINITE in arrays of each of FORMS on a record's memory, and names."""
    places = [place for name in FINITE for place in _places(dtype, name.split("."))]
    chosen = [[(name, at) for name, at, code in places if code == form] for form in FORMS]
    sizes = [np.dtype(form).itemsize for form in FORMS]
    return [
        (np.array([at // size for _, at in of_form]), [name for name, _ in of_form])
        for of_form, size in zip(chosen, sizes, strict=True)
    ]


def _places(dtype: np.dtype[Any], path: Sequence[str], name: str = "", at: int = 0) -> Iterator[tuple[str, int, str]]:
    """Name, offset and code of each number in a part of a record."""
    if dtype.names:
        for part in path[:1] or dtype.names:
            assert dtype.fields is not None
            inner, offset = dtype.fields[part][:2]
            yield from _places(inner, path[1:], f"{name}.{part}".lstrip("."), at + offset)
    elif dtype.subdtype:
        inner, shape = dtype.subdtype
        for k in range(int(np.prod(shape))):
            yield from _places(inner, (), f"{name}[{k}]", at + k * inner.itemsize)
    else:
        yield name, at, dtype.str[1:]


class Episode:
    """A vehicle, a client, and what has been done so far.

    Args:
        simulation: the vehicle, new: an episode depends on its deeds alone. It is put to ``begin``.
        begin: where the episode begins.
    """

    def __init__(self, simulation: Simulation, begin: Snapshot) -> None:
        self.simulation = simulation
        simulation.restore(begin)
        self._link = InProcessLink()
        simulation.bridge.add_link(self._link)
        self._traffic, self._numbers = Traffic(simulation), Numbers(simulation.fleet)
        simulation.bridge.taps.append(self._traffic)
        self._is_rewired = False
        self._armed_us = -1
        """When it was armed last; -1 it is armed, or not known."""
        self._disarmed_s = 0.0
        """How long it has been disarmed at least [s]."""

    def run(self, deeds: Sequence[Deed]) -> tuple[int, str] | None:
        """Do them all; gives the number of the deed after which something was wrong, and what; None: all was right."""
        for number, deed in enumerate(deeds):
            try:
                with _limit(HANG_S):
                    self._do(deed)
                    self._check(deed.seconds)
            except BrokenError as error:
                return number, str(error)
            except Exception as error:
                where = traceback.extract_tb(error.__traceback__)[-1]
                return number, f"{type(error).__name__}: {error} ({where.name}, line {where.lineno})"
        return None

    def _do(self, deed: Deed) -> None:
        simulation = self.simulation
        self._is_rewired |= deed.what.startswith("SERVO")  # its trim is what a rover's motors get when disarmed
        if deed.kind == "bytes":
            self._link.send(bytes.fromhex(deed.data))
        elif deed.kind == "link":
            words = dict(pair.split("=") for pair in deed.data.split(",")) if deed.data else {}
            simulation.set_link_faults(LinkFaults.of_texts({name: [word] for name, word in words.items()}))
        elif deed.kind == "forget":
            simulation.bridge.remove_link(self._link)
            self._link = InProcessLink()
            simulation.bridge.add_link(self._link)
        else:
            simulation.request_reboot()
        simulation.advance(deed.seconds)
        self._link.receive()

    def _check(self, seconds: float) -> None:
        """``seconds`` after the last check."""
        v, kind = self.simulation.v, self.simulation.kind
        if bad := self._numbers.not_finite():
            raise BrokenError(f"not finite: {', '.join(bad)}")
        if not all(-1.0 <= float(c) <= 1.0 for c in v.actuators.controls[:8]):
            raise BrokenError(f"controls {list(v.actuators.controls[:8])}")
        arming = v.autopilot.arming
        is_as_before = not arming.armed and arming.armed_us == self._armed_us
        self._armed_us = -1 if arming.armed else arming.armed_us
        self._disarmed_s = self._disarmed_s + seconds if is_as_before else 0.0
        if self._disarmed_s >= PERIOD_S and not self._is_rewired and kind.motor_output(v) != 0.0:
            raise BrokenError(f"disarmed, and the motors turn: {kind.motor_output(v):g}")
        traffic = self._traffic
        if traffic.heard != traffic.answered:
            more = {k: (traffic.heard[k], traffic.answered[k]) for k in traffic.heard | traffic.answered}
            wrong = {k: both for k, both in more.items() if both[0] != both[1]}
            raise BrokenError(f"commands (heard, answered): {wrong}")


@contextmanager
def _limit(seconds: float) -> Iterator[None]:
    """BrokenError when the block takes longer, in wall time; where the system has no such alarm, there is no limit."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def ring(number: int, frame: object) -> None:
        raise BrokenError(f"hangs: no end after {seconds:g} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
