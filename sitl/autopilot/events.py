# SPDX-License-Identifier: BSD-3-Clause
"""What the core tells the shell: a ring of (time, code, two numbers) in the record."""

from __future__ import annotations

from ..core.kernels import law
from ..core.records import Floats, Ints, Record, array

EVENT_RING = 64

# Codes. The shell turns them into STATUSTEXT, MISSION_ITEM_REACHED and log entries; a and b are the two numbers.
ARMED = 1  # a: method
DISARMED = 2  # a: method
MODE_CHANGED = 3  # a: number, b: reason
LANDED = 4
TAKEOFF_COMPLETE = 5
COMMAND_COMPLETE = 6  # the navigation command under way is done: the shell gives the next one
LEG_ENDING = 7  # the shell plans the following leg
CRASH_DISARM = 8  # a: angle error [deg]
GUIDED_TIMEOUT = 9
EKF_INITIALISED = 10  # a, here and below: IMU of the filter
EKF_TILT_ALIGNED = 11
EKF_YAW_ALIGNED = 12  # b: compass
EKF_ORIGIN_SET = 13
EKF_USES_GPS = 14
EKF_STOPPED_GPS = 15
EKF_YAW_ALIGNED_IN_FLIGHT = 16  # b: compass
HIT_GROUND = 17  # a: speed [m/s] (from physics)
FAILSAFE = 18  # a: which (failsafe.py), b: 1 on, 0 off
MODE_REFUSED = 19  # a: number, b: cause
ARMING_REFUSED = 20  # a and b: bits of the failed checks and method (arming_checks.refusal)
MOTOR_TEST = 21  # a: 1 begins, 0 has ended; b: motor
DESTINATION_REACHED = 22  # rover, end of a way home; a: mode
GUIDED_REACHED = 23  # rover: the position target of GUIDED
CRASH_HOLD = 24  # rover: crashed or blocked
PATH_LOST = 25  # SMART_RTL has no path any more; a: reason (smart_rtl_path.py)
CIRCLE_ADAPTED = 26  # rover; a: what (circle.py), b: the value now
COMMAND_ARRIVED = 27  # the navigation command under way is at its place, b: its count (nav.command_count)
HIT_OBSTACLE = 28  # a: speed [m/s] (from physics)
SETPOINT_IGNORED = 29  # rover: it has an acceleration; a: number of the MAVLink message
AUX_SWITCH = 30  # a: channel, b: position (aux_switch.py), negative the first one since boot
SIMPLE_CHANGED = 31  # copter; a: 0 off, 1 SIMPLE, 2 SUPER_SIMPLE
THROW_STAGE = 33  # copter; a: stage (throw.py)
ZIGZAG_DID = 34  # copter; a: what (zigzag.py), b: line of the sweep, 0 none
PATH_LOW = 35  # SMART_RTL: there is little room for its path
NO_WAY_BACK = 36  # copter: a failsafe cannot enter SMART_RTL, or (b: 1) AUTO_RTL; a: what it does (failsafe_actions.py)
THRUST_LOST = 40  # copter; a: motor 1 .. that seems to fail
TAKEOFF_BLOCKED = 41  # copter; a: why (takeoff_check.py)
FOLLOW_OFFSET = 42  # FOLLOW keeps the distance that it has; a: 1 in the lead's frame, 0 north, east, down
FOLLOW_OFF = 43  # FOLLOW was asked for while FOLL_ENABLE is 0
FENCE_BREACHED = 44  # a: bits of fences, b: 1 the pilot is told
FENCE_CLEAR = 45  # no fence is breached any more; b: 1 the pilot is told
FENCE_SWITCHED = 46  # a: bits of fences, b: how (fence/checks.py)
FENCE_NEAR = 47  # a: bits of fences, b: how far they are [m]; below zero: they are further than the margin again
FENCE_RECOVERY = 48  # the pilot brings the vehicle back behind the fence
RETURN_WANTED = 50  # copter, AUTO_RTL; a: way (navigation/state.py), b: 1 AUTO flies already
RETURN_ACTIVE = 51  # copter: it flies a part that brings it back already; a: which (navigation/state.py)
SYSTEM_ID_DID = 52  # copter; a: what (systemid.py), b: a number of it
SYSTEM_ID_SAMPLE = 53  # copter: a sample of SYSTEMID, for the log
CIRCLE_BEGINS = 59  # copter: the next circle of a mission's LOITER_TURNS; a: its number, b: how many
NO_WAY = 60  # there is no way around the areas of the fence
LANDING_TARGET_DID = 61  # a: what (landing_target/state.py)
DOCK_DID = 62  # rover; a: what (dock.py)
AUTOTUNE_DID = 63  # copter; a: what (autotune_gains.py), b: a number of it
YAW_IMBALANCE = 64  # copter; a: the integrator of the yaw rate loop
EKF_RELATIVE = 65  # the filter's position is relative to where it began; a: IMU
EKF_STOPPED_AIDING = 66  # a: IMU
EKF_USES = 67  # a: IMU, b: 1 optical flow, 2 another system's position, 3 its heading
EKF_LANE_SWITCHED = 68  # a: IMU whose filter is flown by now
EKF_EMERGENCY_YAW = 76  # a: IMU of the filter
EKF_COMPASS_CHANGED = 69  # a: IMU of the filter, b: compass
TERRAIN_DID = 70  # copter; a: what (terrain/state.py)
TERRAIN_LEFT = 71  # copter: it has left the square of the grid whose heights it knows
BATTERY_LOW, BATTERY_CRITICAL, BATTERY_MISSING = 80, 81, 82  # a: voltage, b: charge used [mAh]
BENDY_RULER_LOOKED = 72  # a: margin [m], b: 1 it steers, 3 and goes on as before
FENCE_LOADED = 73  # areas of the fence
RALLY_LOADED = 74  # rally points
PAYLOAD_PLACE_DID = 77  # copter; a: what (payload_place.py), b: a number of it
WAY_LAID = 75  # the way around areas has turns

FENCE_TEXTS = (FENCE_BREACHED, FENCE_CLEAR, FENCE_SWITCHED, FENCE_NEAR, FENCE_RECOVERY)


class Events(Record):
    """A ring of what happened, for the shell."""

    count: int  # events so far; event k is at k % EVENT_RING
    attention: bool  # the core returns to the shell at the end of this tick
    time_us: Ints = array(EVENT_RING, stored="i8")
    code: Ints = array(EVENT_RING, stored="i4")
    a: Floats = array(EVENT_RING)
    b: Floats = array(EVENT_RING)


@law
def emit(events: Events, time_us: int, code: int, a: float, b: float) -> None:
    """Append an event; the oldest is overwritten when the shell did not fetch it in time."""
    k = events.count % EVENT_RING
    events.time_us[k] = time_us
    events.code[k] = code
    events.a[k] = a
    events.b[k] = b
    events.count += 1


@law
def emit_and_return(events: Events, time_us: int, code: int, a: float, b: float) -> None:
    """Append an event that needs Python: the core returns to the shell at the end of this tick."""
    emit(events, time_us, code, a, b)
    events.attention = True
