# SPDX-License-Identifier: BSD-3-Clause
"""The errors' common base, those that other packages derive theirs from, and what they say.

The command line prints the text of any ``SitlError``, without a traceback.
"""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches

__all__ = [
    "LinkLostError", "MissingExtra", "NotASimulatorError", "NotReadyError", "OptionError", "SitlError", "VehicleError",
]  # fmt: skip


class SitlError(Exception):
    """The base of every error of this package; the message says what is wrong, and what is allowed."""

    __str__ = Exception.__str__  # those that are KeyErrors, too, would show their text in quotes


class OptionError(SitlError, ValueError):
    """An option of the simulation that cannot be taken."""


class VehicleError(SitlError):
    """A vehicle that cannot be reached, or does not do what it must; the message says which, and what it told."""


class LinkLostError(VehicleError, ConnectionError):
    """No vehicle at the other end of a MAVLink connection, or no longer; the message names the connection."""


class NotReadyError(VehicleError, RuntimeError):
    """A vehicle that does not become ready for an episode; the message says which texts it sent."""


class NotASimulatorError(NotReadyError):
    """A vehicle that is not reset, because nothing proves that it is a simulator; nothing was sent that changes it."""


class MissingExtra(SitlError, RuntimeError):
    """An optional dependency is not installed; the message says which extra brings it."""


def did_you_mean(name: str, known: Iterable[str], least: float = 0.6) -> str:
    """The end of a message about a name that is not known: "; did you mean ...?" with the first that begins
    with it, else the nearest, or nothing. ``least``: how alike they must be, 0 .. 1."""
    names = list(known)
    near = [longer for longer in names if len(name) > 3 and longer.startswith(name)] or get_close_matches(
        name, names, 1, least
    )
    return f"; did you mean {near[0]!r}?" if near else ""
