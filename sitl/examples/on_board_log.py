# SPDX-License-Identifier: BSD-3-Clause
"""The autopilot's on-board log: fly, download it by MAVLink, read it by pymavlink, and plot what it has.

    sitl exec --speedup max -- python examples/on_board_log.py             (CONNECTION: udp:127.0.0.1:14550)

It writes on_board_log.bin, draws on_board_log.png and needs matplotlib.
"""

import sys

from pymavlink import DFReader

from sitl.client import Client

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

FILE = "on_board_log.bin"
PLOTS = (
    ("XKF1", ("PN", "PE", "PD"), "position [m]"),
    ("ATT", ("Roll", "Pitch"), "attitude [deg]"),
    ("RCOU", ("C1", "C2", "C3", "C4"), "motors [us]"),
    ("BAT", ("Curr",), "current [A]"),
)
"""Message, fields, and what the axis says."""


def main() -> None:
    """Fly a bit, then read the log."""
    vehicle = Client(sys.argv[1] if len(sys.argv) > 1 else "udp:127.0.0.1:14550")
    vehicle.wait_ready()
    vehicle.take_off(10)
    vehicle.goto(north=15, east=0)
    vehicle.goto(north=15, east=10)
    vehicle.land()
    log = vehicle.logs()[-1]
    with open(FILE, "wb") as file:
        file.write(vehicle.download_log(log))
    print(f"log {log.number}: {log.size / 1e6:.1f} MB")

    reader = DFReader.DFReader_binary(FILE)
    rows: dict[str, list] = {"ATT": [], "XKF1": [], "RCOU": [], "BAT": []}
    while (message := reader.recv_match(type=list(rows))) is not None:
        rows[message.get_type()].append(message)

    def column(kind: str, name: str) -> tuple[list[float], list[float]]:
        """Times [s since boot] and values of a field."""
        return [m.TimeUS * 1e-6 for m in rows[kind]], [getattr(m, name) for m in rows[kind]]

    figure, panels = plt.subplots(2, 2, figsize=(8, 4.6), sharex=True, layout="constrained")
    for axes, (kind, names, label) in zip(panels.flat, PLOTS):
        for name in names:
            axes.plot(*column(kind, name), linewidth=1, label=f"{kind}.{name}")
        axes.set_ylabel(label)
        axes.legend(fontsize="x-small", ncols=len(names), loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
    for axes in panels[1]:
        axes.set_xlabel("time since boot [s]")
    figure.savefig("on_board_log.png", dpi=80)


if __name__ == "__main__":
    main()
