# SPDX-License-Identifier: BSD-3-Clause
"""From power-on until an episode may begin: armed, in GUIDED, a copter in the air. It sees only telemetry.

A reset disarms by force and reboots, whatever the vehicle is doing: in the air it would fall. Only a vehicle that
proves to be a simulator (``sitl.client.proof``) is reset without a user's word.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from sitl.client.commands import command_number
from sitl.client.connection import TRIES, Connection
from sitl.core.mavlink import ARM_FORCED, MavModeFlag, MavResult
from sitl.core.sums import lengths
from sitl.errors import LinkLostError, NotASimulatorError, NotReadyError

from .last_messages import ATTITUDE, GLOBAL, LANDED_STATE, ORIGIN, POSITION, SCAN, SECTORS
from .reports import LANDED

_REBOOT = command_number("PREFLIGHT_REBOOT_SHUTDOWN")
INTERVAL_US = 100_000
"""Of position, attitude and scan after ``prepare``."""
_LEAST_US = 20_000
"""An interval that a vehicle may lengthen to twice of it, whatever is asked for [us]."""
ALIGN_US = 6_000_000
"""An episode begins at a whole multiple of it since boot, so that messages fall due at the ends of all usual steps."""
_SECOND, _TENTH = 1_000_000, 100_000
_PATIENCE_S = 90
_LOOK, _ANSWER_LOOKS = 20_000, 25
"""Wall time between two looks for a message that was asked for [us], and their number."""


LEARNED = "MOT_THST_HOVER"
"""A parameter that a copter changes by itself in flight and keeps: it is put back, so that episodes are alike."""
_REAL_4 = 9
"""MAV_PARAM_TYPE_REAL32"""


def reboot(link: Connection) -> None:
    """Disarm and restart the vehicle.

    Raises:
        NotReadyError: it refuses.
        LinkLostError: it does not come back.
    """
    link.command("COMPONENT_ARM_DISARM", arm=0, force=ARM_FORCED)
    name = {"target_system": link.inbox.system, "target_component": 1, "param_id": LEARNED.encode()}
    if not link.inbox.was_rebooted:
        link.endpoint.send("PARAM_REQUEST_READ", param_index=-1, **name)
        link.pause(0 if link.is_exact else _SECOND)
        link.inbox.learned = link.inbox.parameters.get(LEARNED)
        link.inbox.was_rebooted = True
    elif link.inbox.learned is not None:
        link.endpoint.send("PARAM_SET", param_value=link.inbox.learned, param_type=_REAL_4, **name)
    link.inbox.acks.pop(_REBOOT, None)
    try:
        result = link.command("PREFLIGHT_REBOOT_SHUTDOWN", autopilot=1)
        if result == MavResult.ACCEPTED:
            link.pause(0 if link.is_exact else 2 * _SECOND)
    except LinkLostError:  # an ArduPilot's simulator closes its TCP port; its last word may be the answer
        answer = link.inbox.acks.get(_REBOOT)
        if answer is None or not link.reopen():
            raise
        result = int(answer.result)
    if result != MavResult.ACCEPTED:
        raise NotReadyError(f"{link.name}: the vehicle refuses to reboot (MAV_RESULT {result}), so it cannot be reset")
    link.inbox.forget()


def set_intervals(link: Connection, interval_us: int) -> None:
    """Ask for position, attitude, scan and what else is wanted at an interval.

    A vehicle that knows nothing of whole scans (a real one) is asked for OBSTACLE_DISTANCE: centimetres, 72 sectors.
    One whose clock does not go exactly as far as it is told to may send at longer intervals, up to twice as long or
    40 ms: an ArduPilot with 50 loops a second sends a message each 25 ms, and not each 20 ms.

    Raises:
        NotReadyError: the vehicle does not send one of them so often.
    """
    telemetry = link.inbox
    scan = (telemetry.scan_kind,) if telemetry.scans_by_mavlink and telemetry.scans_used else ()
    if link.simulation is not None:
        link.simulation.bridge.is_stepped = True
    intervals = [interval_us] if link.is_exact else _longer_ones(interval_us)
    for kind in (POSITION, ATTITUDE, *scan, *telemetry.wanted):
        taken = next(
            (us for us in intervals if link.command("SET_MESSAGE_INTERVAL", kind.id, us) == MavResult.ACCEPTED), None
        )
        if taken is not None:
            intervals = intervals[intervals.index(taken) :]  # its loop is the same for the others
            continue
        result = None
        if kind is SCAN:
            link.inbox.scan_kind = kind = SECTORS
            result = link.command("SET_MESSAGE_INTERVAL", kind.id, interval_us)
        if result != MavResult.ACCEPTED:
            why = "; the environment's observation or task reads the lidar" if kind is SECTORS else ""
            raise NotReadyError(
                f"{link.name}: the vehicle does not send {kind.name} every {interval_us / 1000:g} ms{why}"
            )


def _longer_ones(interval_us: int) -> list[int]:
    """An interval, and those that do for a vehicle which cannot send so often [us]."""
    base = max(interval_us, _LEAST_US)
    return sorted({interval_us, *(base * k // 4 for k in (4, 5, 6, 8))})


def request_again(link: Connection) -> None:
    """Ask for position, attitude, scan and the rest as they are: those of this instant were lost on the way."""
    scan = (link.inbox.scan_kind,) if link.inbox.scans_used else ()
    for kind in (POSITION, ATTITUDE, *scan, *link.inbox.wanted):
        link.command("REQUEST_MESSAGE", kind.id)


def mode_parameters(number: int) -> tuple[int, int, int]:
    """Parameters of DO_SET_MODE for a mode, by the ``custom_mode`` of its HEARTBEAT: a number, as ArduPilot has them,
    or a main mode in the third byte and one below it in the fourth, as PX4 has them."""
    if number < 1 << 16:
        return MavModeFlag.CUSTOM_MODE_ENABLED, number, 0
    return MavModeFlag.CUSTOM_MODE_ENABLED, number >> 16 & 0xFF, number >> 24 & 0xFF


def set_mode(link: Connection, number: int) -> None:
    """Change the flight mode.

    Raises:
        NotReadyError: it refuses.
    """
    if link.command("DO_SET_MODE", *mode_parameters(number)) != MavResult.ACCEPTED:
        raise NotReadyError(f"{link.name}: the vehicle refuses mode {number}; {last_texts(link)}")


def set_bit(link: Connection, name: str, bit: int, may_change: bool) -> None:
    """See to it that a bit of a parameter is set.

    Args:
        link: to the vehicle.
        name: of the parameter.
        bit: its value.
        may_change: whether the vehicle is ours to change; else it must be so already.

    Raises:
        NotReadyError: it is not, and cannot be set.
    """
    value = link.parameter(name)
    if value is not None and int(value) & bit:
        return
    if may_change and value is not None:
        wanted = float(int(value) | bit)
        target = {"target_system": link.inbox.system, "target_component": 1}
        link.endpoint.send("PARAM_SET", param_id=name.encode(), param_value=wanted, param_type=_REAL_4, **target)
        if link.parameter(name) == wanted:
            return
    raise NotReadyError(f"{link.name}: {name} is {value}; these set-points need its bit {bit}: set it on the vehicle")


def prepare(link: Connection, guided: int, take_off: float, hold_sticks: Callable[[], None]) -> None:
    """Everything from power-on until the vehicle stands armed in GUIDED, or hovers there.

    Args:
        link: to a vehicle that has just booted.
        guided: number of the mode GUIDED.
        take_off: height above its home [m], 0: none.
        hold_sticks: sends RC overrides of sticks at rest.

    Raises:
        NotReadyError: it does not get there; the message says what the vehicle said.
    """
    inbox = link.inbox
    link.endpoint.send("REQUEST_DATA_STREAM", target_system=inbox.system, target_component=1)  # stop all
    set_intervals(link, INTERVAL_US)

    def arms() -> bool:
        if (
            math.isnan(inbox.position[1])
            or link.command("DO_SET_MODE", MavModeFlag.CUSTOM_MODE_ENABLED, guided) != MavResult.ACCEPTED
        ):
            return False
        return link.command("COMPONENT_ARM_DISARM", arm=1) == MavResult.ACCEPTED

    until(link, arms, _SECOND, "does not arm")
    if take_off > 0.0:
        floor = inbox.position[3]  # home is where it is armed, which is not the origin of local positions
        if link.command("NAV_TAKEOFF", altitude=take_off) != MavResult.ACCEPTED:
            raise NotReadyError(f"{link.name}: the vehicle refuses to take off; {last_texts(link)}")
        until(link, lambda: abs(inbox.position[3] - floor + take_off) < 0.1 and abs(inbox.position[6]) < 0.1, _TENTH,
               f"does not climb to {take_off:g} m")  # fmt: skip
    for _ in range(3):  # it may be lost on the way
        if inbox.origin is None:
            link.command("REQUEST_MESSAGE", ORIGIN.id)
    if inbox.origin is None:
        raise NotReadyError(f"{link.name}: the vehicle does not send GPS_GLOBAL_ORIGIN")
    if link.is_exact:
        link.run((-1000 * int(inbox.position[0]) - _TENTH) % ALIGN_US)
    hold_sticks()
    scans = inbox.scans
    link.run(_TENTH)
    if inbox.scans == scans and inbox.scans_used:
        wanted = "LASER in DEBUG_FLOAT_ARRAY, or OBSTACLE_DISTANCE"
        raise NotReadyError(f"{link.name}: the vehicle sends no scan ({wanted})")
    check_reports(link)


def check_reports(link: Connection) -> None:
    """After some time with all intervals set.

    Raises:
        NotReadyError: the vehicle took a wish for a message, and has not sent it.
    """
    for kind in link.inbox.wanted:
        if kind not in link.inbox.reported:
            raise NotReadyError(f"{link.name}: the vehicle takes the wish for {kind.name}, but sends none: has it "
                                "what that message tells?")  # fmt: skip


def join(link: Connection, guided: int, flies: bool, seconds: float) -> None:
    """Wait until somebody has brought the vehicle to where an episode can begin: armed, in GUIDED, almost at rest, a
    copter in the air. It is told nothing but what it is to send.

    Raises:
        NotReadyError: it is not there in time; the message says what is missing.
    """
    inbox = link.inbox
    set_intervals(link, INTERVAL_US)
    link.command("REQUEST_MESSAGE", ORIGIN.id)

    def missing() -> str:
        if inbox.armed and inbox.mode != guided:
            return f"it is in mode {inbox.mode}, not in GUIDED ({guided})"
        return not_ready(link, flies)

    for _ in range(max(round(seconds / 0.1), 1)):
        link.pause(_TENTH)
        if not missing():
            check_reports(link)
            return
    raise NotReadyError(f"{link.name}: no episode can begin within {seconds:g} s: {missing()}; {last_texts(link)}")


def not_ready(link: Connection, flies: bool) -> str:
    """What a vehicle that somebody else has brought up lacks for an episode, whatever its mode; "": nothing."""
    inbox = link.inbox
    speed = float(lengths(inbox.position[4:7]))
    if math.isnan(inbox.position[1]) or inbox.origin is None:
        return "it has no position"
    if not inbox.armed:
        return "it is disarmed"
    if flies and height_above_home(link) < AIRBORNE:
        return "it is on the ground"
    return f"it moves with {speed:.1f} m/s" if speed > AT_REST else ""


AIRBORNE, AT_REST = 0.5, 0.5
"""Least height above home [m] and greatest speed [m/s] at which an episode begins on a vehicle that flies already."""


def height_above_home(link: Connection) -> float:
    """[m], as the vehicle reports it now.

    Raises:
        NotReadyError: it does not report it.
    """
    inbox = link.inbox
    inbox.height = math.nan
    for _ in range(TRIES):
        link.command("REQUEST_MESSAGE", GLOBAL.id)
        for _ in range(1 if link.is_exact else _ANSWER_LOOKS):  # the acknowledgement may come before the message
            if not math.isnan(inbox.height):
                return float(inbox.height)
            link.pause(0 if link.is_exact else _LOOK)
    raise NotReadyError(f"{link.name}: the vehicle does not send GLOBAL_POSITION_INT, so its height is not known")


def has_landed(link: Connection) -> bool:
    """Whether the vehicle says now that it is on the ground; False of one that does not say."""
    reports = link.inbox.reports
    reports[LANDED] = 0.0  # unknown
    for _ in range(TRIES):
        if link.command("REQUEST_MESSAGE", LANDED_STATE.id) != MavResult.ACCEPTED:
            return False
        for _ in range(1 if link.is_exact else _ANSWER_LOOKS):
            if reports[LANDED] != 0.0:
                return bool(link.inbox.landed)
            link.pause(0 if link.is_exact else _LOOK)
    return False


def until(
    link: Connection,
    done: Callable[[], bool],
    every_us: int,
    complaint: str,
    seconds: int = _PATIENCE_S,
    between: Callable[[], None] = lambda: None,
) -> None:
    """Let time go by until ``done()``; ``between``: called before each step.

    Raises:
        NotReadyError: not within so many seconds.
    """
    for _ in range(seconds * _SECOND // every_us):
        if done():
            return
        between()
        link.pause(every_us)
    raise NotReadyError(f"{link.name}: the vehicle {complaint} within {seconds} s; {last_texts(link)}")


def last_texts(link: Connection) -> str:
    """What the vehicle has said last, for messages."""
    return "it said: " + "; ".join(link.inbox.last_texts[-4:]) if link.inbox.last_texts else "it said nothing"


REBOOT, BY_FORCE, NONE, RETURN = "reboot", "force", "none", "return"
RESETS = (REBOOT, BY_FORCE, NONE, RETURN)
"""Values of the option ``reset``: reboot only what proves to be a simulator; reboot whatever answers; wait until the
vehicle is where an episode can begin; fly or drive back to where the first one began."""


def refusal(link: Connection) -> NotASimulatorError:
    """The error for a vehicle that has not proved to be a simulator."""
    inbox: Any = link.inbox
    mode = f"{'armed' if inbox.armed else 'disarmed'}, in mode {inbox.mode}" if inbox.mode >= 0 else "no HEARTBEAT yet"
    return NotASimulatorError(
        f"connection {link.name}: the vehicle (system {inbox.system}, {mode}) does not prove to be a simulator: "
        f"{link.doubt}. For this reset nothing was sent that disarms, reboots or moves it. It would be disarmed by "
        "force and rebooted, in the air, too: that is done to simulators only (sitl run, ArduPilot's SITL). For a "
        f'vehicle that may be treated so, whatever it is: reset="{BY_FORCE}" when the environment is made. One that '
        f'flies is taken over where it is with reset="{NONE}" or "{RETURN}"'
    )
