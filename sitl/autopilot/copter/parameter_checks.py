# SPDX-License-Identifier: BSD-3-Clause
"""The copter's arming checks of parameters: outputs of motors, failsafe, gains."""

from __future__ import annotations

from collections.abc import Iterable

from ..parameter_checks import ALWAYS, CHECK_PARAMETERS, CHECK_RC, SHARED, Check, Subject, switches
from ..params.table import Values
from ..radio import THROTTLE, stick_channel
from ..radio_checks import STICK_NAMES, calibration_texts

SPIN_MIN_MOST = 0.3
_ROUNDING = 1e-6
THR_VALUE_LEAST, THR_VALUE_MARGIN = 910.0, 10.0
"""FS_THR_VALUE is above the pulse of a receiver that has lost its transmitter, and below the stick's least [us]."""
ANGLE_LEAST, ANGLE_MOST = 1000.0, 8000.0
"""Of ANGLE_MAX [cdeg]."""
CONTINUES_MISSION = 2
"""Of FS_GCS_ENABLE: what FS_OPTIONS is for now."""
INTERLOCK, EMERGENCY_STOPS = 32, (31, 165)
"""Functions of switches."""
_POSITIVE = ("PSC_POSXY_P", "PSC_POSZ_P", "PSC_VELZ_P", "PSC_ACCZ_P", "PSC_ACCZ_I")
_ANGLES = ("ATC_ANG_PIT_P", "ATC_ANG_RLL_P", "ATC_ANG_YAW_P")
_RATES = ("ATC_RAT_RLL", "ATC_RAT_PIT", "ATC_RAT_YAW")


def motors(s: Subject) -> Iterable[str]:
    """The first thing that is wrong with the motors' outputs."""
    values, m = s.values, s.v.autopilot.control.motors
    for k in range(m.count):
        if m.output[k] < 0:
            yield f"Motors: no SERVOx_FUNCTION set to Motor{k + 1}"
            return
    least, low, high = values["MOT_SPIN_MIN"], values["MOT_PWM_MIN"], values["MOT_PWM_MAX"]
    if m.count == 0:
        return  # that is a check of its own
    if values["FRAME_TYPE"] < 0.0:
        yield "Motors: Check frame class and type"
        return
    if least > SPIN_MIN_MOST + _ROUNDING:
        yield f"Motors: MOT_SPIN_MIN too high {least:.2f} > {SPIN_MIN_MOST}"
    elif values["MOT_SPIN_ARM"] > least:
        yield "Motors: MOT_SPIN_ARM > MOT_SPIN_MIN"
    elif low < 1.0 or high < 1.0 or low >= high:
        yield "Motors: Check MOT_PWM_MIN and MOT_PWM_MAX"


def stop_switches(s: Subject) -> Iterable[str]:
    """Two switches that stop the motors, of which each starts them when it is moved back."""
    options = {int(s.values[f"RC{k}_OPTION"]) for k in range(1, 17)}
    if INTERLOCK in options and options & set(EMERGENCY_STOPS):
        yield "Interlock/E-Stop Conflict"


def ground_station(s: Subject) -> Iterable[str]:
    """An action that there is no more."""
    if int(s.values["FS_GCS_ENABLE"]) == CONTINUES_MISSION:
        yield "FS_GCS_ENABLE=2 removed, see FS_OPTIONS"


def flight(s: Subject) -> Iterable[str]:
    """The first parameter of failsafe, lean and gains that cannot be flown with."""
    values = s.values
    wrong = _throttle(s) or _lean(values) or _gains(values)
    return (wrong,) if wrong else ()


def _throttle(s: Subject) -> str:
    limit = s.values["FS_THR_VALUE"]
    least = s.values[f"RC{stick_channel(s.v.autopilot.params.RCMAP, THROTTLE) + 1}_MIN"]
    wrong = least <= limit + THR_VALUE_MARGIN or limit < THR_VALUE_LEAST
    return "Check FS_THR_VALUE" if wrong and s.values["FS_THR_ENABLE"] != 0.0 else ""


def _lean(values: Values) -> str:
    if not ANGLE_LEAST <= values["ANGLE_MAX"] <= ANGLE_MOST:
        return "Check ANGLE_MAX"
    for axis, of in (("ROLL", "RLL"), ("PITCH", "PIT")):
        if not 0.0 <= values[f"ACRO_BAL_{axis}"] <= values[f"ATC_ANG_{of}_P"]:
            return "Check ACRO_BAL_ROLL/PITCH"
    return "Check PILOT_SPEED_UP" if values["PILOT_SPEED_UP"] <= 0.0 else ""


def _gains(values: Values) -> str:
    for name in (*_POSITIVE, *_ANGLES):
        if values[name] <= 0.0:
            return f"Bad parameter: {name} must be > 0"
    for loop in _RATES:
        by_setpoint = values[f"{loop}_FF"] > 0.0
        for name in (f"{loop}_P", f"{loop}_I"):
            if values[name] < 0.0 or (values[name] == 0.0 and not by_setpoint):
                return f"Bad parameter: {name} must be {'>=' if by_setpoint else '>'} 0"
        if values[f"{loop}_D"] < 0.0:
            return f"Bad parameter: {loop}_D must be >= 0"
    return ""


def winch(s: Subject) -> Iterable[str]:
    """A winch that is of no kind."""
    if s.values["WINCH_TYPE"] < 0.0:
        yield "winch unhealthy"


CHECKS = (
    Check(ALWAYS, stop_switches),
    Check(ALWAYS, motors),
    Check(CHECK_PARAMETERS, ground_station, forbids=False),
    Check(CHECK_PARAMETERS, flight),
    Check(CHECK_PARAMETERS, winch),
    *SHARED,
    Check(CHECK_RC, lambda s: calibration_texts(s.values, s.v.autopilot.params, STICK_NAMES)),
    Check(CHECK_RC, lambda s: switches(s, "FLTMODE_CH"), when_arming=True),
)
