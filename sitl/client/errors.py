# SPDX-License-Identifier: BSD-3-Clause
"""What can go wrong between a client and its vehicle."""

from __future__ import annotations

from ..errors import OptionError, VehicleError


class UnknownNameError(OptionError):
    """A command, parameter, mode or channel that there is not; the message says which there are."""


class ClientError(VehicleError):
    """The vehicle did not do what it was asked to.

    Args:
        subject: what was asked for, as in "arming".
        problem: what came of it, as in "was refused: failed".
        since: simulated time at which it was asked for [s].
    """

    def __init__(self, subject: str, problem: str, since: float = 0.0) -> None:
        super().__init__(f"{subject} {problem}".strip())
        self.subject, self.since = subject, since
        self.texts: tuple[str, ...] = ()
        """What the vehicle said since it was asked."""
        self.state = ""
        """Lines that say where the vehicle was, what it did, and its last status texts."""

    def __str__(self) -> str:
        return "\n".join(part for part in (super().__str__(), self.state) if part)


class CommandRefusedError(ClientError):
    """A command was answered with another MAV_RESULT than ACCEPTED."""

    def __init__(self, subject: str, result: int, result_name: str, since: float = 0.0) -> None:
        super().__init__(subject, f"was refused: {result_name}", since)
        self.result, self.result_name = result, result_name


class MissionRefusedError(ClientError):
    """A mission was answered with another MAV_MISSION_RESULT than ACCEPTED."""

    def __init__(self, result: int, result_name: str, since: float = 0.0) -> None:
        super().__init__("the mission", f"was refused: {result_name}", since)
        self.result, self.result_name = result, result_name


class FileRefusedError(ClientError):
    """A file or log was not given; ``number`` is MAVLink FTP's error."""

    def __init__(self, subject: str, number: int, since: float = 0.0) -> None:
        names = {1: "failed", 4: "no such session", 9: "protected", 10: "there is none of this name"}
        super().__init__(subject, f"was refused: {names.get(number, f'error {number}')}", since)
        self.number = number


class ParameterRefusedError(ClientError):
    """A parameter kept another value than the one that it was set to."""

    def __init__(self, name: str, value: float, kept: float) -> None:
        super().__init__(name, f"was not set to {value:g}: it is {kept:g}")
        self.name, self.value, self.kept = name, value, kept


class WaitTimeoutError(ClientError, TimeoutError):
    """Something did not come true in time.

    Args:
        what: was awaited.
        seconds: simulated time that was waited [s].
        last: what was seen last.
    """

    def __init__(self, what: str, seconds: float, last: str = "", since: float = 0.0) -> None:
        seen = f"\n  last seen: {last}" if last else ""
        super().__init__(f"waited {seconds:g} s for", f"{what}{seen}", since)
        self.what, self.seconds, self.last = what, seconds, last


class ImpossibleWaitError(ClientError):
    """What is awaited cannot come true, by what the vehicle says now.

    Args:
        what: was awaited.
        why: it cannot come.
    """

    def __init__(self, what: str, why: str, since: float = 0.0) -> None:
        super().__init__(f"waiting for {what}", f"is in vain: {why}", since)
        self.what, self.why = what, why


class InvariantError(ClientError):
    """Something that had to hold at all times does not."""
