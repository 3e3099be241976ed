# SPDX-License-Identifier: BSD-3-Clause
"""Parameters by pymavlink: set one, ask for a lean of 15 degrees, plot the answer, and do it again with other values.

    sitl exec --speedup max -- python examples/pymavlink_tuning.py         (CONNECTION: udpin:0.0.0.0:14550)

It draws pymavlink_tuning.png and needs matplotlib.
"""

import math
import sys
import time

try:
    import matplotlib.pyplot as plt
    from pymavlink import mavutil
    from pymavlink.quaternion import Quaternion
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib pymavlink") from None

mavlink = mavutil.mavlink
NAME, VALUES = "ATC_INPUT_TC", (0.1, 0.25, 0.5)
"""How soft the answer to a command is: its time constant [s]."""
LEAN_DEG, BEFORE_S, STEP_S, AFTER_S = 15.0, 3.0, 1.5, 1.5
RATE_HZ = 50


def wait(link, kind: str, condition=lambda message: True, timeout_s: float = 30.0):
    """The first message of this kind for which the condition holds; SystemExit when none comes in time."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        message = link.recv_match(type=kind, blocking=True, timeout=1.0)
        if message is not None and message.get_srcSystem() != link.target_system:
            continue  # of another vehicle or ground station, or the vehicle is not known yet
        if message is not None and condition(message):
            return message
    raise SystemExit(f"gave up after {timeout_s:.0f} s: {kind}")


def command(link, number: int, *params: float) -> None:
    """A command that must be accepted."""
    padded = [*params, *(0.0,) * (7 - len(params))]
    link.mav.command_long_send(link.target_system, link.target_component, number, 0, *padded)
    if wait(link, "COMMAND_ACK", lambda m: m.command == number).result != mavlink.MAV_RESULT_ACCEPTED:
        raise SystemExit(f"command {number} is refused")


def lean(link, roll_deg: float, seconds: float) -> list[tuple[float, float]]:
    """Hold an attitude at level height; times [s of the vehicle] and rolls [deg]."""
    q = Quaternion([math.radians(roll_deg), 0.0, 0.0]).q
    rolls: list[tuple[float, float]] = []
    while not rolls or rolls[-1][0] < rolls[0][0] + seconds:
        if len(rolls) % 5 == 0:
            link.mav.set_attitude_target_send(0, link.target_system, link.target_component, 7, q, 0, 0, 0, 0.5)
        m = wait(link, "ATTITUDE")
        rolls.append((m.time_boot_ms * 1e-3, math.degrees(m.roll)))
    return rolls


def main() -> None:
    """Take off, and try each value."""
    link = mavutil.mavlink_connection(sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550")
    wait(link, "HEARTBEAT")
    link.set_mode("GUIDED")
    wait(link, "HEARTBEAT", lambda m: link.flightmode == "GUIDED")
    checked = mavlink.MAV_SYS_STATUS_PREARM_CHECK
    wait(link, "SYS_STATUS", lambda m: m.onboard_control_sensors_health & checked, 120.0)
    command(link, mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, 1e6 / RATE_HZ)
    command(link, mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    command(link, mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 15)
    wait(link, "GLOBAL_POSITION_INT", lambda m: m.relative_alt > 14_500, 60.0)

    figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
    for value in VALUES:
        link.param_set_send(NAME, value)
        wait(link, "PARAM_VALUE", lambda m: m.param_id == NAME)
        lean(link, 0.0, BEFORE_S)
        rolls = lean(link, LEAN_DEG, STEP_S) + lean(link, 0.0, AFTER_S)
        begin = rolls[0][0]
        axes.plot([t - begin for t, _ in rolls], [roll for _, roll in rolls], label=f"{NAME} {value:g}")
        risen = next(t - begin for t, roll in rolls if roll > 0.9 * LEAN_DEG)
        print(f"{NAME} {value:g}: 90 % of {LEAN_DEG:g} degrees after {risen:.2f} s", flush=True)
    asked = [0, 0, STEP_S, STEP_S, STEP_S + AFTER_S], [0, LEAN_DEG, LEAN_DEG, 0, 0]
    axes.plot(*asked, "--", color="0.6", label="asked for")
    axes.set(xlabel="time [s]", ylabel="roll [deg]")
    axes.legend()
    figure.savefig("pymavlink_tuning.png", dpi=80)
    command(link, mavlink.MAV_CMD_NAV_LAND)
    wait(link, "HEARTBEAT", lambda m: not m.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 60.0)
    print("landed and disarmed")


if __name__ == "__main__":
    main()
