# SPDX-License-Identifier: BSD-3-Clause
"""256 copters in one process: each flies to its position of a sunflower, and one compiled call advances all of them.

    python examples/fleet_flower.py

It draws fleet_flower.png and needs matplotlib.
"""

import math
import time

import numpy as np

from sitl import Fleet, Simulation
from sitl.client import Client, Endpoint

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

COUNT = 256
FLIGHT_S = 12.0
LOCAL_NED, POSITION_ONLY = 1, 0b110111111000
"""Frame, and type mask: velocities, accelerations, yaw and yaw rate are not given."""


class Station:
    """The link of one vehicle of the fleet, for an Endpoint."""

    def __init__(self, fleet: Fleet, index: int) -> None:
        self.fleet, self.index = fleet, index

    def send(self, data: bytes) -> None:
        """Bytes to the vehicle."""
        self.fleet.send(self.index, data)

    def receive(self) -> bytes:
        """Bytes from the vehicle."""
        return self.fleet.receive(self.index)


def main() -> None:
    """One takes off, all begin where it hovers, and each goes its own way."""
    pilot = Client(Simulation("ardupilot_quad", seed=1))
    pilot.wait_ready()
    pilot.take_off(10)
    hover = pilot.simulation.snapshot()

    fleet = Fleet("ardupilot_quad", COUNT)
    for k in range(COUNT):
        fleet.put(k, hover, seed=k)  # the same moment, noise of its own
        turn, radius = k * math.pi * (3 - math.sqrt(5)), 1.6 * math.sqrt(k)
        Endpoint(Station(fleet, k)).send(
            "SET_POSITION_TARGET_LOCAL_NED", target_system=1, coordinate_frame=LOCAL_NED,
            type_mask=POSITION_ONLY, x=radius * math.cos(turn), y=radius * math.sin(turn), z=-10.0,
        )  # fmt: skip
    positions = [fleet.records["physics"]["body"]["pos"].copy()]
    clock = time.process_time()
    while len(positions) <= FLIGHT_S / 0.2:
        fleet.advance(0.2)
        fleet.drop_telemetry()
        positions.append(fleet.records["physics"]["body"]["pos"].copy())
    clock = time.process_time() - clock
    print(f"{COUNT} copters, {FLIGHT_S:.0f} s: {COUNT * FLIGHT_S / clock:.0f} times real time, all together")
    fleet.close()

    paths = np.array(positions)  # step, copter, axis
    figure, axes = plt.subplots(figsize=(5, 5), layout="constrained")
    axes.plot(paths[:, :, 1], paths[:, :, 0], color="0.85", linewidth=0.7, zorder=1)
    axes.scatter(paths[-1, :, 1], paths[-1, :, 0], c=range(COUNT), cmap="viridis", s=14, zorder=2)
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal", title=f"{COUNT} copters after {FLIGHT_S:.0f} s")
    figure.savefig("fleet_flower.png", dpi=80)


if __name__ == "__main__":
    main()
