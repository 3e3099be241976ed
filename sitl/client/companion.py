# SPDX-License-Identifier: BSD-3-Clause
"""Other programs on board of a vehicle in this process, that send it messages while its client lets time pass."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, Self

from .session import Session


class Companion:
    """Sends a message ten times a second, from ``start`` to ``stop``, and may answer messages of the vehicle.

    All that it knows besides its client is in its attributes, so that snapshots of the client have it.
    """

    PERIOD_US = 100_000

    def __init__(self, client: Session) -> None:
        self.client = client
        self._next_us = 0

    def start(self) -> Self:
        """Send from now on, while the client lets time pass."""
        self.client.companions.append(self)
        return self

    def stop(self) -> None:
        """Send no more."""
        self.client.companions.remove(self)

    def step(self, now_us: int) -> None:
        """Send when it is time."""
        if now_us >= self._next_us:
            self._next_us = (now_us // self.PERIOD_US + 1) * self.PERIOD_US
            self.send()

    def send(self) -> None:
        """Send one message."""
        raise NotImplementedError

    def take(self, name: str, fields: Any) -> None:
        """A message of the vehicle has come."""

    def state(self) -> dict[str, Any]:
        """What it knows besides its client: a copy."""
        return deepcopy({name: value for name, value in vars(self).items() if name != "client"})

    def restored(self, state: dict[str, Any], client: Session) -> Companion:
        """This one, or for another client one like it, in that state."""
        found = self if client is self.client else object.__new__(type(self))
        found.client = client
        vars(found).update(deepcopy(state))
        return found
