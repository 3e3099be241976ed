# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_faults.py``: flies what the pictures of faults.md show, and draws them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from sitl import Simulation
from sitl.client import Client

plt.rcParams.update({"font.size": 13, "legend.fontsize": 12, "axes.titlesize": 13})
IMAGES = Path(__file__).parent / "images"
Row = tuple[float, ...]
FAULT = "0.85"
"""Colour of the time in which something fails."""


def hovering(**params: float) -> Client:
    """A copter in LOITER at 10 m, sticks centred."""
    pilot = Client(Simulation("ardupilot_quad", params=params))
    pilot.wait_ready()
    pilot.take_off(10)
    pilot.rc(roll=1500, pitch=1500, throttle=1500, yaw=1500)
    pilot.set_mode("LOITER")
    pilot.delay(5)
    return pilot


def flown(pilot: Client, seconds: float, faults: Sequence[str], row: Callable[[Client], Row]) -> list[Row]:
    """Rows (time [s], ...), ten a second, of a flight with faults."""
    start, rows = pilot.now, []
    for fault in faults:
        pilot.simulation.fail(fault)
    while pilot.now - start < seconds:
        pilot.delay(0.1)
        rows.append((pilot.now - start, *row(pilot)))
    return rows


def true(pilot: Client) -> Any:
    """The body."""
    return pilot.simulation.v.physics.body


def draw(name: str, rows: list[Row], labels: Sequence[str], ylabel: str, span: tuple[float, float], title: str) -> None:
    """A picture with a line for each column behind the time."""
    figure, axes = plt.subplots(figsize=(7.2, 3.2))
    axes.axvspan(*span, color=FAULT, lw=0)
    time, *columns = zip(*rows, strict=True)
    for column, label in zip(columns, labels, strict=True):
        axes.plot(time, column, label=label, lw=1.8)
    axes.set(xlabel="time [s]", ylabel=ylabel)
    axes.set_title(title)
    axes.legend()
    figure.tight_layout()
    figure.savefig(IMAGES / f"fault-{name}.png", dpi=100)
    plt.close(figure)


def copters() -> None:
    """GPS, barometer, wind, battery, motor, radio."""
    north = lambda p: (true(p).pos.x, p.position.north)  # noqa: E731
    height = lambda p: (-true(p).pos.z, p.altitude)  # noqa: E731
    both = ("really", "by its estimate")
    rows = flown(hovering(), 40, ["gps/wrong=22@5..25"], north)
    draw("gps", rows, both, "north [m]", (5, 25), "gps/wrong=22@5..25, LOITER")
    rows = flown(hovering(), 40, ["baro/slow=0.5@5..15"], height)
    draw("baro", rows, both, "height [m]", (5, 15), "baro/slow=0.5@5..15, LOITER")
    pilot = hovering(SIM_WIND_T=0)
    pilot.simulation.fail("wind=12@5")
    pilot.rc(throttle=1900)
    rows = flown(pilot, 30, (), lambda p: (-true(p).pos.z, p.simulation.v.physics.wind.steady.x))
    draw("wind", rows, ("height [m]", "wind [m/s]"), "", (5, 30), "SIM_WIND_T=0, wind=12@5, climbing")
    rows = flown(hovering(BATT_FS_LOW_ACT=2), 45, ["battery=10@5"],
                 lambda p: (-true(p).pos.z, p.simulation.v.autopilot.battery.voltage))  # fmt: skip
    draw("battery", rows, ("height [m]", "voltage [V]"), "", (5, 45), "battery=10@5, BATT_FS_LOW_ACT=2: RTL")
    rows = flown(hovering(), 12, ["motor:1=0.3@3"], lambda p: (-true(p).pos.z, 0.1 * p.message("VFR_HUD").throttle))
    draw("motor", rows, ("height [m]", "throttle [%/10]"), "", (3, 12), "motor:1=0.3@3, LOITER")
    pilot = hovering(RC_OVERRIDE_TIME=1.0)
    pilot.release_rc()
    rows = flown(pilot, 40, ["rc@1"], lambda p: (-true(p).pos.z,))
    draw("rc", rows, ("height [m]",), "", (1, 40), "rc@1: RTL")


def rover() -> None:
    """Paths with the same sticks."""
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    for fault in ("", "motor:3=0.4@3", "servo:1@3", "servo:1/stuck@3"):
        pilot = Client(Simulation("ardupilot_rover"))
        pilot.wait_ready()
        pilot.set_mode("MANUAL")
        pilot.arm()
        pilot.rc({1: 1600, 3: 1650})
        if fault:
            pilot.simulation.fail(fault)
        places = [(true(pilot).pos.y, true(pilot).pos.x)]
        for step in range(100):
            if step == 45:
                pilot.rc({1: 1400, 3: 1650})
            pilot.delay(0.1)
            places.append((true(pilot).pos.y, true(pilot).pos.x))
        axes.plot(*zip(*places, strict=True), label=fault or "without faults", lw=1.8)
    axes.set(aspect="equal", xlabel="east [m]", ylabel="north [m]")
    axes.set_title("MANUAL, the same sticks for 10 s")
    axes.legend()
    figure.tight_layout()
    figure.savefig(IMAGES / "fault-rover.png", dpi=100)
    plt.close(figure)


def main() -> None:
    """Write docs/images/fault-*.png."""
    copters()
    rover()


if __name__ == "__main__":
    main()
