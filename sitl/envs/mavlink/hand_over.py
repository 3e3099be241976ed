# SPDX-License-Identifier: BSD-3-Clause
"""The hand-over: a vehicle is asked for one of its own modes until it is in it.

It depends on nothing that can fail beside the link: no log, no text, none of the state that an exception may have left
half changed. What it found is said afterwards, by others.
"""

from __future__ import annotations

import contextlib
import time
from typing import Any

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.client.commands import command_number
from sitl.client.connection import Remote
from sitl.client.endpoint import ACK, AUTOPILOT, HEARTBEAT
from sitl.client.proof import REQUEST_MESSAGE
from sitl.core.mavlink import MavModeFlag, MavResult

from .preparation import mode_parameters

BOUND_S = 10.0
"""Wall time after which a vehicle that has not answered is given up [s]."""
REFUSED_S = 2.0
"""The same of one that refuses [s]."""
REPEAT_S = 0.25
"""Wall time after which the command, or the question for a HEARTBEAT, is sent again [s]."""
SILENCE_S = 2.0
"""A vehicle that has accepted it and sends no HEARTBEAT for so long is believed [s]."""
AGAIN_S = 1.2
"""Wall time after which one that has accepted it is asked again: it may have meant an earlier command [s]."""
_WRITE_S = 1.0
"""Wall time that sending it may take: a full line must not hold up the rest [s]."""
_OLD_S = 1.5
"""So long after the first command, a heartbeat is of the time after it [s]."""
_LONG, _SET_MODE = message("COMMAND_LONG"), command_number("DO_SET_MODE")


class HandOver:
    """One hand-over.

    Args:
        link: to the vehicle.
        mode: number of the mode that takes over.
        guided: number of the mode that the vehicle is in while it is ours.
        knows: whether what the link has heard last of mode and arming is so: not while the vehicle is being prepared.
    """

    def __init__(self, link: Remote, mode: int, guided: int, knows: bool = True) -> None:
        self._link, self._mode, self._guided, self._knows = link, mode, guided, knows
        self._splitter = Splitter()  # the link's own may have been interrupted in the middle of a frame
        self.is_done = False
        """Whether the vehicle is in the mode, or in another's hands."""
        self.sent = 0
        """How often the vehicle was asked."""
        self.result: int | None = None
        """MAV_RESULT of the last answer; None: there was none."""
        self.error: Exception | None = None
        """The last one that sending or listening raised."""
        self._began = time.monotonic()
        self._accepted_s: float | None = None
        """When it was accepted; None: it was not, or a HEARTBEAT since says otherwise."""

    def run(self) -> None:
        """Ask until the vehicle is in the mode, or is in another's hands, or does not answer. Raises no
        ``Exception``."""
        with contextlib.suppress(Exception):
            self._link.stream.limit(_WRITE_S)
        with contextlib.suppress(Exception):
            inbox = self._link.inbox
            self.is_done = self._knows and not (inbox.armed and inbox.mode == self._guided)
        self._listen(0.0)  # a pilot may have taken it since
        while not self.is_done:
            now = time.monotonic()
            is_refused = self.result not in (None, MavResult.ACCEPTED)
            if now - self._began > (REFUSED_S if is_refused else BOUND_S):
                return
            if self._accepted_s is None or now - self._accepted_s > AGAIN_S:
                flag, mode, below = mode_parameters(self._mode)
                confirmation = min(self.sent, 255)
                self._send(_SET_MODE, confirmation=confirmation, param1=flag, param2=mode, param3=below)
                self.sent += 1
            if self._accepted_s is not None:
                self._send(REQUEST_MESSAGE, param1=HEARTBEAT.id)
            while not self.is_done and (left := now + REPEAT_S - time.monotonic()) > 0.0:
                self._listen(left)
                self._believe()

    def _send(self, number: int, **fields: float) -> None:
        try:
            link, endpoint = self._link, self._link.endpoint
            target = {"target_system": link.inbox.system, "target_component": AUTOPILOT}
            payload = _LONG.payload(command=number, **target, **fields)
            frame = encode_v2(_LONG, payload, endpoint.sequence & 0xFF, endpoint.system, endpoint.component)
            endpoint.sequence = (endpoint.sequence + 1) & 0xFF
            link.stream.write(frame)  # past what an interrupted step has left to be sent
        except Exception as error:
            self.error = error

    def _listen(self, seconds: float) -> None:
        try:
            stream = self._link.stream
            if stream.wait(seconds):
                data = stream.receive()
                for kind, payload, _, system, component, _, _ in self._splitter.cut(data):
                    if component == AUTOPILOT and system == self._link.inbox.system and kind in (HEARTBEAT, ACK):
                        self._hear(kind, kind.decode(payload))
                self._link.inbox.feed(data)
        except Exception as error:
            self.error = error
            time.sleep(min(seconds, REPEAT_S))  # of a link that is gone, too, the vehicle is asked again

    def _hear(self, kind: Any, fields: Any) -> None:
        if kind is HEARTBEAT:
            if not self._link.inbox.is_for_us(kind, fields):
                return
            is_ours = bool(fields.base_mode & MavModeFlag.SAFETY_ARMED) and fields.custom_mode == self._guided
            is_news = self._knows or time.monotonic() - self._began > _OLD_S
            self.is_done = self.is_done or fields.custom_mode == self._mode or (is_news and not is_ours)
            if not self.is_done:
                self._accepted_s = None  # what was accepted was not this
        elif fields.command == _SET_MODE and self.sent and fields.result != MavResult.IN_PROGRESS:
            own = self._link.endpoint
            target = fields.target_system, fields.target_component
            if target not in ((own.system, own.component), (0, 0)):
                return  # another station's
            self.result = int(fields.result)
            if self.result == MavResult.ACCEPTED and target != (0, 0) and self._accepted_s is None:
                self._accepted_s = time.monotonic()
                self._send(REQUEST_MESSAGE, param1=HEARTBEAT.id)

    def _believe(self) -> None:
        """One that sends no HEARTBEAT, but has accepted it."""
        is_silent = self._accepted_s is not None and time.monotonic() - self._accepted_s > SILENCE_S
        self.is_done = self.is_done or is_silent

    @property
    def failure(self) -> str:
        """What is known when the vehicle could not be brought into the mode."""
        if self.result == MavResult.ACCEPTED:
            return f"it accepts mode {self._mode}, but no HEARTBEAT says in {BOUND_S:g} s that it is in it"
        if self.result is not None:
            return f"it refuses mode {self._mode} (MAV_RESULT {self.result})"
        why = f" ({self.error})" if self.error is not None else ""
        return f"it does not answer DO_SET_MODE to mode {self._mode}, sent {self.sent} times in {BOUND_S:g} s{why}"
