# SPDX-License-Identifier: BSD-3-Clause
"""Faults of a link, as numbers: what happens to frames between a client and the vehicle."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

from ...errors import OptionError

BOTH, TO_VEHICLE, TO_CLIENT = "both", "to-vehicle", "to-client"
DIRECTIONS = (BOTH, TO_VEHICLE, TO_CLIENT)
LONGEST_S = 3600.0
"""No frame is later than by so much."""
SLOWEST = 10.0
"""A link carries at least so much [bytes/s]."""
Span = float | tuple[float, float]


@dataclass(frozen=True)
class LinkFaults:
    """What a link does to each frame, in simulated time; without an argument, nothing.

    The same seed and the same frames at the same simulated times give the same arrivals.

    Args:
        loss: share of the frames that are lost, 0 .. 1.
        delay: time that a frame takes [s]; (low, high): any time between, each as likely.
        jitter: a frame comes by up to so much sooner or later [s], but never before it was sent.
        duplicates: share of the frames that come twice, each with a delay of its own.
        reordering: share of the frames that come up to ``LATE_S`` (0.2 s) later and let those behind them pass; all
            others keep their order, whatever their delays.
        corruption: probability that a bit is turned over.
        bandwidth: what the link carries in each direction [bytes/s], ``SLOWEST`` or more; None: any amount. Frames wait
            for those before them; telemetry is held back while a quarter of a second of frames waits, and what
            would wait longer than 4 s is lost.
        cuts: spans (begin, end) of simulated time since the start [s] in which everything sent is lost.
        direction: "both", "to-vehicle" or "to-client".
        seed: of the random numbers; each client and direction has its own.

    Raises:
        OptionError: a value that cannot be, named.
    """

    loss: float = 0.0
    delay: Span = 0.0
    jitter: float = 0.0
    duplicates: float = 0.0
    reordering: float = 0.0
    corruption: float = 0.0
    bandwidth: float | None = None
    cuts: Sequence[tuple[float, float]] = ()
    direction: str = BOTH
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("loss", "duplicates", "reordering", "corruption"):
            _check(name, getattr(self, name), 0.0, 1.0, "a share from 0 to 1")
        low, high = span = self.delay if isinstance(self.delay, tuple) and len(self.delay) == 2 else (self.delay,) * 2
        for seconds in span:
            _check("delay", seconds, 0.0, LONGEST_S, f"a time from 0 to {LONGEST_S:g} s, or a pair (low, high) of them")
        if low > high:
            raise OptionError(f"link fault delay {self.delay!r}: the first time is longer than the second")
        _check("jitter", self.jitter, 0.0, LONGEST_S, f"a time from 0 to {LONGEST_S:g} s")
        if self.bandwidth is not None:
            _check("bandwidth", self.bandwidth, SLOWEST, math.inf, f"{SLOWEST:g} bytes/s or more, or None")
        for cut in self.cuts:
            _check_cut(cut)
        if self.direction not in DIRECTIONS:
            raise OptionError(f"link fault direction {self.direction!r} is none of {', '.join(DIRECTIONS)}")
        if not isinstance(self.seed, int):
            raise OptionError(f"link fault seed {self.seed!r} is not a whole number")

    @property
    def delays(self) -> tuple[float, float]:
        """Least and greatest ``delay`` [s]."""
        return self.delay if isinstance(self.delay, tuple) else (self.delay, self.delay)

    @property
    def does_nothing(self) -> bool:
        """Whether frames arrive as if there were none."""
        return self == LinkFaults(direction=self.direction, seed=self.seed)

    def acts(self, direction: str) -> bool:
        """Whether frames in this direction ("to-vehicle" or "to-client") are concerned."""
        return self.direction in (BOTH, direction)

    @classmethod
    def of_texts(cls, texts: Mapping[str, Sequence[str]]) -> LinkFaults | None:
        """From the words of a command line, as ``OPTIONS`` says; None when there is no word.

        Args:
            texts: option without "link-" -> its words; all but "cut" count the last one.

        Raises:
            OptionError: a word that is no such value, with its option.
        """
        given = {name: words for name, words in texts.items() if words}
        if not given:
            return None
        values: dict[str, Any] = {}
        for name, words in given.items():
            metavar, _ = OPTIONS[name]
            try:
                if name == "cut":
                    values["cuts"] = tuple(_span(word) for word in words)
                elif name == "delay":
                    values[name] = _span(words[-1]) if ".." in words[-1] else float(words[-1])
                elif name == "direction":
                    values[name] = words[-1]
                else:
                    values[name] = int(words[-1]) if name == "seed" else float(words[-1])
            except ValueError:
                raise OptionError(f"--link-{name} {words[-1]!r} is not {metavar}") from None
        return cls(**values)


OPTIONS = {
    "loss": ("SHARE", "share of frames that are lost, 0 .. 1"),
    "delay": ("SECONDS|LOW..HIGH", "transmission delay of a frame"),
    "jitter": ("SECONDS", "random change of the delay, up to this much more or less"),
    "duplicates": ("SHARE", "share of frames that arrive twice, 0 .. 1"),
    "reordering": ("SHARE", "share of frames that later ones overtake, 0 .. 1"),
    "corruption": ("PROBABILITY", "probability that a bit is inverted"),
    "bandwidth": ("BYTES_A_SECOND", "capacity in each direction"),
    "cut": ("BEGIN..END", "lose everything between these simulated seconds (repeatable)"),
    "direction": ("|".join(DIRECTIONS), "direction of the faults (default both)"),
    "seed": ("NUMBER", "seed of these faults (default 0)"),
}
"""Options of command lines, without "--link-": what stands behind them, and what they mean."""


def _span(text: str) -> tuple[float, float]:
    """``LOW..HIGH``; ValueError when it is something else."""
    low, dots, high = text.partition("..")
    if not dots:
        raise ValueError(text)
    return float(low), float(high)


def _is_number(value: object) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _check(name: str, value: object, low: float, high: float, wanted: str) -> None:
    """OptionError for anything but a finite number from ``low`` to ``high``."""
    if not (_is_number(value) and low <= value <= high and math.isfinite(value)):
        raise OptionError(f"link fault {name} {value!r} is not {wanted}")


def _check_cut(cut: object) -> None:
    if not (isinstance(cut, tuple) and len(cut) == 2 and all(map(_is_number, cut)) and cut[0] < cut[1]):
        raise OptionError(f"link fault cut {cut!r} is not a pair (begin, end) of simulated times [s], begin first")
