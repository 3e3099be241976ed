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

from sitl.bridge.frame import Splitter
from sitl.bridge.links import InProcessLink, LinkFaults
from sitl.core.records import as_dict
from sitl.simulation import Simulation, Snapshot

from .deeds import Deed

FINITE = ("estimate", "home", "modes")
"""Parts of the autopilot's record in which every number must be one."""
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
        self._traffic = Traffic(simulation)
        simulation.bridge.taps.append(self._traffic)

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
        for name in FINITE:
            bad = list(_not_finite(as_dict(getattr(v.autopilot, name)), name))
            if bad:
                raise BrokenError(f"not finite: {', '.join(bad)}")
        if bad := list(_not_finite(as_dict(v.physics.body), "body")):
            raise BrokenError(f"not finite: {', '.join(bad)}")
        if not all(-1.0 <= float(c) <= 1.0 for c in v.actuators.controls[:8]):
            raise BrokenError(f"controls {list(v.actuators.controls[:8])}")
        if not v.autopilot.arming.armed and kind.motor_output(v) != 0.0:
            raise BrokenError(f"disarmed, and the motors turn: {kind.motor_output(v):g}")
        traffic = self._traffic
        if traffic.heard != traffic.answered:
            more = {k: (traffic.heard[k], traffic.answered[k]) for k in traffic.heard | traffic.answered}
            wrong = {k: both for k, both in more.items() if both[0] != both[1]}
            raise BrokenError(f"commands (heard, answered): {wrong}")


def _not_finite(value: Any, name: str) -> Iterator[str]:
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _not_finite(part, f"{name}.{key}")
    elif not np.isfinite(np.asarray(value, float)).all():
        yield name


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
