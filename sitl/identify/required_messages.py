# SPDX-License-Identifier: BSD-3-Clause
"""Which messages a property needs: what a log lacks is named, and telemetry has to come often enough.

Rates are those with which intervals held the truth in telemetry of our own copters (docs/identify.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..logs.tlog_columns import SOURCES
from .estimate import Estimate
from .log_streams import FlightLog

_HOVER = {"RCOU": 2.0, "IMU": 2.0, "ATT": 2.0, "XKF1": 2.0}
_DRAG = {"IMU": 2.0, "ATT": 2.0, "XKF1": 2.0}
NEEDS: dict[str, dict[str, float]] = {
    "hover_output": _HOVER,
    "hover_voltage": {**_HOVER, "BAT": 1.0},
    "hover_current": {**_HOVER, "BAT": 1.0},
    "balance_forward": _HOVER,
    "balance_right": _HOVER,
    "battery_resistance": {"BAT": 1.0},
    "drag_along": _DRAG,
    "drag_across": _DRAG,
    "drag_mcoef": _DRAG,
    "drag_bcoef_x": _DRAG,
    "drag_bcoef_y": _DRAG,
    "wind_speed": _DRAG,
    "wind_from": _DRAG,
    "vibration": {"VIBE": 1.0},
    "gyro_bias": {"IMU": 2.0},
    "baro_noise": {"BARO": 2.0},
    "mag_noise": {"MAG": 4.0},
    "gps_noise_horizontal": {"GPS": 1.0},
    "gps_noise_vertical": {"GPS": 1.0},
}
"""Property -> table -> least rate [Hz]."""
_FILTERED = "telemetry does not say at which rate, and behind which filter, RAW_IMU was sampled"
_NEVER = {
    "gyro_noise_density": _FILTERED,
    "acc_noise_density": _FILTERED,
    "gps_velocity_noise_vertical": "telemetry has no vertical velocity of the receiver",
    "battery_capacity": "",
}
"""What telemetry never tells; "": the property's own reason."""
_RATES_HZ = 20.0
HOW = (
    "A .bin tells more: the vehicle writes it to its card (LOG_BACKEND_TYPE 1); add 1 to LOG_BITMASK (fast attitude), "
    "set LOG_DISARMED 1, and download it (MAVProxy: log download latest; Mission Planner: DataFlash Logs)"
)


def judged(estimates: Sequence[Estimate], logs: Sequence[FlightLog]) -> list[Estimate]:
    """Properties with the messages that the logs lack as the reason; of telemetry, also those that came too seldom."""
    judge = _of_telemetry if any(log.is_telemetry for log in logs) else _of_onboard
    return [judge(estimate, logs) for estimate in estimates]


def _of_onboard(estimate: Estimate, logs: Sequence[FlightLog]) -> Estimate:
    lacks = [name for name in NEEDS.get(estimate.name, {}) if not any(log.has(name) for log in logs)]
    if estimate.is_observed or not lacks:
        return estimate
    return replace(estimate, reason=f"the log has no {', no '.join(lacks)} (LOG_BITMASK chooses what is logged)")


def _of_telemetry(estimate: Estimate, logs: Sequence[FlightLog]) -> Estimate:
    if estimate.name in NEEDS:
        reason = "; ".join(filter(None, (_lack(logs, *need) for need in NEEDS[estimate.name].items())))
    elif estimate.name in _NEVER:
        reason = _NEVER[estimate.name]
    else:
        reason = (
            "telemetry has no output of the rate controllers (RATE), and attitudes are needed at "
            f"{_RATES_HZ:.0f} Hz: {_rate(logs, 'ATT')}"
        )
    if not reason:
        return replace(estimate, data=_words(estimate.data), reason=_words(estimate.reason))
    return Estimate(estimate.name, estimate.unit, estimate.meaning, reason=reason)


def _lack(logs: Sequence[FlightLog], name: str, least: float) -> str:
    worst = min(_hz(log, name) for log in logs)
    return f"{_rate(logs, name)}; {least:g} Hz are needed" if worst < 0.95 * least else ""


def _rate(logs: Sequence[FlightLog], name: str) -> str:
    worst = min(_hz(log, name) for log in logs)
    return f"{SOURCES[name]} at {worst:.2g} Hz" if worst else f"no {SOURCES[name]}"


def _hz(log: FlightLog, name: str) -> float:
    """Messages a second in the log as a whole: links lose some."""
    if not log.has(name):
        return 0.0
    time = log.columns[name].time
    return float((len(time) - 1) / (time[-1] - time[0])) if len(time) > 1 and time[-1] > time[0] else 0.0


def _words(text: str) -> str:
    """A text with MAVLink's names in the place of ArduPilot's."""
    for name, message in SOURCES.items():
        text = text.replace(name, message)
    return text
