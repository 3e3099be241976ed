# SPDX-License-Identifier: BSD-3-Clause
"""A controller in lockstep with the vehicle: set-points go in and telemetry comes out as MAVLink bytes, in one process.

No socket, no thread, no wall clock: the vehicle's time moves only in ``advance``. Every run gives the same numbers.

    python examples/lockstep_client.py
"""

import math

from sitl.bridge.client import Client
from sitl.simulation import Simulation

GUIDED = 4
DO_SET_MODE, TAKEOFF, ARM = 176, 22, 400
LOCAL_NED = 1
VELOCITY_AND_ACCELERATION = 0b110000000111

ALTITUDE_M = 10.0
RADIUS_M = 10.0
SPEED_M_S = 4.0
STEP_S = 0.1


Place = tuple[float, float, float]


def take_off() -> tuple[Simulation, Client]:
    """A copter hovering over its home, and its client."""
    simulation = Simulation("erle_copter", seed=1)
    client = Client()
    simulation.bridge.add_link(client.link)
    simulation.advance(45.0)  # from power-on to a position estimate
    client.command(DO_SET_MODE, 1, GUIDED)
    client.command(ARM, 1)
    client.command(TAKEOFF, 0, 0, 0, 0, 0, 0, ALTITUDE_M)
    client.set_interval("LOCAL_POSITION_NED", 1.0 / STEP_S)
    simulation.advance(12.0)
    return simulation, client


def position(client: Client) -> Place:
    """Latest position that the vehicle has told: north, east, down [m]."""
    last = [m.fields for m in client.receive() if m.name == "LOCAL_POSITION_NED"][-1]
    return last.x, last.y, last.z


def circle(simulation: Simulation, client: Client, here: Place, seconds: float) -> list[float]:
    """Fly round the origin by velocities and accelerations; distances from the circle [m], one a step."""
    errors = []
    for _ in range(round(seconds / STEP_S)):
        north, east, down = here
        radius = max(math.hypot(north, east), 1e-3)
        outward = (north / radius, east / radius)
        correction = 0.8 * (RADIUS_M - radius)
        inward = -SPEED_M_S * SPEED_M_S / RADIUS_M
        client.send(
            "SET_POSITION_TARGET_LOCAL_NED",
            target_system=1,
            target_component=1,
            coordinate_frame=LOCAL_NED,
            type_mask=VELOCITY_AND_ACCELERATION,
            vx=correction * outward[0] - SPEED_M_S * outward[1],
            vy=correction * outward[1] + SPEED_M_S * outward[0],
            vz=0.8 * (-ALTITUDE_M - down),
            afx=inward * outward[0],
            afy=inward * outward[1],
        )
        simulation.advance(STEP_S)
        here = position(client)
        errors.append(RADIUS_M - radius)
    return errors


def main() -> None:
    """Fly the circle twice from the same moment."""
    simulation, client = take_off()
    start, hover = position(client), simulation.snapshot()
    flights = []
    for number in (1, 2):
        errors = circle(simulation, client, start, 40.0)
        late = errors[len(errors) // 2 :]
        rms = math.sqrt(sum(e * e for e in late) / len(late))
        print(f"flight {number}: {rms:.3f} m rms from the circle in the second half, {late[-1]:.9f} m at the end")
        flights.append(errors)
        simulation.restore(hover)  # back to the hover, in microseconds
    print("the same numbers" if flights[0] == flights[1] else "other numbers")


if __name__ == "__main__":
    main()
