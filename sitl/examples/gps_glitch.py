# SPDX-License-Identifier: BSD-3-Clause
"""A GPS receiver lies by 3, 6 and 20 m: what the autopilot believes, and where the copter really goes.

A small error passes the checks of the Kalman filter and moves the copter. A large one is refused for ten seconds;
then the filter begins anew at the wrong position, and the copter stays.

    python examples/gps_glitch.py

It draws gps_glitch.png and needs matplotlib.
"""

from sitl import Simulation
from sitl.client import Client

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

ERRORS_M = (3, 6, 20)
BEGIN_S, END_S, WATCHED_S = 5, 30, 50


def fly(vehicle: Client, metres: float) -> tuple[list[float], list[float], list[float]]:
    """Hover through the fault; times [s], norths by the estimate and by the physics [m]."""
    begin = vehicle.now
    vehicle.simulation.fail(f"gps/wrong={metres}@{BEGIN_S}..{END_S}")
    times, believed, true = [], [], []
    while vehicle.now < begin + WATCHED_S:
        vehicle.delay(0.1)
        times.append(vehicle.now - begin)
        believed.append(vehicle.position.north)
        true.append(vehicle.simulation.v.physics.body.pos.x)
    for text in vehicle.texts:
        if text.time > begin:
            print(f"  {text.time - begin:5.1f} s  {text.text}")
    return times, believed, true


def main() -> None:
    """Hover in LOITER through each fault, and draw estimate and truth."""
    vehicle = Client(Simulation("ardupilot_quad", seed=1))
    vehicle.wait_ready()
    vehicle.take_off(15)
    vehicle.rc(roll=1500, pitch=1500, throttle=1500, yaw=1500)
    vehicle.set_mode("LOITER")
    vehicle.delay(5)

    figure, panels = plt.subplots(1, 2, figsize=(8, 3.4), sharey=True, layout="constrained")
    for metres in ERRORS_M:
        print(f"fixes {metres} m too far north")
        with vehicle.fork():
            times, believed, true = fly(vehicle, metres)
        print(f"  the copter really moves by {max(true) - min(true):.1f} m")
        panels[0].plot(times, believed, label=f"{metres} m")
        panels[1].plot(times, true)
    for axes, title in zip(panels, ("what the autopilot believes", "where the copter really is")):
        axes.axvspan(BEGIN_S, END_S, color="0.92")
        axes.set(xlabel="time [s]", title=title)
    panels[0].set_ylabel("north of home [m]")
    panels[1].legend(*panels[0].get_legend_handles_labels(), title="fixes too far north by", loc="upper right")
    figure.savefig("gps_glitch.png", dpi=80)


if __name__ == "__main__":
    main()
