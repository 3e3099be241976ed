# SPDX-License-Identifier: BSD-3-Clause
"""A mission file in a calm, a breeze and a strong wind: the ways flown, and what they cost.

    python examples/mission_wind.py [FILE]         (.plan or .waypoints; default: a survey that comes with the package)

It draws mission_wind.png and needs matplotlib.
"""

import sys

from sitl import Simulation
from sitl.client import Client
from sitl.missions import library
from sitl.missions.files import load

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

WINDS_M_S = (0.0, 5.0, 9.0)
LIMIT_S = 400.0
FROM_DEG = 60.0


def main() -> None:
    """Fly it in each wind, and draw the ways."""
    file = load(sys.argv[1] if len(sys.argv) > 1 else library.find("copter/survey").path)
    figure, axes = plt.subplots(figsize=(7, 4.4), layout="constrained")
    for wind in WINDS_M_S:
        params = {"SIM_WIND_SPD": wind, "SIM_WIND_DIR": FROM_DEG, "SIM_WIND_TURB": 0.2 * wind}
        pilot = Client(Simulation("ardupilot_quad", home=(*file.home, 0.0), seed=1, params=params))
        pilot.wait_ready()
        pilot.upload(file.mission)
        pilot.start_mission()
        way, begin, body = [], pilot.now, pilot.simulation.v.physics.body
        while pilot.armed and pilot.now < begin + LIMIT_S:
            pilot.delay(0.2)
            way.append((body.pos.y, body.pos.x))
        left = pilot.message("BATTERY_STATUS").battery_remaining
        print(f"{wind:4.0f} m/s: {pilot.now - begin:.0f} s, battery {left} %")
        axes.plot(*zip(*way), label=f"{wind:.0f} m/s", linewidth=1)
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal", title=f"{file.name} in wind from {FROM_DEG:.0f} deg")
    axes.legend()
    figure.savefig("mission_wind.png", dpi=80)


if __name__ == "__main__":
    main()
