# SPDX-License-Identifier: BSD-3-Clause
"""Sixteen copters fly formations: a square, a ring that turns, an arrow, and back. Plain pymavlink on one link.

    sitl run copter --count 16
    python examples/swarm_formation.py                             (CONNECTION: udpin:0.0.0.0:14550)

    sitl run copter --count 16 --lockstep
    python examples/swarm_formation.py tcp:127.0.0.1:5760 --lockstep

In lockstep the script gives the vehicles their time, and each run is the same, bit for bit.
"""

import argparse
import itertools
import math
import os
import time

os.environ["MAVLINK20"] = "1"  # pymavlink looks at it when it is imported

from pymavlink import mavutil

HEIGHT_M = 6.0
STEP_S = 0.2
RING_M = 12.0
TURN_RAD = math.pi / 2
MOVE_S, READY_S, LIFT_S, LAND_S = 15.0, 60.0, 12.0, 40.0
GUIDED = 4
GRANT = 31010
"""MAV_CMD_USER_1, to `sitl run --lockstep`: go on to this simulated time [ms]."""
POSITION_ONLY = 0b110111111000
METRES_A_DEGREE = 111_319.5

mavlink = mavutil.mavlink
Position = tuple[float, float]
"""North, east [m] of the first vehicle's start."""


class Swarm:
    """Vehicles on one link, distinguished by their system ids."""

    def __init__(self, url: str, count: int, lockstep: bool) -> None:
        self.link = mavutil.mavlink_connection(url, source_system=255)
        self.lockstep, self.ids = lockstep, range(1, count + 1)
        self.now = 0.0
        self.positions: dict[int, object] = {}
        """The last GLOBAL_POSITION_INT of each that knows where it is."""
        self.located: set[int] = set()
        """Those that know where they are."""
        self.armed: set[int] = set()
        self.accepted: dict[tuple[int, int], bool] = {}
        self.hits: dict[int, str] = {}
        self.tracks: dict[int, list[tuple[float, float, float]]] = {system: [] for system in self.ids}
        """North, east [m] of the first vehicle's start, and height [m]."""
        self.formations: list[tuple[str, list[Position]]] = []
        """Where the vehicles were at the end of each move."""
        self.origin: Position | None = None

    def wait(self, seconds: float) -> None:
        """Let simulated time go by, and listen."""
        self.now += seconds
        if self.lockstep:
            goal = round(self.now * 1000)
            self.link.mav.command_int_send(self.ids[0], 1, 0, GRANT, 0, 0, 0, 0, 0, 0, goal, 0, 0)
            while True:
                message = self.link.recv_match(blocking=True, timeout=60.0)
                if message is None:
                    raise SystemExit("the vehicles do not answer")
                self.hear(message)
                if message.get_type() == "COMMAND_ACK" and message.command == GRANT and message.result_param2 >= goal:
                    break
        else:
            end = time.monotonic() + seconds
            while (left := end - time.monotonic()) > 0.0:
                message = self.link.recv_match(blocking=True, timeout=left)
                if message is not None:
                    self.hear(message)
        for system, track in self.tracks.items():
            if system in self.positions:
                message = self.positions[system]
                track.append((*self.position(system), message.relative_alt * 1e-3))

    def hear(self, message) -> None:
        """Note what a message says."""
        system, kind = message.get_srcSystem(), message.get_type()
        if kind == "GLOBAL_POSITION_INT" and system in self.located:
            self.positions[system] = message
        elif kind == "EKF_STATUS_REPORT" and message.flags & mavlink.EKF_POS_HORIZ_ABS:
            self.located.add(system)
        elif kind == "HEARTBEAT":
            (self.armed.add if message.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED else self.armed.discard)(system)
        elif kind == "COMMAND_ACK":
            self.accepted[system, message.command] = message.result == mavlink.MAV_RESULT_ACCEPTED
        elif kind == "STATUSTEXT" and "Hit obstacle" in message.text:
            self.hits[system] = message.text

    def wait_until(self, what: str, condition, limit_s: float) -> None:
        """Until it holds; SystemExit when it does not in time."""
        for _ in range(round(limit_s / STEP_S)):
            if condition():
                break
            self.wait(STEP_S)
        else:
            raise SystemExit(f"gave up after {limit_s:.0f} s: {what}")
        print(f"{self.now:6.1f} s  {what}", flush=True)

    def command_all(self, what: str, number: int, *params: float) -> None:
        """A command to each, until all have accepted it."""
        padded = [*params, *(0.0,) * (7 - len(params))]
        for system in self.ids:
            self.accepted.pop((system, number), None)
            self.link.mav.command_long_send(system, 1, number, 0, *padded)
        self.wait_until(what, lambda: all(self.accepted.get((system, number)) for system in self.ids), 10.0)

    def position(self, system: int) -> Position:
        """Where a vehicle is."""
        lat, lon = (getattr(self.positions[system], name) * 1e-7 for name in ("lat", "lon"))
        if self.origin is None:
            self.origin = (lat, lon)
        east = (lon - self.origin[1]) * math.cos(math.radians(self.origin[0]))
        return (lat - self.origin[0]) * METRES_A_DEGREE, east * METRES_A_DEGREE

    def send(self, system: int, position: Position) -> None:
        """A set-point at the height of all."""
        north, east = position
        lat = self.origin[0] + north / METRES_A_DEGREE
        lon = self.origin[1] + east / METRES_A_DEGREE / math.cos(math.radians(self.origin[0]))
        self.link.mav.set_position_target_global_int_send(
            0, system, 1, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, POSITION_ONLY, round(lat * 1e7), round(lon * 1e7),
            HEIGHT_M, 0, 0, 0, 0, 0, 0, 0, 0,
        )  # fmt: skip

    def move(self, what: str, goals: dict[int, Position], seconds: float = MOVE_S) -> None:
        """Fly to positions, all arriving at the same time: their paths do not cross when ``assign`` chose the goals."""
        begin = {system: self.position(system) for system in self.ids}
        steps = round(seconds / STEP_S)
        for step in range(1, steps + 1):
            share = 0.5 - 0.5 * math.cos(math.pi * step / steps)
            for system in self.ids:
                (n0, e0), (n1, e1) = begin[system], goals[system]
                self.send(system, (n0 + share * (n1 - n0), e0 + share * (e1 - e0)))
            self.wait(STEP_S)
        self.wait(3.0)
        errors = [math.dist(self.position(system), goals[system]) for system in self.ids]
        self.formations.append((what, [self.position(system) for system in self.ids]))
        print(f"{self.now:6.1f} s  {what}: within {max(errors):.2f} m", flush=True)


def assign(positions: dict[int, Position], slots: list[Position]) -> dict[int, Position]:
    """A slot for each vehicle, such that the squares of all paths together are least that swaps can make them."""
    goals = dict(zip(positions, slots, strict=True))
    swapped = True
    while swapped:
        swapped = False
        for a, b in itertools.combinations(positions, 2):
            now = math.dist(positions[a], goals[a]) ** 2 + math.dist(positions[b], goals[b]) ** 2
            then = math.dist(positions[a], goals[b]) ** 2 + math.dist(positions[b], goals[a]) ** 2
            if then < now - 1e-9:
                goals[a], goals[b] = goals[b], goals[a]
                swapped = True
    return goals


def ring(count: int, centre: Position, angle: float = 0.0) -> list[Position]:
    """Positions on a circle."""
    angles = [angle + math.tau * k / count for k in range(count)]
    return [(centre[0] + RING_M * math.cos(a), centre[1] + RING_M * math.sin(a)) for a in angles]


def arrow(count: int, centre: Position) -> list[Position]:
    """Positions on two lines that meet in the north."""
    return [
        (centre[0] + 10.0 - 2.5 * (k // 2), centre[1] + (1 if k % 2 else -1) * (1.5 + 2.5 * (k // 2)))
        for k in range(count)
    ]


def fly(swarm: Swarm) -> None:
    """The whole flight."""
    swarm.wait(1.0)
    for name, rate_hz in (("GLOBAL_POSITION_INT", 5), ("EKF_STATUS_REPORT", 1)):
        number = getattr(mavlink, f"MAVLINK_MSG_ID_{name}")
        swarm.command_all(f"{name} at {rate_hz} Hz", mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, number, 1e6 / rate_hz)
    swarm.wait_until("all know where they are", lambda: len(swarm.positions) == len(swarm.ids), READY_S)
    swarm.wait(5.0)
    swarm.command_all("GUIDED", mavlink.MAV_CMD_DO_SET_MODE, 1, GUIDED)
    swarm.command_all("armed", mavlink.MAV_CMD_COMPONENT_ARM_DISARM, 1)
    starts = {system: swarm.position(system) for system in swarm.ids}
    swarm.command_all("take-off", mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, HEIGHT_M)
    swarm.wait(LIFT_S)
    centre = tuple(sum(position[axis] for position in starts.values()) / len(starts) for axis in (0, 1))
    goals = assign(starts, ring(len(starts), centre))
    swarm.move("ring", goals)
    steps = 20
    for step in range(1, steps + 1):  # each from its own position on
        for system, (north, east) in goals.items():
            angle = math.atan2(east - centre[1], north - centre[0]) + TURN_RAD * step / steps
            swarm.send(system, ring(1, centre, angle)[0])
        swarm.wait(1.0)
    swarm.move("arrow", assign({system: swarm.position(system) for system in swarm.ids}, arrow(len(starts), centre)))
    swarm.move("square", assign({system: swarm.position(system) for system in swarm.ids}, list(starts.values())))
    swarm.command_all("land", mavlink.MAV_CMD_NAV_LAND)
    swarm.wait_until("landed and disarmed", lambda: not swarm.armed, LAND_S)
    for system, text in swarm.hits.items():
        print(f"system {system}: {text}")


def main() -> None:
    """Fly with the vehicles at a connection."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("connection", nargs="?", default="udpin:0.0.0.0:14550")
    parser.add_argument("--count", type=int, default=16)
    parser.add_argument("--lockstep", action="store_true")
    options = parser.parse_args()
    fly(Swarm(options.connection, options.count, options.lockstep))


if __name__ == "__main__":
    main()
