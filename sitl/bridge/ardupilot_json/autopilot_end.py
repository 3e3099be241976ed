# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot end of the JSON interface: frames of servos out, lines of motion in. Neither socket nor clock."""

from __future__ import annotations

from collections.abc import Sequence

from ...core.constants import TICK_HZ
from . import answer, servos
from .answer import Motion, MotionError
from .servos import Servos

RATE = TICK_HZ
"""Steps a second that our autopilot asks for [Hz]: one for each of its loops."""
LONGEST_S = 0.1
"""A longer step of the physics is a jump of its clock [s]."""


class AutopilotEnd:
    """Counts the frames, and keeps the time of the physics."""

    def __init__(self, rate: int = RATE) -> None:
        self.rate = rate
        self.count = 0
        """Lines taken so far."""
        self.time: float | None = None
        """Of the physics, when it last answered [s]; None before."""
        self.refused = 0
        """Lines that could not be taken."""
        self.note = ""
        """Something that people should be told; who takes it empties it."""
        self._has_complained = False

    def frame(self, pulses: Sequence[int]) -> bytes:
        """The datagram to send; the same again when no answer comes."""
        return servos.encode(Servos(self.rate, self.count, tuple(pulses)))

    def receive(self, datagram: bytes) -> tuple[Motion, float] | None:
        """The motion in the last line of a datagram and how long a step it ends [s]; None when there is none.

        The step of the first line is the one asked for: wherever the clock of the physics stands, the autopilot's
        begins. It is negative when the physics has begun anew, and 0 for a line without new time: an answer that came
        twice, which answers nothing and is not counted, or the same one would from then on be taken for the next.
        """
        lines = [line for line in datagram.split(b"\n") if line.strip()]
        if not lines:
            self._refuse("an empty datagram")
            return None
        try:
            decoded = answer.decode(lines[-1])
        except MotionError as error:
            self._refuse(str(error))
            return None
        before, self.time = self.time, decoded.time
        if before == decoded.time:
            return decoded, 0.0
        self.count = (self.count + 1) & servos.COUNT_MASK
        return decoded, 1.0 / self.rate if before is None else decoded.time - before

    def restart(self) -> None:
        """The autopilot starts anew: the count begins at 0, which tells physics to begin anew as well."""
        self.count, self.time = 0, None

    def _refuse(self, why: str) -> None:
        self.refused += 1
        if not self._has_complained:
            self.note, self._has_complained = f"physics sent no motion, and is not believed: {why}", True
