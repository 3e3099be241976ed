# SPDX-License-Identifier: BSD-3-Clause
"""A mission file in a calm, a breeze and a strong wind: the paths flown, and what they cost.

    python examples/mission_wind.py [FILE]         (.plan or .waypoints; default: one that comes with the package)

It draws mission_wind.png and needs matplotlib.
"""

import math
import sys
from pathlib import Path

from sitl import Simulation
from sitl.client import Client
from sitl.missions import library
from sitl.missions.files import load

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

WINDS_M_S = (0.0, 4.0, 7.0)
LIMIT_S = 400.0
FROM_DEG = 60.0


def main() -> None:
    """Fly it in each wind, and draw the paths."""
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else library.find("copter/spline_figure").path
    file = load(path)
    figure, (plan, leans) = plt.subplots(1, 2, figsize=(8, 4), width_ratios=(1, 2), layout="constrained")
    for wind in WINDS_M_S:
        params = {"SIM_WIND_SPD": wind, "SIM_WIND_DIR": FROM_DEG, "SIM_WIND_TURB": 0.2 * wind, "SIM_WIND_T": 1}
        pilot = Client(Simulation("ardupilot_quad", home=(*file.home, 0.0), seed=1, params=params))
        pilot.wait_ready()
        pilot.upload(file.mission)
        pilot.start_mission()
        body, begin = pilot.simulation.v.physics.body, pilot.now
        positions, times, tilts = [], [], []
        while pilot.armed and pilot.now < begin + LIMIT_S:
            pilot.delay(0.2)
            roll, pitch, _ = pilot.attitude
            positions.append((body.pos.y, body.pos.x))
            times.append(pilot.now - begin)
            tilts.append(math.degrees(math.acos(math.cos(roll) * math.cos(pitch))))
        left = pilot.message("BATTERY_STATUS").battery_remaining
        print(f"{wind:.0f} m/s: {times[-1]:.0f} s, lean {sum(tilts) / len(tilts):.1f} deg on average, battery {left} %")
        plan.plot(*zip(*positions), linewidth=1)
        leans.plot(times, tilts, label=f"{wind:.0f} m/s", linewidth=1)
    plan.set(xlabel="east [m]", ylabel="north [m]", aspect="equal")
    leans.set(xlabel="time since the mission began [s]", ylabel="lean [deg]", title=path.name)
    leans.legend(title=f"wind from {FROM_DEG:.0f} deg", loc="upper right")
    figure.savefig("mission_wind.png", dpi=80)


if __name__ == "__main__":
    main()
