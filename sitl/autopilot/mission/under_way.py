# SPDX-License-Identifier: BSD-3-Clause
"""The command under way, as the record has it; AUTO begins it when ``nav.command_count`` changes."""

from __future__ import annotations

from typing import Any

from ..navigation.state import NONE


def write(nav: Any, kind: int, seq: int) -> None:
    """Command ``kind`` of ``navigation.state`` with number ``seq`` is under way; its other fields start from zero."""
    nav.command_kind, nav.command_seq = kind, seq
    nav.command_count += 1
    nav.completed, nav.since_us = 0, 0
    nav.has_place, nav.delay, nav.turns = 0, 0.0, 0.0


def write_none(nav: Any) -> None:
    """No command is under way."""
    write(nav, NONE, 0)
