# SPDX-License-Identifier: BSD-3-Clause
"""Which vehicle a log is of, by what its firmware calls itself; also those that we do not have: errors name them."""

from __future__ import annotations

import re

from .kind import kinds_with_logs

OTHERS = {
    "Plane": ("a plane", 3),
    "AntennaTracker": ("an antenna tracker", 4),
    "Sub": ("a submarine", 7),
    "Blimp": ("a blimp", 12),
}
"""Word of the firmware's name -> what it is, and its number in VER.BU."""
_VERSION = re.compile(r"^\S*?(copter|heli|rover|plane|antennatracker|sub|blimp)\w*,? V\d", re.IGNORECASE)
"""As in "ArduCopter V4.3.0-dev (ef29350a)", "APM:Copter V3.3", "APMrover2 V3.0.1"."""
_HELI = 13
"""Traditional helicopters are copters with a number of their own."""
_OTHER_PARAMETERS = {"TECS_CLMB_MAX": "Plane", "JS_GAIN_MAX": "Sub"}


def of_text(text: str) -> tuple[str, str]:
    """(Kind of vehicle, "") for a text with a firmware's name, or ("", text) when we do not have its kind; else
    two empty texts."""
    found = _VERSION.match(text)
    for name, logs in kinds_with_logs().items():
        if (found is None and logs.word in text) or (found is not None and found[1].lower() == logs.word.lower()):
            return name, ""
    if found is None:
        return "", ""
    if found[1].lower() == "heli":
        return _of_number(_HELI)
    what = next(what for word, (what, _) in OTHERS.items() if word.lower() == found[1].lower())
    return "", f"{what} ({text})"


def of_build(number: int) -> tuple[str, str]:
    """As ``of_text``, by VER.BU."""
    kind, _ = _of_number(number)
    other = next((what for what, build in OTHERS.values() if build == number), "")
    return kind, other and f"{other} (VER.BU {number})"


def _of_number(number: int) -> tuple[str, str]:
    kinds = kinds_with_logs().items()
    copter = next((name for name, logs in kinds if logs.word == "Copter"), "")
    return (copter if number == _HELI else next((name for name, logs in kinds if logs.build_type == number), "")), ""


def of_parameter(name: str) -> tuple[str, str]:
    """As ``of_text``, by a parameter that only one kind of firmware has: logs that begin in the middle have no more."""
    kind = next((kind for kind, logs in kinds_with_logs().items() if name in logs.parameters), "")
    other = _OTHER_PARAMETERS.get(name, "")
    return kind, other and f"{OTHERS[other][0]} (it has parameter {name})"
