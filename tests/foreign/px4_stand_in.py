# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for PX4's simulator program: its command line, its handshake, its ways on both links; a small controller
on the truth inside.

As the real one (release/1.18 of August 2026): connects to the simulator and tries until it is there; says HEARTBEAT
and asks for the truth, then nothing until it has booted; its clock is HIL_SENSOR's; zeros while disarmed, else parts
of each motor's range; MAVLink by UDP to 14540 + N first, or as a file in PATH says; OFFBOARD only while set-points
come; hears commands only while its time passes; modes, whole numbers, missions without home (answered by a MISSION_ACK
with an extension field that this dialect does not know), take-off above mean sea level.
Parameters that it does not have are named in its output. With IMU_INTEG_RATE below the rate of samples its estimator
runs at each n-th one, and the answers to the others wait for it. MAVLink begins some wall time after it answers.
LOCAL_POSITION_NED comes at once, with a heading without declination, until ESTIMATOR_STATUS says that it is valid.
"""

from __future__ import annotations

import math
import os
import socket
import sys
import time
from pathlib import Path

from sitl.bridge.dialect import crc_mcrf4xx, message
from sitl.bridge.frame import Splitter, encode_v2
from sitl.core.algebra import euler_of
from sitl.core.vectors import Quat
from tests.foreign import px4_stand_in_pilot as pilot
from tests.foreign.px4_stand_in_pilot import LOITER, METRES, TAKEOFF

BOOT_TICKS, POSITION_TICKS = 400, 4000
START_S = 1.0
DECLINATION = 0.23
UNTRUE, VALID = 1 | 4, 1 | 2 | 4 | 8 | 16 | 32
OFFBOARD, FRESH_US, LOSS_US = 6 << 16, 500_000, 1_000_000
PREARM = 0x10000000
KNOWN = (
    *("CA_", "MC_ROLL", "MC_PITCH", "MC_YAW", "MPC_", "PWM_MAIN_", "THR_MDL_FAC", "BAT1_", "NAV_", "COM_", "IMU_"),
    *("SDLOG_", "EKF2_", "SIM_BAT_"),
)
"""Beginnings of the parameters that it has."""
MASS, GRAVITY, THRUST, TURN = 1.14, 9.80665, 8.54858e-6, (0.035, 0.046, 0.098)
TOP_SPEED = 838.0


def limited(value: float, bound: float) -> float:
    return min(max(value, -bound), bound)


class Wire:
    """Frames in and out, over any socket."""

    def __init__(self, send, system: int) -> None:
        self._send, self._system, self._sequence = send, system, 0

    def say(self, name: str, **fields) -> None:
        kind = message(name)
        self._send(encode_v2(kind, kind.payload(**fields), self._sequence, self._system, 1))
        self._sequence = self._sequence + 1 & 0xFF

    def acknowledge_mission(self) -> None:
        """MISSION_ACK as a newer dialect has it: with the id of the mission behind what ours knows."""
        kind = message("MISSION_ACK")
        payload = kind.payload(target_system=255, target_component=190) + b"abcd"
        body = bytes((len(payload), 0, 0, 0, self._system, 1)) + kind.wire_id + payload
        self._send(b"\xfd" + body + crc_mcrf4xx(body + kind.crc_extra, 0xFFFF).to_bytes(2, "little"))


class Px4:
    def __init__(self, instance: int) -> None:
        assert os.environ["PX4_SIM_MODEL"] == "none_iris" and os.environ["PX4_SIMULATOR"] == "mavlink"
        given = {name[10:]: float(value) for name, value in os.environ.items() if name.startswith("PX4_PARAM_")}
        for name in given:
            if not name.startswith(KNOWN):
                print(f"ERROR [param] Parameter {name} not found.", flush=True)
        print("ERROR [param] Parameter UXRCE_DDS_KEY not found.", flush=True)  # of its own start script
        self.given = given
        self.rotors = [
            tuple(given[f"CA_ROTOR{k}_{axis}"] for axis in ("PX", "PY", "KM"))
            for k in range(int(given["CA_ROTOR_COUNT"]))
        ]
        self.simulator = connect(4560 + instance)
        self.hil = Wire(self.simulator.sendall, 1 + instance)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        own, theirs = links() or (14580 + instance, 14540 + instance)
        self.socket.bind(("127.0.0.1", own))
        self.socket.setblocking(False)
        self.client = ("127.0.0.1", theirs)
        self.link = Wire(lambda frame: self.socket.sendto(frame, self.client), 1 + instance)
        self.now, self.ticks, self.armed, self.mode = 0, 0, False, LOITER
        self.items, self.awaited, self.current = [], 0, 0
        self.every = max(round(400 / given["IMU_INTEG_RATE"]), 1)
        self.answered = None
        self.truth, self.origin = None, None
        self.target, self.target_us = (0.0,) * 4, -FRESH_US
        self.place = None
        self.intervals = {
            "LOCAL_POSITION_NED": 50_000, "ATTITUDE": 50_000, "ESTIMATOR_STATUS": 2_000_000, "HEARTBEAT": 1_000_000,
            "GLOBAL_POSITION_INT": 50_000, "SYS_STATUS": 200_000,
        }  # fmt: skip
        self.due = dict.fromkeys(self.intervals, 0)

    def run(self) -> None:
        self.hil.say("HEARTBEAT", autopilot=12)
        self.hil.say("COMMAND_LONG", command=511, param1=115, param2=5000)
        splitter, commands = Splitter(), Splitter()
        while data := self.simulator.recv(1 << 16):
            for frame in splitter.feed(data):
                if frame.kind.name == "HIL_STATE_QUATERNION":
                    self.truth = frame.kind.decode(frame.payload)
                elif frame.kind.name == "HIL_SENSOR":
                    self.sense(frame.kind.decode(frame.payload))
                    if self.answered is not None and time.monotonic() > self.answered + START_S:
                        self.hear(commands)
                        self.tell()
                    if self.ticks > BOOT_TICKS and self.ticks % self.every == 0:
                        self.answered = self.answered or time.monotonic()
                        self.answer()

    def sense(self, sensor) -> None:
        now = sensor.time_usec
        assert now > self.now or self.ticks == 0, "time goes forward"
        self.now, self.ticks, self.gyro = now, self.ticks + 1, (sensor.xgyro, sensor.ygyro, sensor.zgyro)
        if self.mode == OFFBOARD and now - self.target_us > LOSS_US:
            self.mode = LOITER  # COM_OF_LOSS_T
        if self.origin is None and self.ticks > POSITION_TICKS:
            self.origin = (self.truth.lat, self.truth.lon, self.truth.alt)

    def position(self) -> tuple[float, float, float]:
        lat, lon, alt = self.origin
        north, down = (self.truth.lat - lat) * METRES, (alt - self.truth.alt) * 1e-3
        return north, (self.truth.lon - lon) * METRES * math.cos(math.radians(lat * 1e-7)), down

    # ------------------------------------------------------------------ MAVLink

    def tell(self) -> None:
        for name, interval in self.intervals.items():
            if interval > 0 and self.now >= self.due[name]:
                self.due[name] = self.now + interval
                self.report(name)

    def report(self, name: str) -> None:
        ms = self.now // 1000
        if name == "HEARTBEAT":
            mode = 1 | 128 * self.armed
            self.link.say(name, autopilot=12, type=2, base_mode=mode, custom_mode=self.mode)
        elif name == "SYS_STATUS":
            self.link.say(name, onboard_control_sensors_health=PREARM if self.origin else 0)
        elif name == "GLOBAL_POSITION_INT" and self.origin is not None:
            t = self.truth
            self.link.say(name, time_boot_ms=ms, lat=t.lat, lon=t.lon, alt=t.alt, relative_alt=t.alt - self.origin[2],
                          vx=t.vx, vy=t.vy, vz=t.vz, hdg=65535)  # fmt: skip
        elif name == "HOME_POSITION" and self.origin is not None:
            self.link.say(name, latitude=self.origin[0], longitude=self.origin[1], altitude=self.origin[2])
        elif name == "ESTIMATOR_STATUS":
            self.link.say(name, time_usec=self.now, flags=UNTRUE if self.origin is None else VALID)
        elif self.origin is None and name == "LOCAL_POSITION_NED":
            self.link.say(name, time_boot_ms=ms)
        elif name == "LOCAL_POSITION_NED":
            x, y, z = self.position()
            vx, vy, vz = (0.01 * v for v in (self.truth.vx, self.truth.vy, self.truth.vz))
            self.link.say(name, time_boot_ms=ms, x=x, y=y, z=z, vx=vx, vy=vy, vz=vz)
        elif self.truth is not None and name == "ATTITUDE":
            roll, pitch, yaw = euler_of(Quat(*self.truth.attitude_quaternion))
            yaw -= DECLINATION if self.origin is None else 0.0
            self.link.say(name, time_boot_ms=ms, roll=roll, pitch=pitch, yaw=yaw, yawspeed=self.gyro[2])
        elif self.origin is not None and name == "GPS_GLOBAL_ORIGIN":
            self.link.say(name, latitude=self.origin[0], longitude=self.origin[1], altitude=self.origin[2])

    def hear(self, splitter: Splitter) -> None:
        while True:
            try:
                data, self.client = self.socket.recvfrom(65535)
            except BlockingIOError:
                return
            for frame in splitter.feed(data):
                fields = frame.kind.decode(frame.payload)
                if frame.kind.name == "COMMAND_LONG":
                    result = self.command(fields)
                    self.link.say("COMMAND_ACK", command=fields.command, result=result)
                elif frame.kind.name in pilot.HEARD:
                    pilot.HEARD[frame.kind.name](self, fields)
                elif frame.kind.name == "SET_POSITION_TARGET_LOCAL_NED" and fields.coordinate_frame == 1:
                    self.target_us = self.now
                    self.place = None if fields.type_mask & 7 else (fields.x, fields.y, fields.z, fields.yaw)
                    self.target = (fields.vx, fields.vy, fields.vz, fields.yaw_rate)

    def command(self, fields) -> int:
        names = {message(name).id: name for name in (*self.intervals, "GPS_GLOBAL_ORIGIN", "HOME_POSITION")}
        if fields.command in (511, 512) and int(fields.param1) in names:
            if fields.command == 512:
                self.report(names[int(fields.param1)])
            else:
                self.intervals[names[int(fields.param1)]] = int(fields.param2)
            return 0
        if fields.command == 176:
            fresh, mode = self.now - self.target_us < FRESH_US, int(fields.param2) << 16 | int(fields.param3) << 24
            if mode == OFFBOARD and not (fresh and self.origin):
                return 1  # temporarily rejected
            pilot.choose(self, mode)
            return 0
        if fields.command == 400:
            if self.origin is None:
                return 1
            self.armed = fields.param1 == 1.0
            return 0
        if fields.command == 22 and self.origin is not None:
            assert math.isnan(fields.param5), "a take-off where it stands"
            x, y, _ = self.position()
            pilot.choose(self, TAKEOFF)
            self.place = (x, y, self.origin[2] * 1e-3 - fields.param7, self.yaw())
            return 0
        return 3

    def yaw(self) -> float:
        return euler_of(Quat(*self.truth.attitude_quaternion))[2]

    # ------------------------------------------------------------------ flight

    def towards(self, place: tuple[float, float, float, float]) -> tuple[float, ...]:
        """Velocity and turn rate."""
        turn = limited(2.0 * math.remainder(place[3] - self.yaw(), 2.0 * math.pi), 1.0)
        return (*(limited(1.0 * (p - q), 2.0) for p, q in zip(place, self.position())), turn)

    def answer(self) -> None:
        controls = self.fly() if self.armed else [0.0] * 16
        self.hil.say("HIL_ACTUATOR_CONTROLS", time_usec=self.now, controls=controls, mode=1 | 128 * self.armed, flags=1)

    def fly(self) -> list[float]:
        roll, pitch, yaw = euler_of(Quat(*self.truth.attitude_quaternion))
        vn, ve, vd = (0.01 * v for v in (self.truth.vx, self.truth.vy, self.truth.vz))
        wanted = self.target
        if self.mode != OFFBOARD:
            wanted = pilot.guide(self)
        elif self.now - self.target_us > FRESH_US:
            wanted = (0.0, 0.0, 0.0, 0.0)  # nobody leads: hold
        elif self.place is not None:
            wanted = self.towards(self.place)
        an, ae = limited(1.5 * (wanted[0] - vn), 3.0), limited(1.5 * (wanted[1] - ve), 3.0)
        ad = limited(3.0 * (wanted[2] - vd), 4.0)
        c, s = math.cos(yaw), math.sin(yaw)
        lean = (-s * an + c * ae) / GRAVITY, -(c * an + s * ae) / GRAVITY
        rates = (6.0 * (lean[0] - roll), 6.0 * (lean[1] - pitch), wanted[3])
        mx, my, mz = (j * k * (w - g) for j, k, w, g in zip(TURN, (20.0, 20.0, 5.0), rates, self.gyro))
        thrust = MASS * (GRAVITY - ad) / (math.cos(roll) * math.cos(pitch))
        controls = [0.0] * 16
        for k, (x, y, km) in enumerate(self.rotors):
            lever = 4.0 * self.rotors[0][0] ** 2
            force = 0.25 * thrust - y / lever * mx + x / lever * my + mz / (4.0 * km)
            controls[k] = math.sqrt(max(force, 0.1) / THRUST) / TOP_SPEED
        return controls


def links() -> tuple[int, int] | None:
    """UDP ports of its MAVLink, its own and the other one, by the first file of this name in PATH."""
    for folder in os.environ["PATH"].split(os.pathsep):
        file = Path(folder) / "px4-rc.mavlink"
        if file.is_file():
            words = file.read_text().split()
            return int(words[words.index("-u") + 1]), int(words[words.index("-o") + 1])
    return None


def connect(port: int) -> socket.socket:
    while True:
        made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        try:
            made.connect(("127.0.0.1", port))
        except OSError:
            made.close()
            time.sleep(0.0005)
        else:
            return made


def install(folder: Path) -> Path:
    """A program in a folder that starts this file."""
    (folder / "bin").mkdir()
    program, root = folder / "bin" / "px4", Path(__file__).resolve().parents[2]
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{root}" exec "{sys.executable}" "{__file__}" "$@"\n')
    program.chmod(0o755)
    return program


if __name__ == "__main__":
    assert sys.argv[1] == "-i" and sys.argv[3] == "-d" and sys.argv[4].endswith("/etc"), sys.argv
    Px4(int(sys.argv[2])).run()
