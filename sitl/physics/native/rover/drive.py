# SPDX-License-Identifier: BSD-3-Clause
"""Motors of a rover: throttle to rolling speed of the wheels.

A motor on a voltage runs up to the speed that its throttle stands for as first order (its back-EMF), within what it
can pull; rolling resistance takes its part, so that under load the speed stays a little behind. The battery gives the
force times the speed that the throttle stands for, as of a direct-current motor (its current goes with the force, its
voltage with the throttle); nothing flows back into it.
"""

from __future__ import annotations

from ....core.kernels import law
from ..tick import TICK_S

_PER_S = 1.0 / TICK_S


@law
def commanded(control, scale):
    """Command -1 .. 1 of an actuator control (0 of a NaN)."""
    c = control * scale
    if c > 1.0:
        return 1.0
    if c < -1.0:
        return -1.0
    if c != c:
        return 0.0
    return c


@law
def run(p, k, command):
    """Let motor ``k`` follow its command for a tick; returns the power it takes if it drives the whole vehicle [W]."""
    a, d, speeds = p.airframe, p.derived, p.wheels.speed
    target = command * float(a.speed_max)
    before = float(speeds[k])
    step = float(d.speed_step)
    after = min(max(target + (before - target) * float(d.speed_decay), before - step), before + step)
    pull = (after - before) * _PER_S * target
    loss = float(d.rolling_step)
    speeds[k] = after - min(max(after, -loss), loss)
    return max(pull, 0.0) * float(d.power_by_accel) + abs(command) * float(a.power_full)


@law
def grip_along(p, wanted):
    """Take the vehicle along with its wheels' speed [m/s] as far as the driven tyres hold; returns the acceleration."""
    w = p.wheels
    bound = float(p.derived.drive_grip)
    before = float(w.forward)
    accel = (wanted - before) * _PER_S
    if accel > bound:
        accel = bound
    elif accel < -bound:
        accel = -bound
    else:
        w.forward = wanted
        return accel
    w.forward = before + accel * TICK_S
    return accel
