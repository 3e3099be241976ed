# SPDX-License-Identifier: BSD-3-Clause
"""Options of environments, and the error for options that cannot be used."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from sitl.errors import OptionError, did_you_mean

COMMON = (
    "robot", "world", "task", "observation", "action", "setpoint", "step_time", "start", "randomise", "latency",
    "faults", "info", "clip_actions", "judge", "costs",
)  # fmt: skip
"""Options that every environment takes besides "render_mode", whatever its robot."""


LISTED, LISTED_BESIDE = 100, 30
"""A message lists no more names than these; beside the one that may be meant."""


class EnvOptionError(OptionError):
    """An option of an environment that cannot be used; the message names it, its value and what is allowed."""


class UnknownEnvOption(EnvOptionError, TypeError):
    """An option that no environment or robot of this kind has: in Python's words, an unexpected keyword argument.

    Libraries offer environments arguments of their own (TorchRL: ``frameskip``), and take them back when a
    ``TypeError`` says so.
    """


def unknown_option(option: str, known: Iterable[str]) -> UnknownEnvOption:
    """The error for an option by a name that is not among those known."""
    return UnknownEnvOption(f"{unknown('option', option, known)} (unexpected keyword argument {option!r})")


def unknown(option: str, value: Any, known: Iterable[str]) -> EnvOptionError:
    """The error for a name that is not among those known: with all of them if they are few, and with the nearest."""
    names = list(known)
    hint = did_you_mean(str(value), names)
    few = len(names) <= (LISTED_BESIDE if hint else LISTED)
    listed = f"; it is one of {', '.join(names)}" if few else ""
    return EnvOptionError(f"{option} {value!r} is not known{listed}{hint}")
