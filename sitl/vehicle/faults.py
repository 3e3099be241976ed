# SPDX-License-Identifier: BSD-3-Clause
"""What can fail on demand: one table, from units and types of MAVLink's INJECT_FAILURE to SIM_ parameters.

Names are those of FAILURE_UNIT and FAILURE_TYPE (https://mavlink.io/en/messages/common.html#FAILURE_UNIT), without
their prefixes; units that MAVLink does not have come last. From ``EFFECTS`` come ``Simulation.fail``, ``--fail``,
MAV_CMD_INJECT_FAILURE, faults of environments and of pytest, and the table of docs/faults.md.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from numbers import Integral, Real
from typing import NamedTuple

from ..autopilot.params.parameter import FLOAT
from ..autopilot.params.table import Table
from ..errors import OptionError, did_you_mean

UNITS = {
    "gyro": 0, "accel": 1, "mag": 2, "baro": 3, "gps": 4, "optical_flow": 5, "vio": 6, "distance_sensor": 7,
    "airspeed": 8, "battery": 100, "motor": 101, "servo": 102, "avoidance": 103, "rc": 104,
}  # fmt: skip
"""FAILURE_UNIT by name; units of ours have no number."""
OTHER_NAMES = {"rc_signal": "rc", "lidar": "avoidance", "rangefinder": "distance_sensor"}
PARAMETERS = "SIM_"
"""Beginning of the names of parameters that can stand in place of a unit."""
TYPES = ("ok", "off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent")
"""FAILURE_TYPE, by number."""

AMOUNT = "amount"
"""Value of a parameter: the fault's amount."""
MASK = "mask"
"""Value of a parameter: the bits of the instances that fail, besides those that fail already."""
LATEST_S = 1e9
Value = float | str | tuple[str, float]
"""A number, AMOUNT, MASK, or (AMOUNT, factor)."""
_METRE = 1.0 / 111318.845  # of latitude [deg]


class Effect(NamedTuple):
    """A way in which a unit fails."""

    unit: str
    type: str
    values: Mapping[str, Value]
    """SIM_ parameters that are set; "{n}" stands for the instance, "{baro}" for BARO, BAR2."""
    does: str
    """What that is."""
    amount: float | None = None
    """Usual amount; None: it takes none."""
    of: str = ""
    """What the amount is, with its unit."""
    instances: int = 1
    """How many there are."""

    def is_in(self, table: Table) -> bool:
        """Whether a firmware has all of its parameters."""
        return all(name in table and table[name].has_effect for name in self.names(1))

    def names(self, instances: int = 0) -> list[str]:
        """Its parameters, of the first so many instances; 0: of all."""
        last = instances or self.instances
        return [named(name, k) for name in self.values for k in range(1, last + 1 if "{" in name else 2)]


def named(parameter: str, instance: int) -> str:
    """A parameter of an instance."""
    return parameter.format(n=instance, baro="BARO" if instance == 1 else f"BAR{instance}")


EFFECTS: tuple[Effect, ...] = (
    Effect("gps", "off", {"SIM_GPS{n}_ENABLE": 0}, "no receiver any more", instances=2),
    Effect("gps", "wrong", {"SIM_GPS{n}_GLTCH_X": (AMOUNT, _METRE)}, "fixes lie to the north", 50.0, "[m]", 2),
    Effect("gps", "garbage", {"SIM_GPS{n}_JAM": 1}, "jammed: position, speed and satellites jump", instances=2),
    Effect("gps", "delayed", {"SIM_GPS{n}_LAG_MS": (AMOUNT, 1000.0)}, "fixes come late", 0.5, "[s]", 2),
    Effect("gps", "intermittent", {"SIM_GPS{n}_BYTELOS": (AMOUNT, 100.0)}, "bytes are lost", 0.01, "share", 2),
    Effect("gyro", "wrong", {"SIM_GYR{n}_BIAS_X": AMOUNT}, "the roll rate that it shows is off", 0.5, "[rad/s]", 2),
    Effect("gyro", "off", {"SIM_GYR_FAIL_MSK": MASK}, "the gyro sends nothing", instances=2),
    Effect("accel", "wrong", {"SIM_ACC{n}_BIAS_X": AMOUNT}, "it shows so much too much forward", 5.0, "[m/s/s]", 2),
    Effect("accel", "off", {"SIM_ACC_FAIL_MSK": MASK}, "the accelerometer sends nothing", instances=2),
    Effect("accel", "stuck", {"SIM_ACCEL{n}_FAIL": AMOUNT}, "all axes show one number", 20.0, "[m/s/s]", 2),
    Effect("mag", "off", {"SIM_MAG{n}_FAIL": 1}, "the compass sends nothing", instances=3),
    Effect("mag", "wrong", {"SIM_MAG{n}_OFS_X": AMOUNT}, "hard iron ahead of it", 400.0, "[mGauss]", 3),
    Effect("baro", "off", {"SIM_{baro}_DISABLE": 1}, "no samples any more", instances=2),
    Effect("baro", "stuck", {"SIM_{baro}_FREEZE": 1}, "the same height for ever", instances=2),
    Effect("baro", "garbage", {"SIM_{baro}_RND": AMOUNT}, "noise", 3.0, "[m]", 2),
    Effect("baro", "wrong", {"SIM_{baro}_GLITCH": AMOUNT}, "another height", 10.0, "[m]", 2),
    Effect("baro", "slow", {"SIM_{baro}_DRIFT": AMOUNT}, "the height drifts away", 0.5, "[m/s]", 2),
    Effect("baro", "delayed", {"SIM_{baro}_DELAY": (AMOUNT, 1000.0)}, "samples come late", 0.5, "[s]", 2),
    Effect("battery", "wrong", {"SIM_BATT_VOLTAGE": AMOUNT}, "another voltage of the full battery", 10.0, "[V]"),
    Effect("battery", "slow", {"SIM_BATT_RES": AMOUNT}, "the voltage sags under load", 0.1, "[Ohm]"),
    Effect("motor", "off", {"SIM_ENGINE_MUL": AMOUNT, "SIM_ENGINE_FAIL": MASK}, "weaker motors", 0.0, "share left", 8),
    Effect("motor", "stuck", {"SIM_ENGINE_STUCK": MASK}, "motors stay at their command", instances=8),
    Effect("motor", "slow", {"SIM_ENGINE_LAG": AMOUNT}, "all motors follow late", 0.5, "[s]"),
    Effect("servo", "off", {"SIM_ENGINE_MUL": AMOUNT, "SIM_ENGINE_FAIL": MASK}, "weaker outputs", 0.0, "share left", 8),
    Effect("servo", "stuck", {"SIM_ENGINE_STUCK": MASK}, "outputs stay as they are", instances=8),
    Effect("servo", "slow", {"SIM_SERVO_SPEED": AMOUNT}, "the steering servo is slow", 1.0, "[s] for 60 degrees"),
    Effect("servo", "delayed", {"SIM_SERVO_DELAY": AMOUNT}, "the steering servo hears commands late", 0.2, "[s]"),
    Effect("rc", "off", {"SIM_RC_FAIL": 1}, "the transmitter is silent"),
    Effect("rc", "wrong", {"SIM_RC_FAIL": 2}, "sticks centred, throttle at 950 us"),
    Effect("rc", "stuck", {"SIM_RC_STUCK": MASK}, "channels stay as they are", instances=16),
    Effect("rc", "garbage", {"SIM_RC_NOISE": AMOUNT}, "noise on all channels", 100.0, "[us]"),
    Effect("optical_flow", "off", {"SIM_FLOW_ENABLE": 0}, "no optical flow any more"),
    Effect("optical_flow", "garbage", {"SIM_FLOW_RND": AMOUNT}, "noise of the flow", 1.0, "[rad/s]"),
    Effect("optical_flow", "delayed", {"SIM_FLOW_DELAY": (AMOUNT, 1000.0)}, "the flow comes late", 0.1, "[s]"),
    Effect("distance_sensor", "off", {"SIM_SONAR_LOSS": 1}, "nothing in range"),
    Effect("distance_sensor", "wrong", {"SIM_SONAR_GLITCH": AMOUNT}, "other readings", 5.0, "[m]"),
    Effect("distance_sensor", "garbage", {"SIM_SONAR_RND": AMOUNT}, "noise", 1.0, "[m]"),
    Effect("distance_sensor", "intermittent", {"SIM_SONAR_LOSS": AMOUNT}, "drop-outs", 0.3, "share"),
    Effect("avoidance", "off", {"SIM_LIDAR_LOSS": 1}, "the lidar sees nothing"),
    Effect("avoidance", "intermittent", {"SIM_LIDAR_LOSS": AMOUNT}, "drop-outs of the lidar", 0.3, "share"),
    Effect("wind", "wrong", {"SIM_WIND_SPD": AMOUNT}, "wind", 10.0, "[m/s]"),
    Effect("shove", "wrong", {"SIM_SHOVE_X": AMOUNT, "SIM_SHOVE_TIME": 500}, "a shove forward", 5.0, "[m/s/s]"),
    Effect("twist", "wrong", {"SIM_TWIST_Z": AMOUNT, "SIM_TWIST_TIME": 500}, "a twist to the right", 5.0, "[rad/s/s]"),
)
"""The first type of a unit is the one that counts when none is said."""


@cache
def known(table: Table) -> dict[str, dict[str, Effect]]:
    """Unit -> type -> effect: those that a vehicle with these parameters has; not to be changed."""
    found: dict[str, dict[str, Effect]] = {}
    for effect in EFFECTS:
        if effect.is_in(table):
            found.setdefault(effect.unit, {})[effect.type] = effect
    return found


@dataclass(frozen=True)
class Failure:
    """Something fails, for some time.

    Args:
        unit: of the table, as "gps", or a SIM_ parameter.
        type: as "off"; "": the unit's first one.
        instance: which one, from 1; 0: all.
        amount: of what the table says; of a parameter its value; None: the usual one.
        begin, end: simulated seconds from now; end None: it stays.

    Raises:
        OptionError: a value that cannot be, named.
    """

    unit: str
    type: str = ""
    instance: int = 0
    amount: float | None = None
    begin: float = 0.0
    end: float | None = None

    def __post_init__(self) -> None:
        for name, text in (("unit", self.unit), ("type", self.type)):
            if not isinstance(text, str):
                raise OptionError(f"fault {self.unit!r}: {name} {text!r} is not a text")
        unit = unit_name(self.unit)
        if not isinstance(self.instance, Integral) or isinstance(self.instance, bool):
            raise OptionError(f"fault {unit}: instance {self.instance!r} is not a whole number")
        if self.amount is not None and not _is_finite(self.amount):
            raise OptionError(f"fault {unit}: amount {self.amount!r} is not a finite number")
        for name, time in (("begin", self.begin), ("end", self.begin if self.end is None else self.end)):
            if not (_is_finite(time) and 0.0 <= time <= LATEST_S):
                raise OptionError(f"fault {unit}: {name} {time!r} is not a time from 0 to {LATEST_S:g} s")
        if self.end is not None and self.end <= self.begin:
            raise OptionError(f"fault {unit}: its end, {self.end:g} s, is not after its begin, {self.begin:g} s")
        plain = {  # NumPy's numbers have texts of their own
            "unit": unit,
            "instance": int(self.instance),
            "amount": None if self.amount is None else float(self.amount),
            "begin": float(self.begin),
            "end": None if self.end is None else float(self.end),
        }
        for name, value in plain.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, failure: Failure | str) -> Failure:
        """One as functions take it: made already, or a text.

        Raises:
            OptionError: it is neither.
        """
        if isinstance(failure, cls):
            return failure
        if not isinstance(failure, str):
            raise OptionError(f"fault {failure!r} is neither a Failure nor a text such as gps@12")
        return cls.of_text(failure)

    @classmethod
    def of_text(cls, text: str) -> Failure:
        """``UNIT[:INSTANCE][/TYPE][=AMOUNT][@BEGIN[..END]]``: "gps@12", "motor:2=0.5@20..30", "SIM_WIND_DIR=90".

        Raises:
            OptionError: it is none.
        """
        found = Text.of(text)
        return cls(found.unit, found.type, found.instance, found.amount, found.begin or 0.0, found.end)

    @property
    def is_parameter(self) -> bool:
        """Whether it is a SIM_ parameter, not a unit of the table."""
        return self.unit.startswith(PARAMETERS)

    @property
    def drives_outputs(self) -> bool:
        """Whether motors or servos fail, which only move while the vehicle is armed."""
        return self.unit in ("motor", "servo") or self.unit.startswith(("SIM_ENGINE_", "SIM_SERVO_"))

    def effect(self, table: Table) -> Effect:
        """What of the table it is, for a vehicle for which it has been ``checked``; no parameter is."""
        types = known(table)[self.unit]
        return types[self.type or next(iter(types))]

    def numbers(self, table: Table) -> list[int]:
        """The instances that fail, of a vehicle for which it has been ``checked``."""
        if self.is_parameter:
            return []
        return [self.instance] if self.instance else list(range(1, self.effect(table).instances + 1))

    def __str__(self) -> str:
        instance = f":{self.instance}" if self.instance else ""
        kind = f"/{self.type}" if self.type else ""
        amount = f"={self.amount!r}" if self.amount is not None else ""
        end = f"..{self.end!r}" if self.end is not None else ""
        return f"{self.unit}{instance}{kind}{amount}@{self.begin!r}{end}"

    def checked(self, table: Table) -> Failure:
        """The same, if a vehicle with these parameters has it.

        Raises:
            OptionError: it has not; the message says what it has.
        """
        if self.is_parameter:
            if self.unit not in table or not table[self.unit].has_effect:
                names = [p.name for p in table.with_effect if p.name.startswith(PARAMETERS)]
                raise OptionError(f"fault {self.unit}: no such parameter has an effect{did_you_mean(self.unit, names)}")
            if self.type or self.instance or self.amount is None:
                raise OptionError(f"fault {self.unit}: a parameter takes a value and nothing else, as {self.unit}=1")
            if text := table[self.unit].refusal(self.amount):
                raise OptionError(f"fault {text}")
            if table[self.unit].kind != FLOAT and self.amount % 1.0:
                raise OptionError(f"fault {self.unit}: {self.amount:g} is not a whole number")
            return self
        units = known(table)
        if self.unit not in units:
            raise OptionError(f"there is no fault {self.unit!r}; there are {', '.join(units)}")
        types = units[self.unit]
        kind = self.type or next(iter(types))
        if kind not in types:
            raise OptionError(f"fault {self.unit} has no type {kind!r}; it has {', '.join(types)}")
        effect = types[kind]
        if not 0 <= self.instance <= effect.instances:
            raise OptionError(
                f"fault {self.unit}: there is no number {self.instance}; it has 1 to {effect.instances}, and 0 for all"
            )
        if self.amount is not None and effect.amount is None:
            raise OptionError(f"fault {self.unit}/{kind} takes no amount, and {self.amount:g} was given")
        failure = replace(self, type=kind)
        for name, value in failure.values(table, {}).items():
            if text := table[name].out_of_range(value):
                raise OptionError(f"fault {self.unit}/{kind}: {text}")
        return failure

    def values(self, table: Table, now: Mapping[str, float]) -> dict[str, float]:
        """Parameters and their values while it lasts.

        Args:
            table: of the vehicle, for which it has been ``checked``.
            now: present values of masks.
        """
        if self.is_parameter:
            return {self.unit: self.amount or 0.0}
        effect = self.effect(table)
        amount = self.amount if self.amount is not None else effect.amount or 0.0
        which = self.numbers(table)
        found = {}
        for name, value in effect.values.items():
            for n in which if "{" in name else which[:1]:
                full = named(name, n)
                if value == MASK:
                    found[full] = float(int(now.get(full, 0.0)) | sum(1 << (k - 1) for k in which))
                elif isinstance(value, tuple):
                    found[full] = amount * value[1]
                else:
                    found[full] = amount if isinstance(value, str) else float(value)
        return found


FORM = "UNIT[:INSTANCE][/TYPE][=AMOUNT][@BEGIN[..END]]"
_FORM = re.compile(
    r"([A-Za-z][A-Za-z0-9_]*)(?::(\d+))?(?:/([a-z]+))?(?:=([^@]+))?(?:@([0-9.eE+-]+?)(?:\.\.([0-9.eE+-]+))?)?"
)


class Text(NamedTuple):
    """The pieces of a fault's text; None and "": not given."""

    unit: str
    instance: int
    type: str
    amount: float | None
    begin: float | None
    end: float | None

    @classmethod
    def of(cls, text: str) -> Text:
        """Take a text apart.

        Raises:
            OptionError: it is none.
        """
        found = _FORM.fullmatch(text.strip())
        try:
            if found is None:
                raise ValueError
            unit, instance, kind, *numbers = found.groups()
            return cls(unit, int(instance or 0), kind or "", *(None if n is None else float(n) for n in numbers))
        except ValueError:
            raise OptionError(f"fault {text!r} is not {FORM}, as in gps@12 or motor:2=0.5@20..30") from None


def is_fault(name: str) -> bool:
    """Whether a text begins with a unit of the table or names a SIM_ parameter."""
    unit = unit_name(re.split("[:/=@]", name, maxsplit=1)[0])
    return unit.startswith(PARAMETERS) or any(unit == effect.unit for effect in EFFECTS)


def unit_name(unit: str) -> str:
    """Name of a unit in the table, which may have been given under another one."""
    return OTHER_NAMES.get(unit, unit)


def _is_finite(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and math.isfinite(value)
