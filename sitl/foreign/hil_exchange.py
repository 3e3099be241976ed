# SPDX-License-Identifier: BSD-3-Clause
"""What an exchange of the HIL link takes on each tick, as laws: an answer of PX4, a tick, HIL_SENSOR and the truth.

``converse`` makes many exchanges in one call, system calls included, on Linux and native physics. It leaves to Python
(``hil_host``) whatever is not the answer to the present tick, and ticks with more to report than these two messages.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..bridge.hil.controls import OUTPUTS
from ..bridge.hil.protocol import BARO_UPDATED, IMU_UPDATED, LOCKSTEP, MAG_UPDATED
from ..bridge.hil.sensor import DITHER_BARO, DITHER_MAG, pressure_altitude
from ..bridge.telemetry.sensors import HighresImu
from ..bridge.telemetry.units import uint16
from ..bridge.wire.dialect_rows import PAYLOAD_MAX
from ..bridge.wire.frames import FRAME_MAX, Sender, copy_payload, find, seal
from ..bridge.wire.message import Message, consecutive
from ..bridge.wire.port import PAYLOAD_BYTES
from ..core.array_kernels import Kernel
from ..core.border import Actuators, Sensors
from ..core.kernels import law
from ..core.mavlink import MavModeFlag
from ..core.memory import bytes_at, call_unit, ints_at, record_at
from ..core.records import Floats, Ints, Record, array
from ..core.system_call import call_system
from ..core.vectors import Vec3
from ..physics.carried import carried
from ..physics.native.records import Body, Obstacles, Origin

INBOX_BYTES = 2048
"""Bytes that are read at once."""
MARKS = 16
"""As many fields of a record may say that there is something else to report."""
GREATEST = 10.0
"""No control is that large."""
HEADER = 10
"""Bytes of a frame before its payload."""
NO_SIGNAL = 0x4000
"""MSG_NOSIGNAL: that the other end has gone is found when it is read from."""
IS_DONE, IS_NEWS, IS_SILENT, IS_ODD = range(4)
"""How ``converse`` ends: at the time, or after the ticks, that are allowed; a tick is done that has more to report, or
that a sensor of a world has to measure in; no answer came; what came is Python's to judge."""


class HilControls(Message, name="HIL_ACTUATOR_CONTROLS"):
    time_usec: int
    flags: int
    controls: Floats
    mode: int


class HilSensor(HighresImu, name="HIL_SENSOR"):
    pass


class HilState(Message, name="HIL_STATE_QUATERNION"):
    time_usec: int
    attitude_quaternion: Floats
    rates: Vec3 = consecutive("rollspeed", "pitchspeed", "yawspeed")
    lat: int
    lon: int
    alt: int
    vel: Vec3 = consecutive("vx", "vy", "vz")
    ind_airspeed: int
    true_airspeed: int
    acc: Vec3 = consecutive("xacc", "yacc", "zacc")


HIL_SENSOR, HIL_STATE_QUATERNION, ANSWER = HilSensor.kind.id, HilState.kind.id, HilControls.kind.id


class HilExchange(Record):
    """An exchange with one PX4, and where all that it needs is."""

    # the vehicle's record
    records: int  # addresses
    vehicles: int
    index: int
    clock: int
    actuators: int
    sensors: int
    body: int
    origin: int
    obstacles: int
    lowest: float  # controls of rotors that stand and that turn fastest
    highest: float
    marks: int  # fields that say that there is something else to report
    mark_at: Ints = array(MARKS, stored="i8")  # their addresses
    mark_size: Ints = array(MARKS, stored="i8")
    seen: int  # address of what they were, 8 bytes each
    # units, functions and memory
    step: int  # addresses
    list_near: int
    ranging: int
    measure_us: int  # when a sensor of a world measures next
    receive: int  # addresses of recv, send
    send: int
    socket: int
    inbox: int  # INBOX_BYTES
    received: int  # of them
    given: int  # address of an answer's payload
    outbox: int  # of two frames
    # the link
    began_us: int  # our time when the autopilot's clock was 0
    sequence: int  # of the last frame that was sent
    system: int
    component: int
    mag: int  # samples that were reported last
    baro: int
    altitude: float
    truth_every_us: int  # 0: nobody wants it
    truth_due_us: int
    until_us: int
    answers: int  # that may still be taken
    taken: int
    is_armed: bool


class _Physics(NamedTuple):
    body: Body
    origin: Origin


class _Vehicle(NamedTuple):
    """What ``carried`` looks at of a vehicle."""

    physics: _Physics


@law
def has_news(x: HilExchange) -> bool:
    """Whether a field has changed that says so."""
    found, seen = False, bytes_at(x.seen, 8 * MARKS)
    for n in range(x.marks):
        size = x.mark_size[n]
        now = bytes_at(x.mark_at[n], size)
        for k in range(size):
            if now[k] != seen[8 * n + k]:
                seen[8 * n + k] = now[k]
                found = True
    return found


@law
def write_sensor(x: HilExchange, at: int, time_us: int) -> int:
    """Write HIL_SENSOR as ``bridge.hil.sensor`` does; gives the length of the frame."""
    payload = bytes_at(at + HEADER, PAYLOAD_MAX)
    for k in range(PAYLOAD_MAX):
        payload[k] = 0
    m, s = record_at(HilSensor, at + HEADER), record_at(Sensors, x.sensors)
    mag = s.mag
    m.time_usec = time_us
    m.acc, m.gyro = s.acc, s.gyro
    m.mag = Vec3(float(mag.x) + DITHER_MAG * (s.mag_count & 1), mag.y, mag.z)
    pressure = float(s.abs_pressure) + DITHER_BARO * (s.baro_count & 1)
    updated = IMU_UPDATED
    if s.mag_count != x.mag:
        x.mag = s.mag_count
        updated |= MAG_UPDATED
    if s.baro_count != x.baro:
        x.baro = s.baro_count
        x.altitude = pressure_altitude(pressure)
        updated |= BARO_UPDATED
    m.abs_pressure, m.pressure_alt, m.temperature, m.fields_updated = pressure, x.altitude, s.temperature, updated
    x.sequence = (x.sequence + 1) & 0xFF
    sender = Sender(x.sequence, x.system, x.component)
    return seal(bytes_at(at, FRAME_MAX), 2, HIL_SENSOR, sender)


@law
def write_truth(x: HilExchange, at: int, time_us: int) -> int:
    """Write HIL_STATE_QUATERNION as ``bridge.hil.truth`` does; gives the length of the frame."""
    payload = bytes_at(at + HEADER, PAYLOAD_MAX)
    for k in range(PAYLOAD_MAX):
        payload[k] = 0
    m = record_at(HilState, at + HEADER)
    truth = carried(_Vehicle(_Physics(record_at(Body, x.body), record_at(Origin, x.origin))))  # type: ignore[arg-type]
    north, east, down = truth.velocity
    speed = uint16(math.sqrt(north * north + east * east + down * down))
    m.time_usec = time_us
    for k in range(4):
        m.attitude_quaternion[k] = truth.attitude[k]
    m.rates = Vec3(truth.rates[0], truth.rates[1], truth.rates[2])
    m.lat, m.lon, m.alt = truth.lat, truth.lon, truth.alt
    m.vel = Vec3(north, east, down)
    m.ind_airspeed = m.true_airspeed = speed
    m.acc = Vec3(truth.acceleration[0], truth.acceleration[1], truth.acceleration[2])
    x.sequence = (x.sequence + 1) & 0xFF
    sender = Sender(x.sequence, x.system, x.component)
    return seal(bytes_at(at, FRAME_MAX), 2, HIL_STATE_QUATERNION, sender)


@law
def report(x: HilExchange) -> int:
    """Write a tick that has nothing else to report, the truth before it where that is due; gives the length."""
    now_us, size = ints_at(x.clock, 1)[0], 0
    is_due = x.truth_every_us > 0 and x.truth_due_us <= now_us
    if is_due:  # it is counted behind, as Python does
        x.truth_due_us = now_us + x.truth_every_us
        x.sequence = (x.sequence + 1) & 0xFF
        size = write_truth(x, x.outbox, now_us)
        x.sequence = (x.sequence - 2) & 0xFF
    size += write_sensor(x, x.outbox + size, now_us)
    if is_due:
        x.sequence = (x.sequence + 1) & 0xFF
    return size


@law
def judge(x: HilExchange) -> bool:
    """Whether what was received is the answer to the present tick and nothing else; it is in the record then."""
    data = bytes_at(x.inbox, INBOX_BYTES)
    frame = find(data, 0, x.received)
    if frame.end != x.received or frame.start != 0 or frame.number != ANSWER:
        return False
    copy_payload(data, frame.payload, frame.payload_size, bytes_at(x.given, PAYLOAD_BYTES))
    given, actuators = record_at(HilControls, x.given), record_at(Actuators, x.actuators)
    if given.time_usec + x.began_us != ints_at(x.clock, 1)[0] or given.flags & LOCKSTEP == 0:
        return False
    for k in range(OUTPUTS):
        if not abs(given.controls[k]) < GREATEST:
            return False
    span = x.highest - x.lowest
    for k in range(OUTPUTS):
        actuators.controls[k] = x.lowest + span * given.controls[k]
    x.is_armed = given.mode & MavModeFlag.SAFETY_ARMED != 0
    actuators.armed = x.is_armed
    return True


@law
def converse(exchange: int) -> int:
    """Take answers, and step, with the ``HilExchange`` at an address."""
    x = record_at(HilExchange, exchange)
    clock, obstacles = ints_at(x.clock, 1), record_at(Obstacles, x.obstacles)
    x.taken = 0
    while x.answers > 0 and clock[0] < x.until_us:
        x.received = max(call_system(x.receive, x.socket, x.inbox, INBOX_BYTES, 0, 0), 0)
        if x.received == 0:
            return IS_SILENT
        if not judge(x):
            return IS_ODD
        if obstacles.wanted:
            call_unit(x.list_near, x.records, x.vehicles, x.index, x.ranging, 0, 0)
        call_unit(x.step, x.records, x.vehicles, x.index, 0, 0, 0)
        x.taken += 1
        x.answers -= 1
        if x.measure_us <= clock[0] or has_news(x):
            return IS_NEWS
        call_system(x.send, x.socket, x.outbox, report(x), NO_SIGNAL, 0)
    return IS_DONE


conversed = Kernel(converse, lets_others_run=True)
