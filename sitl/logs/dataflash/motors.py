# SPDX-License-Identifier: BSD-3-Clause
"""Which outputs of a copter's log drive its motors, in which pulses, and how the motors stand, in logs of 3.3 on."""

from __future__ import annotations

from .tables import Tables

_FUNCTIONS = range(33, 41)
"""SERVOn_FUNCTION of motors 1 to 8."""
_OUTPUTS = range(1, 15)
_FRAMES = {
    "QUAD": (1, 4),
    "HEXA": (2, 6),
    "OCTA": (3, 8),
    "OCTA_QUAD": (4, 8),
    "OCTAQUAD": (4, 8),
    "Y6": (5, 6),
    "TRI": (7, 3),
}
"""Word in the text "Frame: ..." -> FRAME_CLASS, motors."""


def frame(log: Tables) -> tuple[int, int]:
    """FRAME_CLASS and FRAME_TYPE; before 3.5 a text has the first, and FRAME is the second. 0: not known."""
    parameters = log.parameters
    of_text, _ = _FRAMES.get(_word(log), (0, 0))
    kind = parameters.get("FRAME_TYPE", parameters.get("FRAME", 0.0))
    return int(parameters.get("FRAME_CLASS", of_text)), int(kind)


def channels(log: Tables) -> list[int]:
    """Numbers of the outputs of motor 1, 2, ..., from 1; before 3.5 there is no SERVOn_FUNCTION, and they are the first
    ones."""
    parameters = log.parameters
    if not any(f"SERVO{channel}_FUNCTION" in parameters for channel in _OUTPUTS):
        return list(range(1, 1 + _FRAMES.get(_word(log), (0, 0))[1]))
    named = [(int(parameters.get(f"SERVO{channel}_FUNCTION", 0)), channel) for channel in _OUTPUTS]
    return list({function: channel for function, channel in sorted(named) if function in _FUNCTIONS}.values())


def pulses(parameters: dict[str, float]) -> tuple[float, float]:
    """Pulses of motors at rest and at full output [us]: MOT_PWM_MIN and _MAX, or, where these are 0 (the default
    before 4.1), those of the throttle stick."""
    low, high = parameters.get("MOT_PWM_MIN", 0.0), parameters.get("MOT_PWM_MAX", 0.0)
    if high <= 0.0:
        stick = f"RC{int(parameters.get('RCMAP_THROTTLE', 3.0))}"
        low, high = parameters.get(f"{stick}_MIN", 0.0), parameters.get(f"{stick}_MAX", 0.0)
    return (low, high) if 0.0 < low < high else (1000.0, 2000.0)


def _word(log: Tables) -> str:
    said = (text.removeprefix("Frame: ") for _, text in log.texts if text.startswith("Frame: "))
    return next(said, "").split("/")[0]
