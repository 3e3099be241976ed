# SPDX-License-Identifier: BSD-3-Clause
"""A controller in lockstep with the vehicle: set-points go in and telemetry comes out as MAVLink bytes, in one process.

No socket, no thread, no wall clock: the vehicle's time moves only in calls that wait. Every run gives the same numbers.

    python examples/lockstep_client.py
"""

import math

from sitl import Simulation
from sitl.client import Client

VELOCITY_AND_ACCELERATION = 0b110000000111
"""Type mask: positions, yaw and yaw rate are ignored."""
ALTITUDE_M = 10.0
RADIUS_M = 10.0
SPEED_M_S = 4.0
STEP_S = 0.1


def circle(vehicle: Client, seconds: float) -> list[float]:
    """Fly round the origin by velocities and accelerations; distances from the circle [m], one a step."""
    errors = []
    with vehicle.messages("LOCAL_POSITION_NED", rate_hz=1.0 / STEP_S) as positions:
        vehicle.delay(STEP_S)
        for _ in range(round(seconds / STEP_S)):
            here = positions[-1]
            radius = max(math.hypot(here.x, here.y), 1e-3)
            outward = (here.x / radius, here.y / radius)
            correction = 0.8 * (RADIUS_M - radius)
            inward = -SPEED_M_S * SPEED_M_S / RADIUS_M
            vehicle.send(
                "SET_POSITION_TARGET_LOCAL_NED",
                coordinate_frame="MAV_FRAME_LOCAL_NED",
                type_mask=VELOCITY_AND_ACCELERATION,
                vx=correction * outward[0] - SPEED_M_S * outward[1],
                vy=correction * outward[1] + SPEED_M_S * outward[0],
                vz=0.8 * (-ALTITUDE_M - here.z),
                afx=inward * outward[0],
                afy=inward * outward[1],
            )
            vehicle.delay(STEP_S)
            errors.append(RADIUS_M - radius)
    return errors


def main() -> None:
    """Fly the circle twice from the same moment."""
    vehicle = Client(Simulation("erle_copter", seed=1))
    vehicle.wait_ready()
    vehicle.take_off(ALTITUDE_M)
    hover = vehicle.snapshot()
    flights = []
    for number in (1, 2):
        errors = circle(vehicle, 40.0)
        late = errors[len(errors) // 2 :]
        rms = math.sqrt(sum(e * e for e in late) / len(late))
        print(f"flight {number}: {rms:.3f} m rms from the circle in the second half, {late[-1]:.9f} m at the end")
        flights.append(errors)
        vehicle.restore(hover)  # back to the hover, in microseconds
    print("the same numbers" if flights[0] == flights[1] else "other numbers")


if __name__ == "__main__":
    main()
