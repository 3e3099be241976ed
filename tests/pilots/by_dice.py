# SPDX-License-Identifier: BSD-3-Clause
"""A test pilot who does random things, and remembers them."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

from sitl.simulation import Core
from tests.pilots.witness import Witness


class ByDice(Witness):
    """Acts by dice; mixed into a test pilot of some vehicle."""

    def __init__(self, core: Core, frame: str, seed: int) -> None:
        super().__init__(core, frame, seed=seed)
        self.dice = random.Random(seed)
        self.log: list[str] = []

    def do_one_of(self, deeds: Sequence[Callable[[], None]]) -> None:
        """One of these, noted."""
        deed = self.dice.choice(deeds)
        self.log.append(f"{self.now:.1f} {deed.__name__}")
        deed()

    def story(self) -> str:
        """What was done last."""
        return f"at {self.now:.1f} s in mode {self.mode}: {self.log[-12:]} {self.texts[-4:]} {self.track[-1]}"
