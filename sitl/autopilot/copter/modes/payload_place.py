# SPDX-License-Identifier: BSD-3-Clause
"""AUTO's PAYLOAD_PLACE: to the position at the present height, down until the load stands, release, up again.

The load stands when the descent needs less thrust than before: below PLDP_THRESH times the least of its first two
seconds, for half a second. Then the gripper opens, and after PLDP_DELAY the vehicle climbs to where the descent began.
https://ardupilot.org/copter/docs/common-mission-command-list.html#nav-payload-place
"""

from __future__ import annotations

from ....core.kernels import law
from ....core.mavlink import MavSeverity
from ...control.shaping import Motion
from ...events import Event, Events, emit, emit_and_return
from ...navigation.state import COMMAND_ARRIVED, NAV_COMMAND, Nav
from ...terrain.ground import by_range
from ..control import altitude, altitude_start
from ..control.spool import DesiredSpoolState
from ..navigation import waypoint
from ..parameters import Parameters
from ..state import Vehicle
from . import auto_yaw, descent, ground, precision_land
from .state import PayloadPlaceState

# Stages (``PayloadPlaceState.stage``)
FLYING, STARTING, DESCENDING, RELEASING, OPENING, WAITING, CLIMB_STARTS, CLIMBING, DONE = range(9)

# The gripper (``PayloadPlaceState.gripper``)
NO_GRIPPER, HOLDS, OPEN = range(3)

# What it did (PAYLOAD_PLACE_DID)
LANDED, ABORTED, BY_HAND, AT_LIMIT, NO_RANGE, PLACED, RELEASED = range(7)
_TEXTS: dict[int, str | tuple[int, str]] = {
    LANDED: "PayloadPlace: landed",
    ABORTED: "PayloadPlace: Abort: Gripper Open",
    BY_HAND: "PayloadPlace: Manual release",
    AT_LIMIT: (MavSeverity.WARNING, "PayloadPlace: Reached maximum descent"),
    NO_RANGE: (MavSeverity.WARNING, "PayloadPlace: PLDP_RNG_MAX set and rangefinder not enabled"),
    PLACED: "PayloadPlace: payload release thrust threshold: {b:f}",
    RELEASED: "PayloadPlace: Releasing the gripper",
}
PAYLOAD_PLACE_DID = Event(77, MavSeverity.INFO, _TEXTS)

STEADY = 0.95
"""Of the descent's speed: from then on its thrust counts."""
LEARNS_US, PLACED_US = 2_000_000, 500_000
"""So long the descent's thrust is learnt; so long the load has to stand."""
ARRIVING = 0.1
"""Part of the climb's speed from which the way to a stop may be left out."""


@law
def begin(v: Vehicle) -> None:
    """Begin the command that the shell has written."""
    ap = v.autopilot
    ap.modes.payload_place.speed = 0.0
    if ap.modes.nav.has_target:
        ap.modes.payload_place.stage = FLYING
    else:
        start_descent(v)


@law
def start_descent(v: Vehicle) -> None:
    """Prepare the descent where it is."""
    ap = v.autopilot
    ground.set_waypoint_limits(ap.control, ap.params)
    ground.continue_position_control(ap.control, ap.estimate, ap.params)
    auto_yaw.set_mode(ap.modes.auto_yaw, auto_yaw.HOLD, ap.control.attitude, ap.estimate)
    ap.modes.payload_place.stage = STARTING


@law
def run(v: Vehicle) -> bool:
    """One tick; whether the load is placed and the vehicle up again."""
    ap = v.autopilot
    modes, control, est, p = ap.modes, ap.control, ap.estimate, ap.params
    payload = modes.payload_place
    if ground.is_grounded(ap.arming):
        ground.rest(ap.arming.armed, control, est, p)
        return False
    control.motors.desired_spool = DesiredSpoolState.THROTTLE_UNLIMITED
    if ap.arming.landed_maybe and payload.stage == DESCENDING:
        say(ap.events, v.time_us, LANDED, 0.0)
        payload.stage = RELEASING
    if payload.gripper == OPEN:
        note_open(payload, ap.events, v.time_us, control.pos_d.pos_desired)
    if payload.stage == FLYING and modes.nav.reached:
        start_descent(v)
    if payload.stage == FLYING:
        waypoint.advance(modes.nav, control, est, p, v.time_us)
        ground.fly(modes.auto_yaw, control, est, p)
        return False
    if payload.stage == STARTING:
        begin_descent(payload, v.time_us, control.pos_d.pos_desired, p)
    if payload.stage == DESCENDING:
        watch_descent(v)
    elif payload.stage >= RELEASING:
        release(v)
    fly(v)
    return payload.stage == DONE


@law
def say(events: Events, time_us: int, did: int, number: float) -> None:
    """Report to the shell."""
    emit(events, time_us, PAYLOAD_PLACE_DID, float(did), number)


@law
def note_open(payload: PayloadPlaceState, events: Events, time_us: int, d: float) -> None:
    """The gripper is open already: the load is gone; ``d``: height wanted, NED [m]."""
    if payload.stage == FLYING or payload.stage == STARTING:
        say(events, time_us, ABORTED, 0.0)
        payload.start_d = d
        payload.stage = DONE
    elif payload.stage == DESCENDING:
        say(events, time_us, BY_HAND, 0.0)
        payload.stage = RELEASING


@law
def begin_descent(payload: PayloadPlaceState, time_us: int, d: float, p: Parameters) -> None:
    """Down from a height wanted, NED [m]."""
    payload.established_us = time_us
    payload.start_d = d
    wanted = p.PLDP.SPEED_DN if p.PLDP.SPEED_DN > 0.0 else abs(p.LAND.SPEED) * 0.01
    payload.speed = min(wanted, abs(p.WPNAV.SPEED_DN) * 0.01)
    payload.thrust = 1.0
    payload.stage = DESCENDING


@law
def watch_descent(v: Vehicle) -> None:
    """Learn the thrust of a steady descent, then look for less: the load stands."""
    ap, time_us = v.autopilot, v.time_us
    payload, path, p = ap.modes.payload_place, ap.control.pos_d, ap.params.PLDP
    thrust = ap.control.attitude.throttle_in
    if payload.limit > 0.0 and path.pos_desired - payload.start_d > payload.limit:
        say(ap.events, time_us, AT_LIMIT, 0.0)
        payload.stage = CLIMB_STARTS
    elif path.vel_desired < STEADY * payload.speed:
        payload.established_us = time_us
    elif time_us - payload.established_us < LEARNS_US:
        payload.thrust = min(payload.thrust, thrust)
        payload.placed_us = time_us
    elif thrust > p.THRESH * payload.thrust:
        payload.placed_us = time_us
    elif p.RNG_MAX > 0.0 and v.sensors.rangefinder_count == 0:
        say(ap.events, time_us, NO_RANGE, 0.0)
        payload.stage = CLIMB_STARTS
    elif p.RNG_MAX > 0.0 and is_high(v, p.RNG_MAX):
        payload.placed_us = time_us
    elif time_us - payload.placed_us > PLACED_US:
        say(ap.events, time_us, PLACED, p.THRESH * payload.thrust)
        payload.stage = RELEASING


@law
def is_high(v: Vehicle, limit: float) -> bool:
    """Whether the rangefinder sees the ground further down than a limit [m]."""
    ap = v.autopilot
    found = by_range(float(v.sensors.rangefinder_range[0]), ap.control.attitude.cos_lean, ap.estimate.pos.z)
    return found.is_known and found.d - ap.estimate.pos.z > limit


@law
def release(v: Vehicle) -> None:
    """One tick from the load's touch-down on: open the gripper, wait, climb."""
    ap, time_us = v.autopilot, v.time_us
    payload, path = ap.modes.payload_place, ap.control.pos_d
    if payload.stage == RELEASING:
        altitude_start.init_d_no_descent(ap.control, ap.estimate, ap.params)
        if payload.gripper == NO_GRIPPER:
            payload.stage = WAITING
        else:
            say(ap.events, time_us, RELEASED, 0.0)
            ask_to_open(ap.modes.nav, ap.events, time_us)
            payload.stage = OPENING
        return
    if payload.stage == OPENING and payload.gripper != HOLDS:
        payload.stage = WAITING
    if payload.stage == WAITING and time_us - payload.placed_us >= PLACED_US + int(ap.params.PLDP.DELAY * 1e6):
        payload.stage = CLIMB_STARTS
    if payload.stage == CLIMB_STARTS:
        payload.stage = CLIMBING
    if payload.stage == CLIMBING:
        speed = ARRIVING * path.speed_up
        if path.pos_desired <= payload.start_d + 0.5 * speed * speed / path.accel_max:
            payload.stage = DONE


@law
def ask_to_open(nav: Nav, events: Events, time_us: int) -> None:
    """The shell opens the gripper (``mission.CopterCommands.arrived``)."""
    emit_and_return(events, time_us, COMMAND_ARRIVED, NAV_COMMAND, float(nav.command_count))


@law
def fly(v: Vehicle) -> None:
    """Position controllers of this tick: over the position, down, at rest, or up."""
    ap = v.autopilot
    payload, path = ap.modes.payload_place, ap.control.pos_d
    precision_land.hold_position(v, descent.stick_velocity(ap.modes.pilot, ap.estimate.yaw, ap.params))
    if payload.stage <= DESCENDING:
        altitude.land_at_rate_d(path, payload.speed, True)
    elif payload.stage < CLIMBING:
        altitude.land_at_rate_d(path, 0.0, False)
    else:
        altitude.input_pos_vel_accel_d(path, Motion(payload.start_d, 0.0, 0.0))
    ground.fly(ap.modes.auto_yaw, ap.control, ap.estimate, ap.params)
