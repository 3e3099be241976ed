# SPDX-License-Identifier: BSD-3-Clause
"""Clients of the vehicles of a swarm in this process."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .client import Client
from .connection import InProcess

if TYPE_CHECKING:
    from ..swarm import Swarm


def clients_of(swarm: Swarm, **options: Any) -> list[Client]:
    """A client for each vehicle. Whichever of them waits, time goes by for all.

    ``snapshot`` and ``restore`` of such a client would be of its vehicle alone: use those of the swarm.

    Args:
        swarm: of the vehicles.
        options: as of ``Client``: rates, heartbeat.
    """
    return [
        Client(InProcess(vehicle, advance=swarm.advance_to), name=f"vehicle {k}", **options)
        for k, vehicle in enumerate(swarm.vehicles)
    ]
