# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one tick: sticks, mode, landing and crash detection, failsafes."""

from __future__ import annotations

from ....core.kernels import law, unit
from ... import battery, home
from ...modes import REASON_INITIALISED
from ...radio import RC_TICKS
from .. import arming, crash, failsafe, landing, motor_test, pilot
from ..control.motors import hover_throttle, learn_hover_throttle
from . import ground, set_mode, switch, table
from .stabilize import STABILIZE

_TENTH = 40  # ticks
_QUARTER = 100
_LEARN_TICKS = 4
_LEARN_COS_LEAN = 0.9962  # 5 degrees
_LEARN_SPEED = 0.6  # [m/s]


@law
def init(v):
    """At boot, on a record of zeros with parameters set: on the ground, disarmed, in INITIAL_MODE."""
    ap = v.autopilot
    number = int(ap.params.INITIAL_MODE)
    ap.modes.number = number if table.is_known(number) else STABILIZE
    ap.modes.previous = ap.modes.number
    ap.modes.reason = REASON_INITIALISED
    ap.arming.landed = 1
    ap.arming.landed_maybe = 1
    ap.battery.remaining_pct = -1.0
    pilot.init(v)


@unit
def update(fleet, i):
    """One tick of vehicle ``i``: reads the estimate, writes targets of the controllers."""
    v = fleet[i]
    tick = v.tick
    if tick % RC_TICKS == 0:
        read_transmitter(v)
    if tick % _TENTH == 4:
        check_slowly(v)
    if tick % _QUARTER == 12:
        home.set_first(v.autopilot.home, v.autopilot.estimate)
        arming.update(v)
    arming.update_armed(v)
    run_mode(v)
    motor_test.update(v)
    landing.update(v)
    crash.update(v)
    landing.update_mix(v)
    if tick % _LEARN_TICKS == 0:
        learn_hover(v)


@law
def read_transmitter(v):
    """50 times a second."""
    pilot.read(v)
    failsafe.update_radio(v)
    switch.read_mode(v)
    switch.read_rudder(v)


@law
def check_slowly(v):
    """Ten times a second."""
    ap = v.autopilot
    battery.monitor(ap.battery, v.sensors, ap.params.BATT)
    failsafe.update_gcs(v)
    failsafe.update_battery(v)
    failsafe.update_ekf(v)
    arming.update_delay(v)


@law
def run_mode(v):
    """The mode's own tick, then the change that it may have asked for."""
    ap = v.autopilot
    table.run(ap.modes.number, v)
    if ap.modes.wanted != 0:
        wanted = int(ap.modes.wanted) - 1
        ap.modes.wanted = 0
        set_mode.request(v, wanted, int(ap.modes.wanted_reason))
    if ap.arming.armed == 0 or ap.modes.arming_delay != 0:
        ap.control.motors.desired_spool = ground.SHUT_DOWN


@law
def learn_hover(v):
    """While hovering level in a mode that holds height: the throttle of this moment is the hover throttle."""
    ap = v.autopilot
    if ap.arming.armed == 0 or ap.arming.landed != 0 or table.has_manual_throttle(ap.modes.number):
        return
    if abs(ap.control.pos_d.vel_desired) > 0.01 or abs(ap.estimate.vel[2]) >= _LEARN_SPEED:
        return
    if ap.control.attitude.cos_lean < _LEARN_COS_LEAN or ap.control.motors.throttle <= 0.0:
        return
    if landing.is_taking_off(v) or hover_throttle(ap.params.MOT) <= 0.0:
        return
    learn_hover_throttle(ap.params.MOT, ap.control.motors.throttle, _LEARN_TICKS * 0.0025)
