# SPDX-License-Identifier: BSD-3-Clause
"""Time of a call of our elementary functions beside the C library's, compiled into the same loop.

    python -m benchmarks.elementary_speed      # nanoseconds of each, and their ratio; below 1: ours is faster

Each result is part of the next argument, as in a flight, so that calls do not overlap (latency); in a second pair of
columns they may (throughput). The best of several runs, both in turn.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from sitl.core import elementary
from sitl.core.compile import make_jitable
from sitl.core.numba_tuning import COMMON

_CALLS = 2_000
_RUNS = 400
_SPANS = {
    "sin": (-3.2, 3.2), "cos": (-3.2, 3.2), "tan": (-1.5, 1.5), "asin": (-1.0, 1.0), "acos": (-1.0, 1.0),
    "atan": (-5.0, 5.0), "exp": (-5.0, 5.0), "expm1": (-2.0, 2.0), "tanh": (-3.0, 3.0), "log": (0.01, 50.0),
    "log1p": (-0.5, 5.0), "sincos": (-3.2, 3.2), "atan2": (-5.0, 5.0), "hypot": (-5.0, 5.0), "pow": (0.1, 5.0),
}  # fmt: skip
"""Function -> arguments."""
_OF_TWO = ("atan2", "hypot", "pow")


def _c_sincos(x: float) -> tuple[float, float]:
    return math.sin(x), math.cos(x)


def _loop(function: Callable[..., Any], name: str, feeds: bool) -> Callable[..., float]:
    """``loop(x, y)`` calls the function for each argument, compiled."""
    import numba

    share = 1e-9
    if name == "sincos":

        def loop(x: Any, y: Any) -> float:
            total, last = 0.0, 0.0
            for k in range(len(x)):
                sine, cosine = function(x[k] + share * last if feeds else x[k])
                last = sine + cosine
                total += last
            return total

    elif name in _OF_TWO:

        def loop(x: Any, y: Any) -> float:
            total, last = 0.0, 0.0
            for k in range(len(x)):
                last = function(x[k] + share * last if feeds else x[k], y[k])
                total += last
            return total

    else:

        def loop(x: Any, y: Any) -> float:
            total, last = 0.0, 0.0
            for k in range(len(x)):
                last = function(x[k] + share * last if feeds else x[k])
                total += last
            return total

    compiled: Callable[..., float] = numba.njit(**COMMON)(loop)
    return compiled


def _times(loops: list[Callable[..., float]], x: Any, y: Any) -> list[float]:
    """Nanoseconds a call of each, the best of several runs in turn."""
    best = [math.inf] * len(loops)
    for loop in loops:
        loop(x, y)
    for _ in range(_RUNS):
        for k, loop in enumerate(loops):
            start = time.perf_counter()
            loop(x, y)
            best[k] = min(best[k], time.perf_counter() - start)
    return [1e9 * seconds / len(x) for seconds in best]


def main() -> None:
    """Print the table."""
    import numba

    make_jitable()
    theirs_sincos = numba.njit(**COMMON)(_c_sincos)
    random = np.random.default_rng(1)
    print("function  latency: ours, C, ratio     throughput: ours, C, ratio   [ns]")
    for name, (low, high) in _SPANS.items():
        x, y = random.uniform(low, high, _CALLS), random.uniform(low, high, _CALLS)
        ours = getattr(elementary, name)
        theirs = theirs_sincos if name == "sincos" else getattr(math, name)
        loops = [_loop(f, name, feeds) for feeds in (True, False) for f in (ours, theirs)]
        a, b, c, d = _times(loops, x, y)
        print(f"{name:8} {a:8.1f} {b:8.1f} {a / b:6.2f}       {c:8.1f} {d:8.1f} {c / d:6.2f}")


if __name__ == "__main__":
    main()
