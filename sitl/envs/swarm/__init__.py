# SPDX-License-Identifier: BSD-3-Clause
"""Environments of several agents, each an autopilot, in one world: PettingZoo's interfaces (docs/swarm.md)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .parallel import SwarmEnv

__all__ = ["env", "parallel_env"]


def parallel_env(task: Any = "formation", **options: Any) -> SwarmEnv:
    """A swarm by PettingZoo's parallel interface: see ``parallel.SwarmEnv``, whose arguments it takes."""
    from .parallel import SwarmEnv

    return SwarmEnv(task, **options)


def env(task: Any = "formation", **options: Any) -> Any:
    """The same by PettingZoo's AEC interface: agents act one after another, and time goes by after the last one."""
    from pettingzoo.utils import parallel_to_aec

    return parallel_to_aec(parallel_env(task, **options))
