# SPDX-License-Identifier: BSD-3-Clause
"""Where model or autopilot differ, told by which metrics agree and which do not."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .agreement import Agreement

_GOOD = 80.0
"""Variance accounted for from which on a quantity counts as agreeing [%]."""
_LIFT = 0.05
"""Share by which the mean motor outputs may differ."""
_PUSH = 0.3
"""Acceleration by thrust by which the model may differ at the log's motor outputs [m/s^2]."""
_VOLTS = 0.02
"""Share by which voltages may differ."""
_AXES = ("roll_rate", "pitch_rate", "yaw_rate")
NOT_JUDGED = "not judged"
"""Begins a sentence that is no difference."""
_ANGLES = ("asked_roll", "asked_pitch")


_MOTION = {
    "climb": "thrust, mass or controllers differ",
    "speed": "speed by throttle, lag, drag or the path differ",
    "roll": "targets, model or controllers differ",
    "pitch": "targets, model or controllers differ",
    "yaw_rate": "steering, or the path that it follows, differ",
}
"""What is judged where there are no open segments, and what its difference may be."""


def findings(
    whole: Sequence[Agreement],
    segments: Sequence[Agreement],
    model: Sequence[Agreement],
    in_step: Sequence[Agreement] = (),
) -> list[str]:
    """Sentences, the model's first; none: they agree as far as these metrics show.

    Args:
        whole: of the whole flight.
        segments, model: of open segments, and of those that the model flies alone; none where none were flown.
        in_step: in step by mission items; none without a mission.
    """
    of_whole, of_segments, of_model = ({one.quantity.name: one for one in part} for part in (whole, segments, model))
    found: list[str] = []
    leans_alike = not any(_is_bad(of_segments[name]) for name in ("roll", "pitch") if name in of_segments)
    throttle = (leans_alike and of_segments.get("throttle")) or of_whole.get("throttle")  # who leans more needs more
    if throttle is not None and "motors" in of_whole:
        logged = float(throttle.logged.mean())
        flown = float(throttle.flown.mean())
        if logged > 1.0 and abs(flown / logged - 1.0) > _LIFT:
            found.append(
                f"model: mean throttle output of the log is {logged:.1f} %, of the twin {flown:.1f} %: the thrust "
                f"over weight of the airframe is {'less' if flown > logged else 'more'} than the vehicle's"
            )
    push = of_model.get("thrust") or of_model.get("acceleration")  # who leans more falls
    if push is not None and abs(push.bias) > _PUSH:
        found.append(
            f"model: at the log's motor outputs the model accelerates {abs(push.bias):.2f} m/s^2 more "
            f"{'up' if push.bias > 0.0 else 'down'} than the vehicle did"
        )
    asked = [one for one in segments if one.quantity.is_asked and _is_bad(one)]
    turns_elsewhere = any(one.quantity.name in _ANGLES for one in asked)
    unjudged: list[str] = []
    for name in _AXES:
        closed, alone = of_segments.get(name), of_model.get(name)
        if alone is not None and _is_bad(alone) and (closed is None or _is_bad(closed)):
            found.append(
                f"model: {alone.quantity.title} at the log's motor outputs accounts for {max(alone.vaf, 0.0):.0f} % of "
                "its variance: torque over inertia, damping or motor lag differ"
            )
        elif closed is not None and _is_bad(closed) and turns_elsewhere:
            unjudged.append(closed.quantity.title)
        elif closed is not None and _is_bad(closed):
            found.append(
                f"{closed.quantity.title} in open segments accounts for {max(closed.vaf, 0.0):.0f} % of its variance: "
                "model or rate controller differ"
            )
    for one in asked:
        found.append(
            f"autopilot: {one.quantity.title}, from the same state, accounts for {max(one.vaf, 0.0):.0f} % of its "
            "variance: targets of the mode differ (sticks, path, wind)"
        )
    if unjudged:
        found.append(
            f"{NOT_JUDGED}: {', '.join(unjudged)} in open segments, for the twin was asked for other angles than the "
            "vehicle. In a mission with gusts one of the two is ahead on its path, and turns at another time: compare "
            "the whole flight, or a log of calm air"
        )
    if not segments:
        found += _of_motion(in_step or whole, "in step by mission items" if in_step else "over the whole flight")
    voltage = of_whole.get("voltage")
    if voltage is not None and voltage.logged.mean() > 1.0 and voltage.rms > _VOLTS * float(voltage.logged.mean()):
        found.append(f"model: battery voltage differs by {voltage.rms:.2f} V (RMS): resistance or capacity differ")
    return found


def _of_motion(part: Sequence[Agreement], where: str) -> list[str]:
    """Without open segments errors add up, so model and autopilot are not distinguished."""
    return [
        f"{one.quantity.title} {where} accounts for {max(one.vaf, 0.0):.0f} % of its variance: "
        f"{_MOTION[one.quantity.name]}"
        for one in part
        if one.quantity.name in _MOTION and _is_bad(one)
    ]


def _is_bad(one: Agreement) -> bool:
    return math.isfinite(one.vaf) and one.vaf < _GOOD and one.rms > one.quantity.moves
