# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one tick: sticks, mode, landing and crash detection, failsafes."""

from __future__ import annotations

from ....core.kernels import law, unit
from ....core.records import Records
from ... import battery, home
from ...modes import REASON_INITIALISED
from ...radio import RC_TICKS
from .. import arming, crash, failsafe, landing, motor_test, pilot
from ..control.motors import hover_throttle, learn_hover_throttle
from ..control.state import DT
from ..state import Vehicle
from . import ground, set_mode, switch, table
from .stabilize import STABILIZE

_TENTH = 40  # ticks
_QUARTER = 100
_LEARN_TICKS = 4
_LEARN_COS_LEAN = 0.9962  # 5 degrees
_LEARN_SPEED = 0.6  # [m/s]


@law
def init(v: Vehicle) -> None:
    """At boot, on a record of zeros with parameters set: on the ground, disarmed, in INITIAL_MODE."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if table.is_known(number) else STABILIZE
    ap.modes.previous = ap.modes.number
    ap.modes.reason = REASON_INITIALISED
    ap.arming.landed = True
    ap.arming.landed_maybe = True
    ap.battery.remaining_pct = -1.0
    pilot.init(v)


@unit
def update(fleet: Records[Vehicle], i: int) -> None:
    """One tick of vehicle ``i``: reads the estimate, writes targets of the controllers."""
    v = fleet[i]
    tick = v.tick
    if tick % RC_TICKS == 0:
        read_transmitter(v)
    if tick % _TENTH == 4:
        check_slowly(v)
    if tick % _QUARTER == 12:
        home.set_first(v.autopilot.home, v.autopilot.estimate)
        arming.run_prearm_checks(v)
    arming.follow_throttle(v)
    run_mode(v)
    motor_test.run(v)
    landing.detect(v)
    crash.check(v)
    landing.set_priority(v)
    if tick % _LEARN_TICKS == 0 and hovers(v):
        learn_hover_throttle(v.autopilot.params.MOT, v.autopilot.control.motors.throttle, _LEARN_TICKS * DT)


@law
def read_transmitter(v: Vehicle) -> None:
    """50 times a second."""
    pilot.read(v)
    failsafe.watch_radio(v)
    switch.read_mode(v)
    switch.read_rudder(v)


@law
def check_slowly(v: Vehicle) -> None:
    """Ten times a second."""
    battery.monitor(v.autopilot.battery, v.sensors, v.autopilot.params.BATT)
    failsafe.watch_gcs(v)
    failsafe.watch_battery(v)
    failsafe.watch_estimate(v)
    arming.disarm_idle(v)


@law
def run_mode(v: Vehicle) -> None:
    """The mode's own tick, then the change that it may have asked for."""
    ap = v.autopilot
    table.run(ap.modes.number, v)
    if ap.modes.wanted != 0:
        wanted = ap.modes.wanted - 1
        ap.modes.wanted = 0
        set_mode.request(v, wanted, ap.modes.wanted_reason)
    if not ap.arming.armed or ap.modes.arming_delay:
        ap.control.motors.desired_spool = ground.SHUT_DOWN


@law
def hovers(v: Vehicle) -> bool:
    """Whether the vehicle hovers level in a mode that holds height: its throttle is the hover throttle."""
    ap = v.autopilot
    if not ap.arming.armed or ap.arming.landed or table.has_manual_throttle(ap.modes.number):
        return False
    if abs(ap.control.pos_d.vel_desired) > 0.01 or abs(ap.estimate.vel.z) >= _LEARN_SPEED:
        return False
    if ap.control.attitude.cos_lean < _LEARN_COS_LEAN or ap.control.motors.throttle <= 0.0:
        return False
    return not landing.is_taking_off(v) and hover_throttle(ap.params.MOT) > 0.0
