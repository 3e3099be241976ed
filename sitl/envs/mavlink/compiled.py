# SPDX-License-Identifier: BSD-3-Clause
"""The environment's end of MAVLink for a fleet, compiled: set-points become frames, frames become what is known.

The bytes are those that ``target_messages`` and ``last_messages`` of this package make and read for one vehicle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sitl.bridge.frame import HEADER_V2
from sitl.bridge.services.rc import RcChannelsOverride
from sitl.bridge.services.setpoint_messages import SetAttitudeTarget, SetPositionTargetLocalNed
from sitl.bridge.telemetry.heartbeat import Heartbeat
from sitl.bridge.telemetry.motion import Attitude, LocalPositionNed
from sitl.bridge.telemetry.ranging import DebugFloatArray
from sitl.bridge.wire.frames import FRAME_MAX, Sender, copy_payload, find, seal
from sitl.bridge.wire.message import Message
from sitl.bridge.wire.port import INCOMING, OUT, PAYLOAD, PAYLOAD_BYTES, SIZE, Port
from sitl.core.algebra import quat_from_euler
from sitl.core.array_kernels import IntColumn, IntLine, Kernel, Line, NarrowTable, Table
from sitl.core.kernels import law
from sitl.core.mavlink import MavFrame, MavModeFlag
from sitl.core.memory import Bytes, bytes_at, record_at
from sitl.core.records import Floats, Ints, Record, Records, array
from sitl.core.vectors import Euler, Vec3
from sitl.worlds.shapes import from_heading, from_ned, to_heading, to_ned

from ...core.elementary import sincos
from ..robots.true_state import STATE
from .last_messages import HIT, PART, SCAN_NAME
from .reports import REPORTED, read_report, show_report
from .target_messages import (
    ACCELERATION_ONLY,
    ATTITUDE_AND_RATES,
    POSITION_ONLY,
    RATES_ONLY,
    TURN_AND_SPEED,
    VELOCITY_ONLY,
    YAWS_IGNORED,
)

GROUND_STATION, COMPONENT = 255, 190
"""MAVLink ids of the environment."""
RC, VELOCITY, POSITION, ATTITUDE, ROVER_POSITION, ROVER_ATTITUDE, ACCELERATION, THRUST, RATES = range(9)
"""Kinds of set-points."""
_HIT = np.frombuffer(HIT, np.uint8).astype(np.int64)
_SCAN = np.frombuffer(SCAN_NAME, np.uint8).astype(np.int64)


class Statustext(Message, name="STATUSTEXT"):
    """A text."""

    text: Ints


OVERRIDE, LOCAL, TARGET = RcChannelsOverride.kind.id, SetPositionTargetLocalNed.kind.id, SetAttitudeTarget.kind.id
HEARTBEAT_, POSITION_, ATTITUDE_ = Heartbeat.kind.id, LocalPositionNed.kind.id, Attitude.kind.id
SCAN_, TEXT_ = DebugFloatArray.kind.id, Statustext.kind.id


class ClientEnd(Record):
    """What the environment knows of one vehicle, and its next sequence number."""

    sequence: int
    system: int  # MAVLink id of the vehicle
    position_ms: int  # of position and velocity, since boot
    position: Vec3  # NED from the origin of its estimate [m]
    velocity: Vec3  # NED [m/s]
    attitude_ms: int  # of angles and rates, since boot
    euler: Euler  # [rad]
    rates: Vec3  # of the body [rad/s]
    parts: int  # of a scan
    fresh: int  # bits of the parts that have come of the scan under way
    scan_us: int  # its time
    scans: int  # whole scans so far
    hits: int  # touches since they were last shown
    mode: int
    armed: bool
    reports: Floats = array(REPORTED)  # see ``reports``


class RobotArrays(NamedTuple):
    """What an environment knows of its robots, a row each."""

    scan: NarrowTable
    """Readings of the last whole scan [m], from right to left, shape (count, readings)."""
    state: Table
    """x, y, z [m], yaw [rad]; forward, left, up [m/s], turn rate [rad/s]; roll to the right, pitch up [rad], and their
    rates [rad/s]; shape (count, STATE)."""
    collided: IntLine
    """1 for each robot that touched something during the last step, shape (count,)."""
    time: Line
    """Since the episode began [s], shape (count,)."""
    began_us: IntLine
    """When the episode began [us of simulated time], shape (count,)."""
    reports: Table
    """See ``sitl.envs.senses.REPORTS``; only what was asked for, shape (count, REPORTED)."""


def robot_arrays(count: int, readings: int) -> RobotArrays:
    """For ``count`` robots at rest, of which nothing is known."""
    scan = np.full((count, readings), np.inf, np.float32)
    numbers = np.zeros((2, count), np.int64)
    states, reports = np.zeros((count, STATE)), np.zeros((count, REPORTED))
    return RobotArrays(scan, states, numbers[0], np.zeros(count), numbers[1], reports)


# ---------------------------------------------------------------------- set-points


@law
def override(m: RcChannelsOverride, commands: Table, i: int, system: int) -> None:
    """Eight pulses [us]; 0 releases a channel."""
    for k in range(8):
        m.pulses[k] = round(commands[i, k])
    m.target_system = system
    m.target_component = 1


@law
def velocity(m: SetPositionTargetLocalNed, commands: Table, i: int, system: int) -> None:
    """Velocities along the body's heading: forward, left, up [m/s]; turn rate [rad/s]."""
    m.target_system = system
    m.coordinate_frame = MavFrame.BODY_OFFSET_NED
    m.type_mask = VELOCITY_ONLY
    m.vel = Vec3(commands[i, 0], -commands[i, 1], -commands[i, 2])
    m.yaw_rate = -commands[i, 3]


@law
def position(m: SetPositionTargetLocalNed, commands: Table, i: int, system: int, origin: Vec3, mask: int) -> None:
    """A position of the world [m], yaw [rad]; ``origin``: of the vehicle's local frame, NED in the world [m]."""
    north, east, down = to_ned(commands[i, 0], commands[i, 1], commands[i, 2])
    m.target_system = system
    m.coordinate_frame = MavFrame.LOCAL_NED
    m.type_mask = mask
    m.pos = Vec3(north, east, down) - origin
    m.yaw = to_heading(commands[i, 3])


@law
def acceleration(m: SetPositionTargetLocalNed, commands: Table, i: int, system: int) -> None:
    """Accelerations along the body's heading: forward, left, up [m/s^2]; turn rate [rad/s]."""
    m.target_system = system
    m.coordinate_frame = MavFrame.BODY_OFFSET_NED
    m.type_mask = ACCELERATION_ONLY
    m.acc = Vec3(commands[i, 0], -commands[i, 1], -commands[i, 2])
    m.yaw_rate = -commands[i, 3]


@law
def rates(m: SetAttitudeTarget, commands: Table, i: int, system: int) -> None:
    """Rates of the body: roll, pitch, turn [rad/s]; thrust 0 .. 1."""
    m.target_system = system
    m.type_mask = RATES_ONLY
    m.q[0] = 1.0
    m.rates = Vec3(commands[i, 0], commands[i, 1], -commands[i, 2])
    m.thrust = commands[i, 3]


@law
def attitude(m: SetAttitudeTarget, commands: Table, i: int, system: int, heading: float) -> None:
    """Roll, pitch [rad], turn rate [rad/s], climb -1 .. 1; ``heading`` [rad] of the vehicle."""
    q = quat_from_euler(Euler(commands[i, 0], commands[i, 1], heading))
    m.target_system = system
    m.type_mask = ATTITUDE_AND_RATES
    m.q[0] = q.w
    m.q[1] = q.x
    m.q[2] = q.y
    m.q[3] = q.z
    m.rates = Vec3(0.0, 0.0, -commands[i, 2])
    m.thrust = 0.5 + 0.5 * commands[i, 3]


@law
def rover_attitude(m: SetAttitudeTarget, commands: Table, i: int, system: int) -> None:
    """Turn rate [rad/s], throttle -1 .. 1."""
    m.target_system = system
    m.type_mask = TURN_AND_SPEED
    m.rates = Vec3(0.0, 0.0, -commands[i, 2])
    m.thrust = commands[i, 3]


@law
def write_setpoint(kind: int, commands: Table, i: int, end: ClientEnd, origin: Vec3, payload: int) -> int:
    """Write row ``i`` of the set-points to a payload's address; returns the message's number."""
    if kind == RC:
        override(record_at(RcChannelsOverride, payload), commands, i, end.system)
        return OVERRIDE
    if kind == VELOCITY:
        velocity(record_at(SetPositionTargetLocalNed, payload), commands, i, end.system)
        return LOCAL
    if kind in (POSITION, ROVER_POSITION):
        mask = POSITION_ONLY if kind == POSITION else POSITION_ONLY | YAWS_IGNORED
        position(record_at(SetPositionTargetLocalNed, payload), commands, i, end.system, origin, mask)
        return LOCAL
    if kind == ACCELERATION:
        acceleration(record_at(SetPositionTargetLocalNed, payload), commands, i, end.system)
        return LOCAL
    m = record_at(SetAttitudeTarget, payload)
    if kind in (ATTITUDE, THRUST):
        attitude(m, commands, i, end.system, end.euler.yaw)
        if kind == THRUST:
            m.thrust = commands[i, 3]
    elif kind == RATES:
        rates(m, commands, i, end.system)
    else:
        rover_attitude(m, commands, i, end.system)
    return TARGET


@law
def send_setpoints(
    ends: Records[ClientEnd], origins: Table, ports: int, rows: IntLine, kind: int, commands: Table
) -> None:
    """Send a set-point to each vehicle of ``rows``.

    Args:
        ends: one for each vehicle.
        origins: of the vehicles' local frames, NED in the world [m], shape (vehicles, 3).
        ports: address of the vehicles' ports.
        rows: numbers of the vehicles.
        kind: of set-point.
        commands: set-points, shape (vehicles, columns).
    """
    for k in range(rows.shape[0]):
        i = rows[k]
        end, address = ends[i], ports + i * SIZE
        port = record_at(Port, address)
        start = address + INCOMING + port.in_size
        frame = bytes_at(start, FRAME_MAX)
        for byte in range(FRAME_MAX):
            frame[byte] = 0
        origin = Vec3(origins[i, 0], origins[i, 1], origins[i, 2])
        number = write_setpoint(kind, commands, i, end, origin, start + HEADER_V2)
        port.in_size += seal(frame, 2, number, Sender(end.sequence, GROUND_STATION, COMPONENT))
        end.sequence = (end.sequence + 1) & 0xFF


# ---------------------------------------------------------------------- telemetry


@law
def read_position(end: ClientEnd, m: LocalPositionNed) -> None:
    """Note position [m] and velocity [m/s], NED."""
    end.position_ms = m.time_boot_ms
    end.position = m.pos
    end.velocity = m.vel


@law
def read_attitude(end: ClientEnd, m: Attitude) -> None:
    """Note Euler angles [rad] and body rates [rad/s]."""
    end.attitude_ms = m.time_boot_ms
    end.euler = m.euler
    end.rates = m.rates


@law
def begins_with(text: Ints, beginning: Ints) -> bool:
    """Whether a text, byte by byte, begins so."""
    for k in range(beginning.shape[0]):  # noqa: SIM110 - laws know no generators
        if text[k] != beginning[k]:
            return False
    return True


@law
def read_part(end: ClientEnd, m: DebugFloatArray, i: int, scans: NarrowTable, coming: NarrowTable) -> None:
    """A part of a scan; the scan counts when all have come."""
    if m.array_id >= end.parts or not begins_with(m.name, _SCAN):
        return
    if m.time_usec != end.scan_us:
        end.scan_us = m.time_usec
        end.fresh = 0
    partial, scan = coming[i], scans[i]
    part = partial[PART * m.array_id :]
    for k in range(PART):
        part[k] = m.data[k]
    end.fresh |= 1 << m.array_id
    if end.fresh == (1 << end.parts) - 1:
        end.fresh = 0
        end.scans += 1
        for k in range(scan.shape[0]):
            scan[k] = partial[k]


@law
def read_bytes(
    end: ClientEnd, data: Bytes, size: int, i: int, scans: NarrowTable, coming: NarrowTable, address: int
) -> None:
    """Read frames from a vehicle; the port at ``address`` gives space for a payload."""
    payload = address + PAYLOAD
    at = 0
    while True:
        found = find(data, at, size)
        if found.end == 0:
            return
        at, number = found.end, found.number
        copy_payload(data, found.payload, found.payload_size, bytes_at(payload, PAYLOAD_BYTES))
        if number == POSITION_:
            read_position(end, record_at(LocalPositionNed, payload))
        elif number == ATTITUDE_:
            read_attitude(end, record_at(Attitude, payload))
        elif number == SCAN_:
            read_part(end, record_at(DebugFloatArray, payload), i, scans, coming)
        elif number == HEARTBEAT_:
            beat = record_at(Heartbeat, payload)
            end.mode = beat.custom_mode
            end.armed = (beat.base_mode & MavModeFlag.SAFETY_ARMED) != 0
        elif number == TEXT_ and begins_with(record_at(Statustext, payload).text, _HIT):
            end.hits += 1
        else:
            read_report(end.reports, number, payload)


@law
def read_ports(ends: Records[ClientEnd], scans: NarrowTable, coming: NarrowTable, ports: int, rows: IntLine) -> None:
    """Read what each vehicle of ``rows`` has sent, and take it from its port.

    Args:
        ends: one for each vehicle.
        scans: the last whole scans [m], shape (vehicles, readings).
        coming: those under way, shape (vehicles, readings rounded up to whole parts).
        ports: address of the vehicles' ports.
        rows: numbers of the vehicles.
    """
    for k in range(rows.shape[0]):
        i = rows[k]
        address = ports + i * SIZE
        port = record_at(Port, address)
        read_bytes(ends[i], bytes_at(address + OUT, port.out_size), port.out_size, i, scans, coming, address)
        port.out_size = 0
        port.out_count = 0


@law
def read_row(
    ends: Records[ClientEnd], scans: NarrowTable, coming: NarrowTable, ports: int, i: int, data: int, size: int
) -> None:
    """Read ``size`` bytes of vehicle ``i`` at an address."""
    read_bytes(ends[i], bytes_at(data, size), size, i, scans, coming, ports + i * SIZE)


class Origins(NamedTuple):
    """What a vehicle's telemetry is counted from, a row each."""

    positions: Table
    """Of the vehicles' local frames, NED in the world [m], shape (vehicles, 3)."""
    since_boot_us: IntColumn
    """Simulated time of the vehicles, and that before the last boot, shape (vehicles,)."""
    before_boot_us: IntLine


@law
def show_robots(
    ends: Records[ClientEnd],
    coming: NarrowTable,
    ports: int,
    origins: Origins,
    base_along: float,
    robots: RobotArrays,
    rows: IntLine,
) -> None:
    """Read what each vehicle of ``rows`` has sent (see ``read_ports``), and write what is known of it.

    Args:
        ends: one for each vehicle.
        coming: scans under way [m].
        ports: address of the vehicles' ports.
        origins: of the vehicles.
        base_along: how far the robot's base lies ahead of the body's origin [m].
        robots: what is written.
        rows: numbers of the vehicles.
    """
    read_ports(ends, robots.scan, coming, ports, rows)
    state, positions = robots.state, origins.positions
    for k in range(rows.shape[0]):
        i = rows[k]
        end = ends[i]
        p, v, heading = end.position, end.velocity, end.euler.yaw
        s, c = sincos(heading)
        x, y, z = from_ned(
            positions[i, 0] + p.x + base_along * c, positions[i, 1] + p.y + base_along * s, positions[i, 2] + p.z
        )
        state[i, 0], state[i, 1], state[i, 2], state[i, 3] = x, y, z, from_heading(heading)
        state[i, 4], state[i, 5] = v.x * c + v.y * s, v.x * s - v.y * c
        state[i, 6], state[i, 7] = -v.z, -end.rates.z
        state[i, 8], state[i, 9] = end.euler.roll, end.euler.pitch
        state[i, 10], state[i, 11] = end.rates.x, end.rates.y
        show_report(end.reports, heading, robots.reports, i)
        robots.collided[i] = 1 if end.hits > 0 else 0
        end.hits = 0
        robots.time[i] = 1e-6 * (origins.before_boot_us[i] + origins.since_boot_us[i] - robots.began_us[i])


send_all = Kernel(send_setpoints)
read_all = Kernel(read_ports)
read_one = Kernel(read_row)
show_all = Kernel(show_robots)
