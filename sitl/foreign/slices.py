# SPDX-License-Identifier: BSD-3-Clause
"""A foreign autopilot advanced slice by slice, for scripts in simulated time (``sitl exec``)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from ..errors import LinkLostError
from ..plants.physics_server import WAIT_S, Silence
from ..run.runner import Pace
from .json_host import ANSWERS
from .process import AutopilotProcess
from .relay import Relay

LOST_S = 30.0
"""Wall time after which an autopilot that asks for nothing is lost to a script that waits for it [s]."""


class StepHost(Protocol):
    """Serves a plant to an autopilot, step by step."""

    before_boot_us: int

    @property
    def time_us(self) -> int:
        """Simulated time since power-on [us]."""

    def listen(self) -> bool:
        """Wait a moment until the autopilot asks for a step; whether it does."""

    def step(self, until_us: int | None = None, answers: int = 1) -> None:
        """Give it the step, and up to so many in all, no further than ``until_us``."""

    def close(self) -> None:
        """Serve no more."""


class SlicedSession:
    """A session that can be advanced in slices. Clients and autopilot hear each other between two slices, when the
    autopilot has done all that it does until then."""

    host: StepHost
    name: str
    """Of the autopilot, for messages."""
    process: AutopilotProcess | None
    relay: Relay | None
    say: Callable[[str], None]

    @property
    def time_us(self) -> int:
        """Simulated time since the start; reboots do not set it back [us]."""
        return self.host.before_boot_us + self.host.time_us

    def act(self) -> None:
        """Let what clients set act on the physics; between two ticks."""

    def serve_slices(
        self,
        pace: Pace[SlicedSession],
        *,
        until_us: int | None = None,
        running: Callable[[], bool] = lambda: True,
        on_slice: Callable[[], None] = lambda: None,
    ) -> None:
        """As ``sitl.run.runner.serve``.

        Raises:
            AutopilotEndedError: the program has ended.
            LinkLostError: it has asked for no step in LOST_S.
        """
        host, relay, process = self.host, self.relay, self.process
        assert relay is not None and process is not None
        silence = Silence(self.say, lambda: f"{self.time_us * 1e-6:.4f} s")
        while running() and (until_us is None or self.time_us < until_us):
            goal = self.time_us + pace.slice_us
            goal = goal if until_us is None else min(goal, until_us)
            while running():
                if not host.listen():
                    process.check()
                    relay.turn(0.0)
                    silence.goes_on()
                    if silence.waits * WAIT_S > LOST_S:
                        last = process.last_output()
                        raise LinkLostError(
                            f"autopilot {self.name} has not asked its physics in {LOST_S:g} s; it said: {last}"
                        )
                    on_slice()
                    continue
                if silence.waits:
                    silence.is_over()
                if self.time_us >= goal:
                    break
                host.step(goal - host.before_boot_us, ANSWERS)
            relay.turn(0.0)
            self.act()
            on_slice()
            pace.after_slice(self)
