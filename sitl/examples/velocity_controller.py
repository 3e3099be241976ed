# SPDX-License-Identifier: BSD-3-Clause
"""A control loop in plain Python, 10 times a second in lockstep: two controllers fly the same figure of eight.

Each step reads telemetry and sends a velocity, as a node of ROS would, without ROS. Time stands still while Python
computes, so the loop never misses its rate, and each run gives the same numbers. The second controller adds the
velocity of the reference (feed-forward) to the correction.

    python examples/velocity_controller.py

It draws velocity_controller.png and needs matplotlib.
"""

import math

from sitl import Simulation
from sitl.client import Client

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

STEP_S = 0.1
ROUND_S = 40.0
LENGTH_M, WIDTH_M = 16.0, 8.0
GAIN = 0.8
"""Velocity for each metre of error [1/s]."""


def reference(t: float) -> tuple[float, float, float, float]:
    """Where to be: north, east [m], and how fast: north, east [m/s]."""
    w = math.tau / ROUND_S
    north, east = LENGTH_M * math.sin(w * t), WIDTH_M * math.sin(2 * w * t)
    return north, east, LENGTH_M * w * math.cos(w * t), 2 * WIDTH_M * w * math.cos(2 * w * t)


def fly(vehicle: Client, feed_forward: float) -> tuple[list[float], list[float], list[float]]:
    """One round and a quarter; norths, easts [m] and errors [m] of each step."""
    begin = vehicle.now
    norths, easts, errors = [], [], []
    while (t := vehicle.now - begin) < 1.25 * ROUND_S:
        north, east, v_north, v_east = reference(t)
        here = vehicle.position
        vehicle.set_velocity(
            feed_forward * v_north + GAIN * (north - here.north),
            feed_forward * v_east + GAIN * (east - here.east),
        )
        vehicle.delay(STEP_S)
        norths.append(here.north)
        easts.append(here.east)
        errors.append(math.hypot(north - here.north, east - here.east))
    return norths, easts, errors


def main() -> None:
    """Fly both from the same moment, and draw them."""
    vehicle = Client(Simulation("ardupilot_quad", seed=1))
    vehicle.wait_ready()
    vehicle.set_rate("LOCAL_POSITION_NED", 1 / STEP_S)
    vehicle.take_off(10)
    figure, (plan, curves) = plt.subplots(1, 2, figsize=(8, 3.8), layout="constrained")
    rounds = [reference(ROUND_S * k / 200) for k in range(201)]
    plan.plot([p[1] for p in rounds], [p[0] for p in rounds], "--", color="0.6", label="reference")
    for name, feed_forward in (("proportional", 0.0), ("with feed-forward", 1.0)):
        with vehicle.fork():
            norths, easts, errors = fly(vehicle, feed_forward)
        late = errors[len(errors) // 5 :]
        rms = math.sqrt(sum(e * e for e in late) / len(late))
        print(f"{name}: {rms:.2f} m rms from the reference")
        plan.plot(easts, norths, label=name)
        curves.plot([STEP_S * k for k in range(len(errors))], errors)
    plan.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    figure.legend(*plan.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    curves.set(xlabel="time [s]", ylabel="distance from the reference [m]")
    figure.savefig("velocity_controller.png", dpi=80)


if __name__ == "__main__":
    main()
