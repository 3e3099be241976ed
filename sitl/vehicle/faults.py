# SPDX-License-Identifier: BSD-3-Clause
"""What can fail on demand: one table, from units and types of MAVLink's INJECT_FAILURE to SIM_ parameters.

Names are those of FAILURE_UNIT and FAILURE_TYPE (https://mavlink.io/en/messages/common.html#FAILURE_UNIT), without
their prefixes; units that MAVLink does not have come last. From ``EFFECTS`` come ``Simulation.fail``, ``--fail``,
MAV_CMD_INJECT_FAILURE, faults of environments and of pytest, and the table of docs/faults.md.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..autopilot.params.table import Table
from ..errors import OptionError, did_you_mean

UNITS = {
    "gyro": 0, "accel": 1, "mag": 2, "baro": 3, "gps": 4, "optical_flow": 5, "vio": 6, "distance_sensor": 7,
    "airspeed": 8, "battery": 100, "motor": 101, "servo": 102, "avoidance": 103, "rc": 104,
}  # fmt: skip
"""FAILURE_UNIT by name; units of ours have no number."""
OTHER_NAMES = {"rc_signal": "rc", "lidar": "avoidance", "rangefinder": "distance_sensor"}
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
    """SIM_ parameters that are set; "{n}" stands for the instance."""
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
        names = (name.format(n=1) for name in self.values)
        return all(name in table and table[name].has_effect for name in names)


EFFECTS: tuple[Effect, ...] = (
    Effect("gps", "off", {"SIM_GPS1_ENABLE": 0}, "no receiver any more"),
    Effect("gps", "wrong", {"SIM_GPS1_GLTCH_X": (AMOUNT, _METRE)}, "fixes lie to the north", 50.0, "[m]"),
    Effect("gps", "garbage", {"SIM_GPS1_JAM": 1}, "jammed: place, speed and satellites jump"),
    Effect("gps", "delayed", {"SIM_GPS1_LAG_MS": (AMOUNT, 1000.0)}, "fixes come late", 0.5, "[s]"),
    Effect("gps", "intermittent", {"SIM_GPS1_BYTELOS": (AMOUNT, 100.0)}, "bytes are lost", 0.01, "share"),
    Effect("gyro", "wrong", {"SIM_GYR{n}_BIAS_X": AMOUNT}, "the roll rate that it shows is off", 0.5, "[rad/s]", 2),
    Effect("gyro", "off", {"SIM_GYR_FAIL_MSK": MASK}, "the gyro sends nothing", instances=2),
    Effect("accel", "wrong", {"SIM_ACC{n}_BIAS_X": AMOUNT}, "it shows so much too much forward", 5.0, "[m/s/s]", 2),
    Effect("accel", "off", {"SIM_ACC_FAIL_MSK": MASK}, "the accelerometer sends nothing", instances=2),
    Effect("accel", "stuck", {"SIM_ACCEL{n}_FAIL": AMOUNT}, "all axes show one number", 20.0, "[m/s/s]", 2),
    Effect("mag", "off", {"SIM_MAG{n}_FAIL": 1}, "the compass sends nothing", instances=3),
    Effect("mag", "wrong", {"SIM_MAG{n}_OFS_X": AMOUNT}, "hard iron ahead of it", 400.0, "[mGauss]", 3),
    Effect("baro", "off", {"SIM_BARO_DISABLE": 1}, "no samples any more"),
    Effect("baro", "stuck", {"SIM_BARO_FREEZE": 1}, "the same height for ever"),
    Effect("baro", "garbage", {"SIM_BARO_RND": AMOUNT}, "noise", 3.0, "[m]"),
    Effect("baro", "wrong", {"SIM_BARO_GLITCH": AMOUNT}, "another height", 10.0, "[m]"),
    Effect("baro", "slow", {"SIM_BARO_DRIFT": AMOUNT}, "the height drifts away", 0.5, "[m/s]"),
    Effect("baro", "delayed", {"SIM_BARO_DELAY": (AMOUNT, 1000.0)}, "samples come late", 0.5, "[s]"),
    Effect("battery", "wrong", {"SIM_BATT_VOLTAGE": AMOUNT}, "another voltage of the full battery", 10.0, "[V]"),
    Effect("battery", "slow", {"SIM_BATT_RES": AMOUNT}, "the voltage sags under load", 0.1, "[Ohm]"),
    Effect("motor", "off", {"SIM_ENGINE_MUL": AMOUNT, "SIM_ENGINE_FAIL": MASK}, "weaker motors", 0.0, "share left", 8),
    Effect("motor", "stuck", {"SIM_ENGINE_STUCK": MASK}, "motors stay at their command", instances=8),
    Effect("servo", "off", {"SIM_ENGINE_MUL": AMOUNT, "SIM_ENGINE_FAIL": MASK}, "weaker outputs", 0.0, "share left", 8),
    Effect("servo", "stuck", {"SIM_ENGINE_STUCK": MASK}, "outputs stay as they are", instances=8),
    Effect("rc", "off", {"SIM_RC_FAIL": 1}, "the transmitter is silent"),
    Effect("rc", "wrong", {"SIM_RC_FAIL": 2}, "sticks centred, throttle at 950 us"),
    Effect("rc", "stuck", {"SIM_RC_STUCK": MASK}, "channels stay as they are", instances=16),
    Effect("rc", "garbage", {"SIM_RC_NOISE": AMOUNT}, "noise on all channels", 100.0, "[us]"),
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


def known(table: Table) -> dict[str, dict[str, Effect]]:
    """Unit -> type -> effect: those that a vehicle with these parameters has."""
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
        object.__setattr__(self, "unit", OTHER_NAMES.get(self.unit, self.unit))
        if self.amount is not None and not _is_finite(self.amount):
            raise OptionError(f"fault {self.unit}: amount {self.amount!r} is not a finite number")
        if not isinstance(self.instance, int) or isinstance(self.instance, bool):
            raise OptionError(f"fault {self.unit}: instance {self.instance!r} is not a whole number")
        for name, time in (("begin", self.begin), ("end", self.begin if self.end is None else self.end)):
            if not (_is_finite(time) and 0.0 <= time <= LATEST_S):
                raise OptionError(f"fault {self.unit}: {name} {time!r} is not a time from 0 to {LATEST_S:g} s")
        if self.end is not None and self.end <= self.begin:
            raise OptionError(f"fault {self.unit}: its end, {self.end:g} s, is not after its begin, {self.begin:g} s")

    @classmethod
    def of_text(cls, text: str) -> Failure:
        """``UNIT[:INSTANCE][/TYPE][=AMOUNT][@BEGIN[..END]]``: "gps@12", "motor:2=0.5@20..30", "SIM_WIND_DIR=90".

        Raises:
            OptionError: it is none.
        """
        found = _FORM.fullmatch(text.strip())
        try:
            if found is None:
                raise ValueError
            unit, instance, kind, amount, begin, end = found.groups()
            return cls(
                unit, kind or "", int(instance or 0), None if amount is None else float(amount), float(begin or 0.0),
                None if end is None else float(end),
            )  # fmt: skip
        except OptionError:
            raise
        except ValueError:
            raise OptionError(f"fault {text!r} is not {FORM}, as in gps@12 or motor:2=0.5@20..30") from None

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
        if self.unit.startswith("SIM_"):
            if self.unit not in table or not table[self.unit].has_effect:
                names = [p.name for p in table.with_effect if p.name.startswith("SIM_")]
                raise OptionError(f"fault {self.unit}: no such parameter has an effect{did_you_mean(self.unit, names)}")
            if self.type or self.instance or self.amount is None:
                raise OptionError(f"fault {self.unit}: a parameter takes a value and nothing else, as {self.unit}=1")
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
        if self.unit.startswith("SIM_"):
            return {self.unit: float(self.amount or 0.0)}
        effect = known(table)[self.unit][self.type]
        amount = self.amount if self.amount is not None else effect.amount or 0.0
        which = [self.instance] if self.instance else list(range(1, effect.instances + 1))
        found = {}
        for name, value in effect.values.items():
            for n in which if "{n}" in name else which[:1]:
                full = name.format(n=n)
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


def parameters_of(unit: str, table: Table) -> Iterator[str]:
    """Names of all parameters that faults of a unit set ("": of all units, none but those of the table).

    Raises:
        OptionError: there is no such unit.
    """
    unit = OTHER_NAMES.get(unit, unit)
    units = known(table)
    if unit in table:
        yield unit
    elif unit and unit not in units:
        raise OptionError(f"there is no fault {unit!r}; there are {', '.join(units)}")
    else:
        for types in [units[unit]] if unit else list(units.values()):
            for effect in types.values():
                for name in effect.values:
                    yield from (name.format(n=k) for k in range(1, effect.instances + 1 if "{n}" in name else 2))


def masks_of(unit: str, table: Table) -> Sequence[str]:
    """Those of them that are masks of instances."""
    types = known(table).get(OTHER_NAMES.get(unit, unit), {})
    return [name for effect in types.values() for name, value in effect.values.items() if value == MASK]


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
