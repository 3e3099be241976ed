# SPDX-License-Identifier: BSD-3-Clause
"""What looks down: optical flow (SIM_FLOW_*) and a range-finder (RNGFND1_*), of vehicles whose airframe has none.

A flow sensor shows how fast the ground goes round about its x and y axes: body rates, and velocity by distance along
its own axis: omega = rates + (-v_y, v_x) / distance. Source: Honegger, Meier, Tanskanen and Pollefeys, "An open source
and open hardware embedded metric optical flow CMOS camera for indoor and outdoor applications", ICRA 2013.
"""

from __future__ import annotations

import math

from ....core.algebra import rotate, rotate_inverse
from ....core.border import Sensors
from ....core.kernels import law
from ....core.rng import Rng, uniform
from ....core.vectors import Vec2, Vec3
from ....worlds.planar import to_floor
from ....worlds.raycast import to_solid
from ..records import FLOW_RING, Body, Downward, Obstacles, Physics
from ..tick import Clock

LENS = 0.1
"""Height of the lens over the ground that the vehicle stands on [m]."""
QUALITY = 51
"""Of a sample in which the ground is seen: ArduPilot's simulator's."""
RANGE_TICKS = 20
"""From one reading of the range-finder to the next: 20 Hz."""


@law
def distance(body: Body, o: Obstacles, ground_d: float) -> float:
    """How far it is down the body's axis to the ground at ``ground_d`` (down [m]) or to a solid near the vehicle [m];
    inf: it looks up."""
    down = rotate(body.q, Vec3(0.0, 0.0, 1.0))
    found = to_floor(-(body.pos.z - ground_d), down.z)
    if o.present:
        for k in range(o.count):
            found = min(found, to_solid(o.rows, k, body.pos, down))
    return found


@law
def flow_of(body: Body, away: float) -> Vec2:
    """Rates of the ground about x and y [rad/s] that is ``away`` [m] from the lens."""
    vel = rotate_inverse(body.q, body.vel)
    return Vec2(body.rates.x - vel.y / away, body.rates.y + vel.x / away)


@law
def take(down: Downward, body: Body, away: float, rng: Rng, tick: int) -> None:
    """Take a sample and send it on its way; none while as many as can be are on theirs."""
    if down.flow_head - down.flow_tail >= FLOW_RING:
        return
    n = down.flow_head % FLOW_RING
    rate = flow_of(body, max(away, LENS))
    noise = Vec2(2.0 * uniform(rng) - 1.0, 2.0 * uniform(rng) - 1.0)
    down.flow[n, 0] = rate.x + down.flow_noise * noise.x
    down.flow[n, 1] = rate.y + down.flow_noise * noise.y
    down.flow[n, 2] = body.rates.x
    down.flow[n, 3] = body.rates.y
    down.flow_due[n] = tick + down.flow_delay if away < math.inf else -1
    down.flow_head += 1


@law
def deliver(down: Downward, sensors: Sensors, tick: int) -> None:
    """Hand the oldest sample to the reader when its time has come; one without ground has no quality."""
    if down.flow_tail == down.flow_head:
        return
    n = down.flow_tail % FLOW_RING
    if down.flow_due[n] > tick:
        return
    down.flow_tail += 1
    sensors.flow_count += 1
    sensors.flow_rate = Vec2(down.flow[n, 0], down.flow[n, 1])
    sensors.flow_body = Vec2(down.flow[n, 2], down.flow[n, 3])
    sensors.flow_quality = QUALITY if down.flow_due[n] >= 0 else 0


@law
def sample(p: Physics, sensors: Sensors, rng: Rng, now: Clock) -> None:
    """Measure as it falls due."""
    down = p.downward
    if down.ranges and now.tick % RANGE_TICKS == 0:
        away = distance(p.body, p.obstacles, down.ground_d)
        sensors.rangefinder_range[0] = max(away, down.range_min) if away <= down.range_max else math.inf
        sensors.rangefinder_count += 1
    if down.flow_period > 0:
        if now.tick % down.flow_period == 0:
            take(down, p.body, distance(p.body, p.obstacles, down.ground_d), rng, now.tick)
        deliver(down, sensors, now.tick)
    else:
        down.flow_tail = down.flow_head
