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


class Pilot:
    """A connection to the vehicle."""

    def __init__(self, url: str) -> None:
        self.link = mavutil.mavlink_connection(url)
        if self.link.wait_heartbeat(timeout=30) is None:
            raise SystemExit(f"no heartbeat on {url}")
        self.target = self.link.target_system, self.link.target_component

    def wait(self, kind: str, condition, timeout_s: float = 30.0):
        """The first message of this kind for which the condition holds."""
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            message = self.link.recv_match(type=kind, blocking=True, timeout=1.0)
            if message is not None and condition(message):
                return message
        raise SystemExit(f"gave up after {timeout_s:.0f} s: {kind}")

    def command(self, number: int, *params: float) -> None:
        """A command that must be accepted."""
        self.link.mav.command_long_send(*self.target, number, 0, *params, *(0.0,) * (7 - len(params)))
        if self.wait("COMMAND_ACK", lambda m: m.command == number).result != mavlink.MAV_RESULT_ACCEPTED:
            raise SystemExit(f"command {number} is refused")

    def set(self, name: str, value: float) -> None:
        """Set a parameter, and see that the vehicle has it."""
        self.link.param_set_send(name, value)
        self.wait("PARAM_VALUE", lambda m: m.param_id == name and math.isclose(m.param_value, value, rel_tol=1e-5))
        print(f"{name} {value:g}", flush=True)

    def lean(self, roll_deg: float, seconds: float) -> list[tuple[float, float]]:
        """Hold an attitude at level height; times [s of the vehicle] and rolls [deg]."""
        q = Quaternion([math.radians(roll_deg), 0.0, 0.0]).q
        rolls: list[tuple[float, float]] = []
        while not rolls or rolls[-1][0] < rolls[0][0] + seconds:
            if len(rolls) % 5 == 0:
                self.link.mav.set_attitude_target_send(0, *self.target, 0b00000111, q, 0, 0, 0, 0.5)
            m = self.wait("ATTITUDE", lambda m: True)
            rolls.append((m.time_boot_ms * 1e-3, math.degrees(m.roll)))
        return rolls


def main() -> None:
    """Take off, and try each value."""
    pilot = Pilot(sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550")
    pilot.link.set_mode("GUIDED")
    pilot.wait("HEARTBEAT", lambda m: pilot.link.flightmode == "GUIDED")
    checked = mavlink.MAV_SYS_STATUS_PREARM_CHECK
    pilot.wait("SYS_STATUS", lambda m: m.onboard_control_sensors_health & checked, 120.0)
    pilot.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, mavlink.MAVLINK_MSG_ID_ATTITUDE, 1e6 / RATE_HZ)
    pilot.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    pilot.command(mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 15)
    pilot.wait("GLOBAL_POSITION_INT", lambda m: m.relative_alt > 14_500, 60.0)

    figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
    for value in VALUES:
        pilot.set(NAME, value)
        pilot.lean(0.0, BEFORE_S)
        rolls = pilot.lean(LEAN_DEG, STEP_S) + pilot.lean(0.0, AFTER_S)
        begin = rolls[0][0]
        axes.plot([t - begin for t, _ in rolls], [roll for _, roll in rolls], label=f"{NAME} {value:g}")
        risen = next(t - begin for t, roll in rolls if roll > 0.9 * LEAN_DEG)
        print(f"  90 % of {LEAN_DEG:g} degrees after {risen:.2f} s", flush=True)
    asked = [0, 0, STEP_S, STEP_S, STEP_S + AFTER_S], [0, LEAN_DEG, LEAN_DEG, 0, 0]
    axes.plot(*asked, "--", color="0.6", label="asked for")
    axes.set(xlabel="time [s]", ylabel="roll [deg]")
    axes.legend()
    figure.savefig("pymavlink_tuning.png", dpi=80)
    pilot.command(mavlink.MAV_CMD_NAV_LAND)
    pilot.wait("HEARTBEAT", lambda m: not m.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED, 60.0)
    print("landed and disarmed")


if __name__ == "__main__":
    main()
