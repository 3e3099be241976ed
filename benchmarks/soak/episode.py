# SPDX-License-Identifier: BSD-3-Clause
"""Flies the deeds of an episode, and looks after each of them whether all is as it must be."""

from __future__ import annotations

import signal
import traceback
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.bridge.frame import Splitter
from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.simulation import Simulation, Snapshot

from .deeds import Deed

FINITE = ("autopilot.estimate", "autopilot.home", "autopilot.modes", "physics.body")
"""Parts of the record in which every number must be one."""
HANG_S = 60.0
"""Wall time that a deed may take [s]."""
COMMANDS = {"COMMAND_LONG", "COMMAND_INT"}
IN_PROGRESS = 5
"""MAV_RESULT: another answer will follow."""


class BrokenError(Exception):
    """Something that must hold does not."""


class Traffic:
    """A tap: commands that the vehicle heard, and its answers."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation, self._splitter = simulation, Splitter()
        self.heard, self.answered = Counter[int](), Counter[int]()

    def frame(self, time_us: int, raw: bytes) -> None:
        """One frame, in or out."""
        for frame in self._splitter.feed(raw):
            name, system = frame.kind.name, self._simulation.bridge.system
            if name not in (*COMMANDS, "SET_MODE", "COMMAND_ACK"):
                continue
            fields: Any = frame.kind.decode(frame.payload)
            is_own = (frame.system, frame.component) == (system, 1)
            if name == "COMMAND_ACK" and is_own:
                self.answered[fields.command] += fields.result != IN_PROGRESS
            elif name != "COMMAND_ACK" and not is_own and fields.target_system in (0, system):
                self.heard[fields.command if name in COMMANDS else frame.kind.id] += 1


class Numbers:
    """All numbers with a fraction in FINITE.

    Args:
        fleet: of one vehicle.
    """

    def __init__(self, fleet: npt.NDArray[Any]) -> None:
        places = [place for name in FINITE for place in _places(fleet.dtype, name.split("."))]
        self._views = []
        for form in ("f8", "f4"):
            chosen = [(name, at) for name, at, code in places if code == form]
            view = fleet.view(np.uint8).reshape(-1).view(form)
            self._views.append((view, [at // view.itemsize for _, at in chosen], [name for name, _ in chosen]))

    def not_finite(self) -> list[str]:
        """Names of those that are not finite."""
        return [
            names[k] for view, at, names in self._views for k in np.flatnonzero(~np.isfinite(view[at])).tolist()
        ]  # fmt: skip


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

    def run(self, deeds: Sequence[Deed]) -> tuple[int, str] | None:
        """Do them all; gives the number of the deed after which something was wrong, and what; None: all was right."""
        for number, deed in enumerate(deeds):
            try:
                with _limit(HANG_S):
                    self._do(deed)
                    self._check()
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

    def _check(self) -> None:
        v, kind = self.simulation.v, self.simulation.kind
        if bad := self._numbers.not_finite():
            raise BrokenError(f"not finite: {', '.join(bad)}")
        if not all(-1.0 <= float(c) <= 1.0 for c in v.actuators.controls[:8]):
            raise BrokenError(f"controls {list(v.actuators.controls[:8])}")
        if not (v.autopilot.arming.armed or self._is_rewired) and kind.motor_output(v) != 0.0:
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
