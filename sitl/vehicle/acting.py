# SPDX-License-Identifier: BSD-3-Clause
"""Parameters of faults that do something only together with others: a wind's direction needs a wind.

A fault that sets such a parameter alone would be in force, and nothing would be different.
"""

from __future__ import annotations

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import NamedTuple

Value = Callable[[str], float | None]
"""Gives a parameter as it is in force, or ``ARMED``; None: the vehicle has no such parameter."""
ARMED = "armed"
"""1 while the vehicle is armed."""


class Is(NamedTuple):
    """A condition of one parameter."""

    name: str
    value: float = 0.0
    is_not: bool = True
    """It must be another one."""
    bit: bool = False
    """``value`` is a bit, and it must not be set."""

    def holds(self, value: float) -> bool:
        """Whether it does with a value of the parameter."""
        if self.bit:
            return not int(value) & int(self.value)
        return (value != self.value) == self.is_not


def _only(name: str, value: float = 0.0) -> Is:
    return Is(name, value, is_not=False)


_WIND_SHEARS = _only("SIM_WIND_T", 2)
_VIBRATE = tuple(map(Is, ("SIM_ACC1_RND", "SIM_ACC2_RND", "SIM_GYR1_RND", "SIM_GYR2_RND")))

ACTS_WHILE: tuple[tuple[str, tuple[Is, ...]], ...] = (
    ("SIM_ENGINE_MUL", (Is("SIM_ENGINE_FAIL"),)),
    ("SIM_ENGINE_FAIL", (Is("SIM_ENGINE_MUL", 1),)),
    ("SIM_WIND_DIR*", (Is("SIM_WIND_SPD"), _WIND_SHEARS)),
    ("SIM_WIND_TC", (Is("SIM_WIND_SPD"), Is("SIM_WIND_TURB"), _WIND_SHEARS)),
    ("SIM_WIND_T", (Is("SIM_WIND_SPD"), _WIND_SHEARS)),
    ("SIM_WIND_T_ALT", (Is("SIM_WIND_SPD"), _WIND_SHEARS)),
    ("SIM_WIND_T_ALT", (Is("SIM_WIND_T", 1),)),
    ("SIM_WIND_T_COEF", (_WIND_SHEARS,)),
    *((f"SIM_{push}_[XYZ]", (Is(f"SIM_{push}_TIME"),)) for push in ("SHOVE", "TWIST")),
    *((f"SIM_{push}_TIME", tuple(Is(f"SIM_{push}_{k}") for k in "XYZ")) for push in ("SHOVE", "TWIST")),
    ("SIM_ACC[12]_RND", (Is(ARMED),)),
    ("SIM_GYR[12]_RND", (Is(ARMED),)),
    ("SIM_VIB_FREQ_*", _VIBRATE),
    ("SIM_VIB_FREQ_*", (Is(ARMED),)),
    *((f"SIM_{sensor}{n}_*", (Is(f"SIM_{mask}_FAIL_MSK", n, bit=True),))
      for sensor, mask in (("ACC", "ACC"), ("ACCEL", "ACC"), ("GYR", "GYR")) for n in (1, 2)),
    *((f"SIM_ACC{n}_*", (_only(f"SIM_ACCEL{n}_FAIL"),)) for n in (1, 2)),
    *((f"SIM_MAG{n}_*", (_only(f"SIM_MAG{n}_FAIL"),)) for n in (1, 2, 3)),
    *((f"SIM_{baro}_[!C]*", (_only(f"SIM_{baro}_DISABLE"),)) for baro in ("BARO", "BAR2")),
    *((f"SIM_GPS{n}_ENABLE", (Is(name),)) for n in (1, 2) for name in (f"GPS{n}_TYPE", f"SIM_GPS{n}_TYPE")),
    ("SIM_BATT_*", (Is("BATT_MONITOR"), Is(ARMED))),
    ("SIM_PLD_[!E]*", (Is("SIM_PLD_ENABLE"),)),
    ("SIM_PLD_*", (Is("PLND_ENABLED"),)),
    ("SIM_SPEEDUP", ()),
)  # fmt: skip
"""Pattern of parameters -> conditions of which one must hold; of several rows, one of each. Without any: never."""


def acts_not(parameter: str, value: Value) -> str:
    """Why a parameter does nothing while the others are as they are; "": it does something."""
    for pattern, conditions in ACTS_WHILE:
        if not fnmatchcase(parameter, pattern) or conditions == (_only(parameter),):
            continue
        if not conditions:
            return f"{parameter} changes nothing of a flight"
        found = [(one, now) for one in conditions if (now := value(one.name)) is not None]
        if found and not any(one.holds(now) for one, now in found):
            return f"{parameter} does nothing while {' and '.join(_words(one, now) for one, now in found)}"
    return ""


def _words(one: Is, value: float) -> str:
    return "the vehicle is not armed" if one.name == ARMED else f"{one.name} is {value:g}"
