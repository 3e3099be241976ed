# SPDX-License-Identifier: BSD-3-Clause
"""Whether a vehicle is a simulator. Only one that proves it may be disarmed by force and rebooted unasked.

The vehicle that is meant is asked, by its system and component, and by questions that change no vehicle. Three signs
must be there, and nothing may speak against them:

- It gives its parameter SIM_WIND_SPD when it is asked for that by name. ArduPilot's SIM_ parameters are compiled into
  its simulator builds only (https://ardupilot.org/dev/docs/sitl-parameters.html). What it sends for another client's
  list of parameters has a number and does not count.
- It accepts the request for SIMSTATE, in an answer to this client, and sends it. That is the truth of a simulation: a
  flight controller has none, and refuses.
- Its AUTOPILOT_VERSION names no board and no USB device. A flight controller's does.

A refusal that is addressed to nobody speaks against it, too: an older flight controller does not say whom it answers.

A vehicle that answers more often than it was asked is two vehicles with the same ids, and so is one whose telemetry
is that of two (``voices``): none of them has proved anything. A frame that the link repeats is counted once. Two
answers to a question that the link has repeated cannot be told from those of two vehicles, and prove nothing.

It is listened to by the wall clock, at a socket, also when the vehicle's time stands: another one's does not.
"""

from __future__ import annotations

from typing import Any, Protocol

from ..bridge.dialect import MessageType, message
from ..core.mavlink import MavResult
from .commands import command_number
from .endpoint import ACK, AUTOPILOT, HEARTBEAT, PARAMETER, Endpoint
from .voices import Voices

PARAMETER_NAME = "SIM_WIND_SPD"
REQUEST_MESSAGE = command_number("REQUEST_MESSAGE")
VERSION, TRUTH, ERROR = (message(name) for name in ("AUTOPILOT_VERSION", "SIMSTATE", "PARAM_ERROR"))
BY_NAME = 0xFFFF
"""``param_index`` of a PARAM_VALUE that was asked for by name."""
LOOK_US, LOOKS, TRIES = 20_000, 25, 6
"""Time between two looks at a vehicle [us], looks after a question, and how often it is asked."""
QUIET_US = 100_000
"""So long is it listened to before: what it was asked earlier is answered by then [us]."""
CONTRADICTION_US = 1_200_000
"""So long is it listened to after all signs have come: another one with its ids may be slower, and sends a HEARTBEAT
each second [us]."""
CHANGE_US = 2_200_000
"""And so long after that, when HEARTBEATs have reported a change: it has changed, or there are two [us]."""


class Link(Protocol):
    """What is needed to ask a vehicle: a ``Connection`` is one."""

    is_exact: bool
    inbox: Any

    @property
    def endpoint(self) -> Endpoint:
        """Encodes what is sent."""
        ...

    @property
    def system(self) -> int:
        """MAVLink id of the vehicle. Raises LinkLostError when none has been heard."""
        ...

    def ask_parameter(self, name: str) -> None:
        """Ask the vehicle for a parameter by its name."""
        ...

    def listen(self, us: int) -> None:
        """Send what is kept and take in what comes within this wall time [us]. Raises LinkLostError."""
        ...


class Signs:
    """What a vehicle has answered.

    Args:
        link: to the vehicle.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self.voices = Voices(link.is_exact)
        self._asked = self._answers = 0
        self._given: set[MessageType] = set()
        """Which of the signs are there, each by its message."""
        self._accepted = 0
        self._against = ""
        """What it has said against itself."""

    @property
    def against(self) -> str:
        """What speaks against a simulator; "": nothing."""
        two = f"two vehicles seem to have the ids of system {self._link.system}: {self.voices.doubt}"
        return self._against or (two if self.voices.doubt else "")

    @property
    def received(self) -> bool:
        """Whether it has answered anything."""
        return bool(self._given or self._answers or self._against)

    @property
    def _shows_truth(self) -> bool:
        """Both requests are accepted, so that of SIMSTATE is, and it has come."""
        return TRUTH in self._given and self._accepted >= 2

    @property
    def doubt(self) -> str:
        """Why this is no proof; "": it is one."""
        if self.against:
            return self.against
        missing = []
        if PARAMETER not in self._given:
            missing.append(f"it does not give its parameter {PARAMETER_NAME}")
        if not self._shows_truth:
            missing.append("it does not send SIMSTATE when it is asked to")
        if VERSION not in self._given:
            missing.append("it does not send AUTOPILOT_VERSION")
        return ", ".join(missing)

    def ask(self) -> None:
        """Ask for the signs that are missing."""
        link = self._link
        if PARAMETER not in self._given:
            link.ask_parameter(PARAMETER_NAME)
        if VERSION not in self._given:
            self._request(VERSION)
        if not self._shows_truth:
            self._request(TRUTH)

    def _request(self, kind: MessageType) -> None:
        self._asked += 1
        self._link.endpoint.command(REQUEST_MESSAGE, kind.id, target=self._link.system)

    def hear(self, frames: list[tuple[Any, ...]]) -> None:
        """Frames as they come, some of them the vehicle's."""
        link = self._link
        for kind, payload, sequence, system, component, _, _ in frames:
            if component != AUTOPILOT or system != link.system or self.voices.is_repeated(kind, payload, sequence):
                continue
            fields = kind.decode(payload)
            if kind is not HEARTBEAT or link.inbox.is_for_us(kind, fields):
                self.voices.take(kind, sequence, fields)
            if link.inbox.is_for_us(kind, fields):
                self.take(kind, fields)

    def take(self, kind: MessageType, fields: Any) -> None:
        """A message of the vehicle."""
        system = self._link.system
        if kind is PARAMETER and fields.param_id.decode("ascii", "replace") == PARAMETER_NAME:
            if fields.param_index == BY_NAME:
                self._given.add(kind)
        elif kind is ERROR and fields.param_id.decode("ascii", "replace") == PARAMETER_NAME:
            self._against = f"it says that it has no parameter {PARAMETER_NAME}"
        elif kind is ACK and fields.command == REQUEST_MESSAGE:
            self._answered(fields)
        elif kind is TRUTH and self._asked:
            self._given.add(kind)
        elif kind is VERSION:
            if fields.board_version or fields.vendor_id or fields.product_id:
                board = f"{fields.board_version >> 16}, USB {fields.vendor_id:04x}:{fields.product_id:04x}"
                self._against = f"its AUTOPILOT_VERSION names a flight controller (board {board})"
            self._given.add(kind)
        if self._answers > self._asked:
            self._against = (
                f"system {system} answers more often than it is asked, as two vehicles with its ids would, or one on a "
                "link that repeats what it is asked"
            )

    def _answered(self, fields: Any) -> None:
        own = self._link.endpoint
        if (fields.target_system, fields.target_component) != (own.system, own.component):
            if fields.result not in (MavResult.ACCEPTED, MavResult.TEMPORARILY_REJECTED, MavResult.IN_PROGRESS):
                self._refused(fields.result)
            return  # an answer to everybody may be to anybody
        if fields.result in (MavResult.TEMPORARILY_REJECTED, MavResult.IN_PROGRESS):
            self._asked -= 1  # and is not counted
            return
        self._answers += 1
        if fields.result == MavResult.ACCEPTED:
            self._accepted += 1
        else:
            self._refused(fields.result)

    def _refused(self, result: int) -> None:
        self._against = f"it refuses SIMSTATE or AUTOPILOT_VERSION (MAV_RESULT {result})"


def ask(link: Link, tries: int = TRIES) -> Signs:
    """Ask a vehicle for the signs, and listen to what contradicts them.

    Args:
        link: to the vehicle, which has been heard.
        tries: how often it is asked for what does not come.

    Raises:
        LinkLostError: the connection is lost.
    """
    signs, inbox = Signs(link), link.inbox
    link.listen(QUIET_US)
    inbox.overhear = signs.hear
    try:
        for _ in range(tries):
            signs.ask()
            for _ in range(LOOKS):
                link.listen(LOOK_US)
                if signs.against or not signs.doubt:
                    break
            if signs.against or not signs.doubt:
                break
        if not signs.doubt:
            link.listen(CONTRADICTION_US)
        if not signs.doubt and signs.voices.has_changed:
            link.listen(CHANGE_US)
    finally:
        inbox.overhear = None
    return signs
