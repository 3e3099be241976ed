# SPDX-License-Identifier: BSD-3-Clause
"""Units for tests of device code; run as a program, it runs a kernel in the simulator that numba-cuda has."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sitl.core.elementary import (
    acos,
    asin,
    atan,
    atan2,
    cbrt,
    cos,
    exp,
    expm1,
    hypot,
    log,
    log1p,
    pow,
    sin,
    sincos,
    tan,
    tanh,
)
from sitl.core.vectors import Vec3
from sitl.physics.native.turtlebot.state import TICK_US, Turtlebot
from sitl.physics.native.turtlebot.step import commanded

RECORD = "sitl.physics.native.turtlebot.state.Turtlebot"
WAY = Vec3(0.1, 0.2, 0.3)


def roll(fleet: Sequence[Turtlebot], index: int, ticks: int) -> None:
    """Wheels turn, time goes on; sums of products, a square root, a vector that is a constant."""
    v = fleet[index]
    for _ in range(ticks):
        speeds = commanded(v.airframe, v.command, v.time_us)
        v.command.forward = 0.999 * v.command.forward + 0.01 * speeds.left
        v.command.turn = math.sqrt(v.command.turn * v.command.turn + 0.1 * speeds.right) + (WAY * 2.0).y
        v.time_us += TICK_US


def turn(fleet: Sequence[Turtlebot], index: int, ticks: int) -> None:
    """All elementary functions, of numbers in (0, 1) and beyond."""
    v = fleet[index]
    scale = 1.0
    for _ in range(ticks):
        scale *= 1e3  # far angles, in the end
        x, y = v.command.forward, v.command.turn
        sine, cosine = sincos(x * 1e3)
        circular = sin(x) * cos(y) + tan(x) + asin(x) - acos(x) + atan(y) + atan2(x, y) + sine * cosine
        others = exp(x) + log(x) + pow(x, y) + hypot(x, y) + cbrt(x) + expm1(y) + log1p(x) + tanh(y)
        v.command.turn = circular + others
        v.command.forward = abs(sin(circular * others * scale)) + 1e-9
        v.time_us += TICK_US


def fleet_of(count: int):
    """Turtlebots that differ."""
    from sitl.vehicles.turtlebot import AIRFRAME

    fleet = Turtlebot.fleet(count)
    fleet["airframe"] = AIRFRAME.record()
    for k in range(count):
        fleet["command"]["forward"][k], fleet["command"]["turn"][k] = 0.1 + 0.01 * k, 0.3 - 0.02 * k
    return fleet


def simulate() -> None:
    """``NUMBA_ENABLE_CUDASIM=1``: five vehicles in two blocks of four threads."""
    from numba import cuda

    from benchmarks.gpu_kernel import kernel

    here, there = fleet_of(5), fleet_of(5)
    for k in range(5):
        roll([Turtlebot.of(here, n) for n in range(5)], k, 7)
    cuda.jit(kernel(roll))[2, 4]([Turtlebot.of(there, n) for n in range(5)], 7)
    assert here.tobytes() == there.tobytes() != fleet_of(5).tobytes()
    print("the same")


if __name__ == "__main__":
    simulate()
