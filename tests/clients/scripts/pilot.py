# SPDX-License-Identifier: BSD-3-Clause
"""What the pymavlink scripts of these tests share: a connection with heartbeats, and waits that say what is missing."""

import sys
import time

from pymavlink import mavutil

mavlink = mavutil.mavlink
ARMED = mavlink.MAV_MODE_FLAG_SAFETY_ARMED


def check(what: str, ok: object, seen: object = "") -> None:
    """Print and go on, or end the script."""
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


class Pilot:
    """A ground station (255/190) that flies a copter or drives a rover."""

    def __init__(self, url: str) -> None:
        self.link = mavutil.mavlink_connection(url, source_system=255, source_component=190)
        self.mav = self.link.mav
        self._beat = 0.0
        check("heartbeat", self.link.wait_heartbeat(timeout=30))
        self.texts: list[str] = []

    def wait(self, kinds, condition=lambda m: True, seconds=10.0):
        """First message of these kinds for which the condition holds; None when there is none in time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if time.monotonic() >= self._beat:
                self.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
                self._beat = time.monotonic() + 1.0
            message = self.link.recv_match(blocking=True, timeout=0.1)
            if message is None:
                continue
            if message.get_type() == "STATUSTEXT":
                self.texts.append(message.text)
                print("   #", message.text)
            if message.get_type() in kinds and condition(message):
                return message
        return None

    def expect(self, what, kinds, condition=lambda m: True, seconds=10.0):
        """The same, but the script ends when it does not come."""
        found = self.wait(kinds, condition, seconds)
        check(what, found is not None)
        return found

    def fly_for(self, seconds, send, every=0.2):
        """Send something again and again."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            send()
            self.wait((), seconds=every)

    def command(self, number, *params) -> int:
        """MAV_RESULT of a COMMAND_LONG."""
        self.mav.command_long_send(1, 1, number, 0, *params, *(0,) * (7 - len(params)))
        return self.expect(f"answer to command {number}", ("COMMAND_ACK",), lambda a: a.command == number, 3.0).result

    def parameter(self, name) -> float:
        """Value of a parameter."""
        self.link.param_fetch_one(name)
        return self.expect(name, ("PARAM_VALUE",), lambda p: p.param_id == name).param_value

    def stream(self, rate_hz, *names) -> None:
        """Ask for messages."""
        for name in names:
            number = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
            check(f"interval of {name}", self.command(511, number, 1e6 / rate_hz) == 0)

    def here(self):
        """Position and velocity, NED."""
        return self.expect("position", ("LOCAL_POSITION_NED",))

    def mode(self, name) -> None:
        """Change the mode the way most scripts do."""
        self.link.set_mode(name)
        number = self.link.mode_mapping()[name]
        self.expect(f"mode {name}", ("HEARTBEAT",), lambda m: m.custom_mode == number, 5.0)

    def arm(self) -> None:
        """From power-on to armed, in GUIDED."""
        self.stream(10, "LOCAL_POSITION_NED", "ATTITUDE")
        self.stream(2, "SYS_STATUS", "GLOBAL_POSITION_INT")
        self.mode("GUIDED")
        flags = mavlink.MAV_SYS_STATUS_PREARM_CHECK
        self.expect("ready to arm", ("SYS_STATUS",), lambda s: s.onboard_control_sensors_health & flags, 90.0)
        self.link.arducopter_arm()
        self.expect("armed", ("HEARTBEAT",), lambda m: m.base_mode & ARMED, 5.0)

    def take_off(self, height=10.0) -> None:
        """From power-on into the air, in GUIDED."""
        self.arm()
        check("take-off", self.command(22, 0, 0, 0, 0, 0, 0, height) == 0)
        self.expect("at height", ("LOCAL_POSITION_NED",), lambda p: p.z < -height + 0.3, 30.0)

    def disarmed(self, seconds=80.0) -> None:
        """Wait for the motors to be off."""
        self.expect("disarmed", ("HEARTBEAT",), lambda m: not m.base_mode & ARMED, seconds)
