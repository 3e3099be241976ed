# SPDX-License-Identifier: BSD-3-Clause
"""Parameters as typed records, and the table made of them."""

from __future__ import annotations

import pytest

from sitl.autopilot.copter.parameters import TABLE as COPTER
from sitl.autopilot.params import parameters
from sitl.autopilot.params.parameter import INT8, ParameterGroup, group, numbered, param, rows
from sitl.autopilot.params.table import Table
from sitl.autopilot.rover.parameters import TABLE as ROVER
from sitl.core.record_reader import UnknownFieldError, locate
from sitl.core.records import Floats, Records


class Gains(ParameterGroup):
    P: float = param(1.0, 0.0, 5.0, "1/s", "proportional gain")
    D: float = param(0.0, 0.0, 1.0, "", "derivative gain")


class Winch(ParameterGroup):
    TYPE: float = param(0, 0, 3, "", "0: none", INT8)
    RATE: Gains = group("Winch", P={"default": 2.0, "high": 9.0}, D={"doc": "Winch: none is needed"})


class Channel(ParameterGroup):
    MIN: float = param(1100, 800, 2200, "us", "Least pulse of channel {n}")


class Gps(ParameterGroup):
    DELAY_MS: float = param(0, 0, 350, "ms", "age of a fix")


class Twice(parameters.Parameters):
    GPS1: Gps


class Wrong(ParameterGroup):
    RATE: Gains = group("x", Q=1.0)


class Toy(parameters.Parameters):
    """A firmware with a winch."""

    WINCH: Winch
    MODE: Floats = param(5, 0, 9, "", "Mode at position {n}", INT8, count=2)
    CH: Records[Channel] = numbered(Channel, 2, MIN=(1000, 1200))
    SIM: parameters.Simulated


@pytest.mark.parametrize("table", [COPTER, ROVER, Table(Toy)])
def test_the_order_on_the_wire_is_the_order_in_memory(table):
    params = table.record()
    assert table.record.dtype.itemsize == 8 * len(table)
    for k, row in enumerate(table):
        assert locate(table.record.dtype, row.path) == (8 * k, "d", 1)
        params[row.name] = k
    assert list(memoryview(params._bytes).cast("d")) == list(range(len(table)))


def test_names_paths_and_changes():
    table = Table(Toy)
    own = [row for row in table if row.name.startswith(("WINCH", "MODE", "CH"))]
    assert [(row.name, row.path) for row in own] == [
        ("WINCH_TYPE", "WINCH.TYPE"),
        ("WINCH_RATE_P", "WINCH.RATE.P"),
        ("WINCH_RATE_D", "WINCH.RATE.D"),
        ("MODE1", "MODE[0]"),
        ("MODE2", "MODE[1]"),
        ("CH1_MIN", "CH[0].MIN"),
        ("CH2_MIN", "CH[1].MIN"),
    ]
    gain = table["WINCH_RATE_P"]
    assert gain[1:6] == (2.0, 0.0, 9.0, "1/s", "Winch: proportional gain")
    assert table["WINCH_RATE_D"].doc == "Winch: none is needed"
    assert table["MODE2"].doc == "Mode at position 2"
    assert (table["CH2_MIN"].default, table["CH2_MIN"].doc) == (1200, "Least pulse of channel 2")
    assert gain.refusal(10.0) == "WINCH_RATE_P: 10 is outside 0 .. 9 1/s"
    # Declared again, a group goes to its new place; what the firmware does not name comes first.
    assert table.names()[0] == "ARMING_RUDDER" and table.names()[-1].startswith("SIM_")


def test_a_parameter_by_its_full_name_is_the_one_at_its_path():
    params = Table(Toy).record()
    params.WINCH_RATE_P = 0.5
    params["CH2_MIN"] = 900
    assert (params.WINCH.RATE.P, params.CH[1].MIN) == (0.5, 900.0)
    params.WINCH.RATE.P = 0.75
    assert params.WINCH_RATE_P == params["WINCH_RATE_P"] == 0.75
    with pytest.raises(AttributeError):
        params.WINCH_RATE_Q = 1.0


def test_what_cannot_be():
    with pytest.raises(ValueError, match=r"RATE\.: \['Q'\] changed, which Gains does not have"):
        list(rows(Wrong))
    with pytest.raises(ValueError, match=r"parameters defined twice: \['GPS1_DELAY_MS'\]"):
        Table(Twice)
    with pytest.raises(UnknownFieldError, match=r"no element \[2\] of 'MODE'"):
        locate(Toy.dtype, "MODE[2]")
