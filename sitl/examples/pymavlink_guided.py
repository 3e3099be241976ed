# SPDX-License-Identifier: BSD-3-Clause
"""A plain pymavlink script: arm, take off, fly a square by position set-points in GUIDED, land.

Nothing here knows of the simulator: it is what one would run against a real ArduPilot vehicle.

    python examples/pymavlink_guided.py [CONNECTION]        (default udpin:0.0.0.0:14550)
"""

import math
import sys
import time

from pymavlink import mavutil

ALTITUDE_M = 10.0
SIDE_M = 20.0
NEAR_M = 0.5

mavlink = mavutil.mavlink
POSITION_ONLY = 0b110111111000
"""POSITION_TARGET_TYPEMASK: velocities, accelerations, yaw and yaw rate are not given."""


class Copter:
    """What the flight needs of a vehicle, on a pymavlink connection."""

    def __init__(self, url: str) -> None:
        self.link = mavutil.mavlink_connection(url)
        self.start = time.monotonic()
        self.wait("HEARTBEAT", f"vehicle {url}", lambda m: True, 30.0)  # its system is pymavlink's target from now on

    def wait(self, kind: str, what: str, condition, timeout_s: float):
        """The first message of this kind for which ``condition`` holds; SystemExit when none comes in time."""
        end = time.monotonic() + timeout_s
        while time.monotonic() < end:
            message = self.link.recv_match(type=[kind, "STATUSTEXT"], blocking=True, timeout=1.0)
            if message is not None and message.get_srcSystem() != self.link.target_system:
                continue  # of another vehicle or ground station, or the vehicle is not known yet
            if message is not None and message.get_type() == "STATUSTEXT":
                print("         ", message.text)
            elif message is not None and condition(message):
                print(f"{time.monotonic() - self.start:6.1f} s  {what}", flush=True)
                return message
        raise SystemExit(f"gave up after {timeout_s:.0f} s: {what}")

    def command(self, number: int, what: str, *params: float) -> None:
        """Send a COMMAND_LONG; SystemExit when the vehicle does not accept it."""
        padded = [*params, *(0.0,) * (7 - len(params))]
        self.link.mav.command_long_send(self.link.target_system, self.link.target_component, number, 0, *padded)
        ack = self.wait("COMMAND_ACK", what, lambda m: m.command == number, 5.0)
        if ack.result != mavlink.MAV_RESULT_ACCEPTED:
            raise SystemExit(f"refused, result {ack.result}: {what}")

    def stream(self, number: int, rate_hz: float) -> None:
        """Ask for a telemetry message."""
        self.command(mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, f"message {number} at {rate_hz} Hz", number, 1e6 / rate_hz)

    def fly_to(self, north: float, east: float, down: float) -> None:
        """Send one position set-point (metres from the origin) and wait until it is reached."""
        self.link.mav.set_position_target_local_ned_send(
            0, self.link.target_system, self.link.target_component, mavlink.MAV_FRAME_LOCAL_NED, POSITION_ONLY,
            north, east, down, 0, 0, 0, 0, 0, 0, 0, 0,
        )  # fmt: skip
        self.wait(
            "LOCAL_POSITION_NED",
            f"at {north:.0f} m north, {east:.0f} m east",
            lambda m: math.dist((m.x, m.y, m.z), (north, east, down)) < NEAR_M,
            30.0,
        )


def main() -> None:
    """Fly the square."""
    copter = Copter(sys.argv[1] if len(sys.argv) > 1 else "udpin:0.0.0.0:14550")
    copter.stream(mavlink.MAVLINK_MSG_ID_LOCAL_POSITION_NED, 10.0)
    copter.stream(mavlink.MAVLINK_MSG_ID_SYS_STATUS, 2.0)
    copter.stream(mavlink.MAVLINK_MSG_ID_EKF_STATUS_REPORT, 2.0)
    position = mavlink.EKF_POS_HORIZ_ABS  # before that a real one arms, but does not take off
    copter.wait("EKF_STATUS_REPORT", "it knows where it is", lambda m: m.flags & position, 120.0)
    copter.link.set_mode("GUIDED")
    copter.wait("HEARTBEAT", "mode GUIDED", lambda m: copter.link.flightmode == "GUIDED", 5.0)
    ready = mavlink.MAV_SYS_STATUS_PREARM_CHECK
    copter.wait("SYS_STATUS", "ready to arm", lambda m: m.onboard_control_sensors_health & ready, 120.0)

    copter.command(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, "arm", 1)
    copter.command(mavlink.MAV_CMD_NAV_TAKEOFF, "take off", 0, 0, 0, 0, 0, 0, ALTITUDE_M)
    copter.wait("LOCAL_POSITION_NED", "at altitude", lambda m: m.z < -ALTITUDE_M + NEAR_M, 30.0)
    for north, east in ((SIDE_M, 0.0), (SIDE_M, SIDE_M), (0.0, SIDE_M), (0.0, 0.0)):
        copter.fly_to(north, east, -ALTITUDE_M)
    copter.command(mavlink.MAV_CMD_NAV_LAND, "land")
    armed = mavlink.MAV_MODE_FLAG_SAFETY_ARMED
    copter.wait("HEARTBEAT", "landed and disarmed", lambda m: not m.base_mode & armed, 60.0)


if __name__ == "__main__":
    main()
