# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of runs: all that came to a vehicle from outside, with its simulated time; and flying them again."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .entries import RecordingError
    from .recorder import Recorder
    from .recording import Recording, read
    from .replay import Replay

__all__ = ["Recorder", "Recording", "RecordingError", "Replay", "read"]

_LAZY = {
    "Recorder": "recorder",
    "Recording": "recording",
    "RecordingError": "entries",
    "Replay": "replay",
    "read": "recording",
}
"""Name -> the module that has it, loaded when it is first used."""


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    return getattr(import_module(f"{__name__}.{_LAZY[name]}"), name)
