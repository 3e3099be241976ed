# SPDX-License-Identifier: BSD-3-Clause
"""What an exchange of the JSON interface takes on each tick, as laws: pulses into a record, ticks, lines of JSON.

``converse`` makes many exchanges in one call, system calls included, on Linux and native physics. It leaves to Python
(``json_host``) whatever is not the next frame of the autopilot that is served, and what sensors of a world measure.
"""

from __future__ import annotations

from ..bridge.ardupilot_json.physics_end import MOST_LINES, lines, ticks
from ..bridge.ardupilot_json.servos import OUTPUTS
from ..core.algebra import euler_of
from ..core.array_kernels import Kernel
from ..core.border import Actuators, Sensors
from ..core.constants import TICK_US
from ..core.decimals import DOT, write_digits, write_number, write_whole
from ..core.elementary import atan2, hypot
from ..core.kernels import law
from ..core.memory import Bytes, bytes_at, call_unit, floats_at, ints_at, record_at
from ..core.records import Floats, Ints, Record, array
from ..core.scalars import wrap_pi
from ..core.system_call import call_system
from ..physics.native.records import Body, Obstacles, Wind

LINE_SIZE = 1024
"""Space for a line, and for a datagram of an autopilot."""
DATAGRAMS = 6
"""As many are read at once."""
MOTION = 10
"""Position, attitude (w x y z), velocity."""
MAGIC_16, MAGIC_32 = 18458, 29569
SIZE_16, SIZE_32 = 40, 72
"""Bytes of a frame with so many pulses."""

PIECES = (
    b',"imu":{"gyro":[', b",", b",", b'],"accel_body":[', b",", b",", b']},"position":[', b",", b",",
    b'],"quaternion":[', b",", b",", b",", b'],"velocity":[', b",", b",",
    b',"attitude":[', b",", b",", b'],"rng_1":',
    b',"windvane":{"direction":', b',"speed":', b',"battery":{"voltage":', b',"current":',
    b'\n{"timestamp":', b"]", b"}", b"}}\n",
)  # fmt: skip
"""Text of a line: that before each number but the time, and the rest of it. ArduPilot looks for keys from the front:
none is part of one before it.

The attitude as roll, pitch, yaw comes with a range only. Of both attitudes ArduPilot takes the quaternion; but 4.7-dev
of December 2025 looks at the bit of "attitude" to see whether "rng_1" came (SIM_JSON.cpp; three keys were put before
both in its table), and does not arm without a range from a sensor that it has.
"""
_POSITION, _ATTITUDE, _VELOCITY, _EULER, _RANGE, _VANE, _SPEED, _BATTERY, NUMBERS = 6, 9, 13, 16, 19, 20, 21, 22, 24
_BEGIN, _END_OF_MOTION, _END_OF_VANE, _END = range(NUMBERS, NUMBERS + 4)
BEGIN, NOTE, REPORT, CONVERSE = range(4)
"""What ``act`` does."""
WAITS, ASKED, STEPS = range(3)
"""Of a step: nobody has asked for one; a frame has; it has begun."""
IS_ASKED, IS_DUE, IS_SILENT, IS_ODD, IS_ANSWERED = range(5)
"""How ``converse`` ends: a step is asked for beyond the time or the answers that are allowed; a sensor of a world has
to measure before the step can go on; nothing came; datagrams came that are Python's to judge; the one was given."""
MMSGHDR, MSGHDR_LENGTH = 8, 7
"""Words of 8 bytes of a ``struct mmsghdr`` of 64-bit Linux, and which of them has the length of the datagram."""
NAME_SIZE = 16
"""Bytes of a sender's address."""
WAIT_FOR_ONE = 0x10000
"""MSG_WAITFORONE: what else is there comes with the first."""


class Exchange(Record):
    """An exchange with one autopilot, and where all that it needs is."""

    # the vehicle's record
    records: int  # addresses
    vehicles: int
    index: int
    clock: int
    body: int
    actuators: int
    sensors: int
    wind: int
    obstacles: int
    is_reversible: bool  # outputs are servos and wheels
    range_max: float  # of the rangefinder [m]; 0: there is none
    # the step
    stage: int  # WAITS, ASKED or STEPS
    rate: int  # that it asks for [Hz]
    pulses: Ints = array(OUTPUTS, stored="i8")
    left: int  # ticks of the step that are still to do
    parts: int  # lines of it
    has_range: bool
    has_vane: bool
    before: int  # address of the body's motion at its last tick's beginning, MOTION numbers
    numbers: int  # address of NUMBERS numbers of a line
    # the lines
    pieces: int  # address of PIECES, one after the other
    piece_at: Ints = array(len(PIECES) + 1, stored="i8")
    lines: int  # address of MOST_LINES buffers
    vectors: int  # of as many struct iovec: address and length of a line
    # what ``converse`` needs besides
    step: int  # addresses of units
    list_near: int
    ranging: int
    measure_us: int  # when a sensor of a world measures next
    receive: int  # addresses of recvmmsg, sendmmsg
    send: int
    socket: int
    inbox: int  # address of DATAGRAMS struct mmsghdr
    outbox: int  # of MOST_LINES
    names: int  # of senders' addresses, 16 bytes each
    frames: int  # of datagrams
    peer: int  # first 8 bytes of the address of the autopilot that is served
    count: int  # of its last frame
    ahead: int  # lines that were sent before the frames that they answer
    first: int  # count of the frame that was stepped last
    until_us: int
    answers: int  # that may still be given
    is_single: bool  # only one answer is given, and nothing is waited for
    received: int  # datagrams
    judged: int  # of them; the others are Python's


@law
def actuate(x: Exchange) -> None:
    """Put the pulses that were asked for [us] into the record: -1 .. 1 of a servo or a wheel, 0 .. 1 of a rotor, 0
    without a pulse."""
    actuators = record_at(Actuators, x.actuators)
    for k in range(OUTPUTS):
        pulse = x.pulses[k]
        value = 0.0
        if pulse != 0:
            if x.is_reversible:
                value = min(max((pulse - 1500.0) / 500.0, -1.0), 1.0)
            else:
                value = min(max((pulse - 1000) * 0.001, 0.0), 1.0)
        actuators.controls[k] = value
        actuators.pwm[k] = pulse


@law
def write_motion(x: Exchange, numbers: Floats, at: int) -> None:
    """Write where the body is now: position, attitude, velocity."""
    body = record_at(Body, x.body)
    pos, q, vel = body.pos, body.q, body.vel
    numbers[at], numbers[at + 1], numbers[at + 2] = pos.x, pos.y, pos.z
    numbers[at + 3], numbers[at + 4], numbers[at + 5], numbers[at + 6] = q.w, q.x, q.y, q.z
    numbers[at + 7], numbers[at + 8], numbers[at + 9] = vel.x, vel.y, vel.z


@law
def _piece(x: Exchange, text: Bytes, at: int, number: int) -> int:
    """Write one of PIECES."""
    first, last = x.piece_at[number], x.piece_at[number + 1]
    piece = bytes_at(x.pieces + first, last - first)
    for k in range(last - first):
        text[at + k] = piece[k]
    return at + last - first


@law
def write_time(text: Bytes, at: int, time_us: int) -> int:
    """Write a time in seconds, fast by 1e-9.

    ArduPilot adds each difference of two timestamps to a clock of whole microseconds and cuts off the rest: with
    differences a rounding error below 2500 us it would lose a microsecond now and then. The lead, a microsecond in
    1000 s, outweighs rounding.
    """
    whole = time_us // 1_000_000
    femtoseconds = (time_us - 1_000_000 * whole) * 1_000_000_000 + time_us
    if femtoseconds >= 1_000_000_000_000_000:
        whole, femtoseconds = whole + 1, femtoseconds - 1_000_000_000_000_000
    at = write_whole(text, at, whole)
    text[at] = DOT
    return write_digits(text, at + 1, femtoseconds, 15)


@law
def gather(x: Exchange) -> None:
    """Find the numbers of the tick's last line."""
    body, sensors, wind = record_at(Body, x.body), record_at(Sensors, x.sensors), record_at(Wind, x.wind).vel
    numbers, rates, force, vel = floats_at(x.numbers, NUMBERS), body.rates_mean, body.specific_force, body.vel
    numbers[0], numbers[1], numbers[2] = rates.x, rates.y, rates.z
    numbers[3], numbers[4], numbers[5] = force.x, force.y, force.z
    write_motion(x, numbers, _POSITION)
    euler = euler_of(body.q)
    numbers[_EULER], numbers[_EULER + 1], numbers[_EULER + 2] = euler.roll, euler.pitch, euler.yaw
    numbers[_RANGE] = min(float(sensors.rangefinder_range[0]), x.range_max + 1.0)  # out of range: farther than it sees
    if wind.x != 0.0 or wind.y != 0.0 or wind.z != 0.0:
        north, east = vel.x - wind.x, vel.y - wind.y
        numbers[_VANE], numbers[_SPEED] = wrap_pi(atan2(east, north) - euler.yaw), hypot(north, east)
        x.has_vane = True
    else:
        x.has_vane = False
    x.has_range = sensors.rangefinder_count > 0 and x.range_max > 0.0
    numbers[_BATTERY], numbers[_BATTERY + 1] = sensors.battery_voltage, sensors.battery_current


@law
def write_line(x: Exchange, text: Bytes, time_us: int, share: float) -> int:
    """Write a line of a time between the tick's beginning (``share`` 0) and end; gives its length."""
    numbers, was = floats_at(x.numbers, NUMBERS), floats_at(x.before, MOTION)
    at = write_time(text, _piece(x, text, 0, _BEGIN), time_us)
    for n in range(NUMBERS):
        if n == _EULER:
            at = _piece(x, text, at, _END_OF_MOTION)
        if (_EULER <= n <= _RANGE and not x.has_range) or (_RANGE < n < _BATTERY and not x.has_vane):
            continue
        number = numbers[n]
        if _POSITION <= n < _EULER:
            number = (1.0 - share) * was[n - _POSITION] + share * number
        at = write_number(text, _piece(x, text, at, n), number)
        if n == _SPEED:
            at = _piece(x, text, at, _END_OF_VANE)
    return _piece(x, text, at, _END)


@law
def report(x: Exchange) -> None:
    """Write the last tick as ``parts`` lines, each at its LINE_SIZE of ``lines``, and their lengths into ``vectors``.

    The last line is the state at the end of the tick. Those before it are on the straight way there; rates and force
    are the tick's means in all of them, so that an IMU that sums them up gets the same. In a line, what ArduPilot needs
    comes first; a range is told after the first reading, and a vane when there is wind.
    """
    gather(x)
    now_us, vectors = ints_at(x.clock, 1)[0], ints_at(x.vectors, 2 * MOST_LINES)
    for k in range(1, x.parts + 1):
        text = bytes_at(x.lines + (k - 1) * LINE_SIZE, LINE_SIZE)
        vectors[2 * k - 1] = write_line(x, text, now_us - TICK_US + k * TICK_US // x.parts, k / x.parts)


@law
def begin(x: Exchange) -> None:
    """Begin the step that is asked for."""
    actuate(x)
    x.left = max(min(ticks(x.rate), (x.until_us - ints_at(x.clock, 1)[0]) // TICK_US), 1)
    x.parts = lines(x.rate)
    x.stage = STEPS


@law
def finish(x: Exchange) -> None:
    """The step is done: answer it."""
    report(x)
    call_system(x.send, x.socket, x.outbox, x.parts, 0, 0)  # one that is lost is asked for again
    x.first, x.ahead, x.stage = x.count, x.parts - 1, WAITS
    x.answers -= 1


@law
def judge(x: Exchange) -> bool:
    """Take what was received, up to a frame that asks for a step; False: there is something else before."""
    inbox, names = ints_at(x.inbox, MMSGHDR * DATAGRAMS), ints_at(x.names, 2 * DATAGRAMS)
    while x.judged < x.received:
        k = x.judged
        size = inbox[MMSGHDR * k + MSGHDR_LENGTH] & 0xFFFFFFFF
        frame = bytes_at(x.frames + k * LINE_SIZE, SIZE_32)
        magic = frame[0] | frame[1] << 8
        if not ((size == SIZE_16 and magic == MAGIC_16) or (size == SIZE_32 and magic == MAGIC_32)):
            return False
        count = frame[4] | frame[5] << 8 | frame[6] << 16 | frame[7] << 24
        if names[2 * k] != x.peer or count != (x.count + 1) & 0xFFFFFFFF:
            return False
        if x.ahead == 0 and k + 1 < x.received:  # it does not go on before it is answered
            return False
        x.judged += 1
        x.count = count
        if x.ahead > 0:
            x.ahead -= 1
            continue
        x.rate = frame[2] | frame[3] << 8
        for n in range(OUTPUTS):
            x.pulses[n] = frame[8 + 2 * n] | frame[9 + 2 * n] << 8
        x.stage = ASKED
    return True


@law
def listen(x: Exchange) -> bool:
    """Wait for datagrams; whether there are any."""
    inbox = ints_at(x.inbox, MMSGHDR * DATAGRAMS)
    for k in range(DATAGRAMS):
        inbox[MMSGHDR * k + 1] = NAME_SIZE
    x.judged = 0
    x.received = max(call_system(x.receive, x.socket, x.inbox, DATAGRAMS, WAIT_FOR_ONE, 0), 0)
    return x.received > 0


@law
def converse(x: Exchange) -> int:
    """Step and answer until something else is due (IS_ASKED)."""
    clock, obstacles = ints_at(x.clock, 1), record_at(Obstacles, x.obstacles)
    while True:
        if x.stage == ASKED:
            if clock[0] >= x.until_us or x.answers <= 0:
                return IS_ASKED
            begin(x)
        if x.stage == STEPS:
            while x.left > 0:
                if obstacles.wanted:
                    call_unit(x.list_near, x.records, x.vehicles, x.index, x.ranging, 0, 0)
                if x.left == 1:
                    write_motion(x, floats_at(x.before, MOTION), 0)
                call_unit(x.step, x.records, x.vehicles, x.index, 0, 0, 0)
                x.left -= 1
                if x.measure_us <= clock[0]:
                    return IS_DUE
            finish(x)
            if x.is_single:
                return IS_ANSWERED
        if not listen(x):
            return IS_SILENT
        if not judge(x):
            return IS_ODD


@law
def act(exchange: int, deed: int) -> int:
    """One of BEGIN, NOTE, TELL, CONVERSE of the ``Exchange`` at an address; gives what ``converse`` does."""
    x = record_at(Exchange, exchange)
    if deed == BEGIN:
        begin(x)
    elif deed == NOTE:
        write_motion(x, floats_at(x.before, MOTION), 0)
    elif deed == REPORT:
        report(x)
    else:
        return converse(x)
    return 0


acted = Kernel(act, lets_others_run=True)
