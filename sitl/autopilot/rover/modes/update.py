# SPDX-License-Identifier: BSD-3-Clause
"""The decisions of one period of 20 ms: sticks, mode, crash check, failsafes."""

from __future__ import annotations

from ....core.kernels import law, unit
from ... import battery, home
from .. import arming, crash, failsafe, motor_test, pilot, smart_rtl_path
from ..control.forward_speed import sense
from . import acro, auto, circle, guided_drive, hold, loiter, manual, rtl, set_mode, simple, smart_rtl, steering, switch
from .numbers import ACRO, AUTO, CIRCLE, GUIDED, HOLD, LOITER, MANUAL, RTL, SIMPLE, SMART_RTL, STEERING

# Ticks of 2.5 ms; all are multiples of the 8 of a period
_TENTH = 40
_QUARTER = 104
_THIRD = 136
_SECOND = 400

HOME_MOVES = 0.5
"""Disarmed, home follows a vehicle that is further from it [m]."""


@unit
def update(fleet, i):
    """One period of vehicle ``i``: reads the estimate, writes demands of steering and throttle."""
    v = fleet[i]
    tick = v.tick
    sense(v)
    read_transmitter(v)
    if tick % _TENTH == 0:
        check_slowly(v)
    if tick % _QUARTER == 0:
        arming.update(v)
    if tick % _THIRD == 0:
        smart_rtl_path.update(v, 0 if v.autopilot.modes.number == SMART_RTL else 1)
    if tick % _SECOND == 0:
        follow_home(v)
    run_mode(v)
    motor_test.update(v)


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
    crash.update(v)


@law
def follow_home(v):
    """Once a second: home is set with the first position; disarmed it moves with the vehicle, unless locked."""
    ap = v.autopilot
    if ap.home.is_set == 0:
        home.set_first(ap.home, ap.estimate)
    elif ap.arming.armed == 0 and ap.home.locked == 0 and ap.estimate.position_ok != 0:
        north = ap.estimate.pos[0] - ap.home.pos[0]
        east = ap.estimate.pos[1] - ap.home.pos[1]
        if north * north + east * east >= HOME_MOVES * HOME_MOVES:
            home.set_here(ap.home, ap.estimate)


@law
def run_mode(v):
    """The mode's own period, then the change that it may have asked for."""
    ap = v.autopilot
    number = ap.modes.number
    if number == GUIDED:
        guided_drive.run(v)
    elif number == AUTO:
        auto.run(v)
    elif number == MANUAL:
        manual.run(v)
    elif number == HOLD:
        hold.run(v)
    elif number == RTL:
        rtl.run(v)
    elif number == SMART_RTL:
        smart_rtl.run(v)
    elif number == LOITER:
        loiter.run(v)
    elif number == CIRCLE:
        circle.run(v)
    elif number == STEERING:
        steering.run(v)
    elif number == ACRO:
        acro.run(v)
    elif number == SIMPLE:
        simple.run(v)
    if ap.modes.wanted != 0:
        wanted = int(ap.modes.wanted) - 1
        ap.modes.wanted = 0
        set_mode.request(v, wanted, int(ap.modes.wanted_reason))
