# SPDX-License-Identifier: BSD-3-Clause
"""Five futures of one moment of a flight: which mode stops a fast copter in the shortest way.

A block `with vehicle.fork():` flies on from the present moment. After the block the vehicle is back there, bit for
bit, so all five modes meet the same copter in the same gust.

    python examples/what_if.py

It draws what_if.png and needs matplotlib.
"""

from sitl import Simulation
from sitl.client import Client

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

MODES = ("BRAKE", "LOITER", "RTL", "SMART_RTL", "LAND")
SPEED_M_S = 8.0
WATCHED_S = 9.0
STEP_S = 0.1


def main() -> None:
    """Fly fast, then try each mode."""
    wind = {"SIM_WIND_SPD": 4.0, "SIM_WIND_DIR": 200.0, "SIM_WIND_TURB": 1.0}
    vehicle = Client(Simulation("ardupilot_quad", seed=1, params=wind))
    vehicle.wait_ready()
    vehicle.take_off(15)
    vehicle.set_velocity(SPEED_M_S, 0)  # metres a second north, east
    vehicle.delay(8)
    begin, start = vehicle.now, vehicle.position
    print(f"{vehicle.groundspeed:.1f} m/s, {start.north:.1f} m north of home")

    figure, (distances, speeds) = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
    for mode in MODES:
        with vehicle.fork():
            vehicle.rc(throttle=1500)  # the stick in the middle, for LOITER
            vehicle.set_mode(mode)
            times, ahead, speed = [], [], []
            while vehicle.now < begin + WATCHED_S:
                times.append(vehicle.now - begin)
                ahead.append(vehicle.position.north - start.north)
                speed.append(vehicle.groundspeed)
                vehicle.delay(STEP_S)
        print(f"{mode:9s} goes {max(ahead):4.1f} m further")
        distances.plot(times, ahead, label=mode)
        speeds.plot(times, speed)
    distances.set(xlabel="time since the mode changed [s]", ylabel="further north [m]")
    speeds.set(xlabel="time since the mode changed [s]", ylabel="ground speed [m/s]")
    distances.legend()
    figure.savefig("what_if.png", dpi=80)


if __name__ == "__main__":
    main()
