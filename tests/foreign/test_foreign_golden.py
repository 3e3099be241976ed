# SPDX-License-Identifier: BSD-3-Clause
"""Golden flights of a program that stands in for ArduPilot: digests of all true states."""

from __future__ import annotations

import json

import pytest

from sitl.errors import OptionError
from sitl.missions.testing.factory import VehicleFactory
from sitl.missions.testing.golden import GoldenStore
from sitl.missions.testing.setup import Defaults


@pytest.fixture
def flown(tmp_path, ardurover):
    """``flown(update=..., seconds=..., **options)``: a vehicle that has been on for so long, and its golden's path."""
    factories = []

    def make(update: bool = False, seconds: float = 2.5, autopilot: str = f"ardupilot:{ardurover}", **options):
        store = GoldenStore(tmp_path, update)
        factories.append(VehicleFactory(Defaults(autopilot=autopilot), store, tmp_path / "logs"))
        vehicle = factories[-1]("rover", ready=False, **options)
        vehicle.delay(seconds)
        return vehicle

    yield make
    for factory in factories:
        factory.close()


def test_a_flight_is_its_golden_and_another_is_not(flown, tmp_path):
    first = flown(update=True)
    first.assert_flies_like("golden/stand.digests")
    kept = json.loads((tmp_path / "golden/stand.digests").read_text())
    assert kept["program"] == "ardurover" and len(kept["digests"]) == len(first.connection.digests) > 2
    again = flown()
    again.assert_flies_like("golden/stand.digests")
    assert again.connection.digests == first.connection.digests
    with pytest.raises(AssertionError, match="true states are other ones between 0 and 1 s"):
        flown(params={"SIM_WIND_SPD": 3.0}).assert_flies_like("golden/stand.digests")
    with pytest.raises(AssertionError, match=r"golden [0-9]+$|golden [0-9]+\n"):
        flown(seconds=4.5).assert_flies_like("golden/stand.digests")


def test_what_cannot_be_compared_is_refused(flown, tmp_path):
    vehicle = flown(seconds=0.1)
    with pytest.raises(AssertionError, match="there is no golden flight"):
        vehicle.assert_flies_like("none.digests")
    with pytest.raises(OptionError, match="compared exactly"):
        vehicle.assert_flies_like("none.digests", "0.5 m")
    with pytest.raises(OptionError, match=r"golden flights of a real ArduPilot are \.digests"):
        vehicle.assert_flies_like("none.rec")
    (tmp_path / "bad.digests").write_text("[]")
    with pytest.raises(AssertionError, match="cannot be used"):
        vehicle.assert_flies_like("bad.digests")


def test_a_flight_with_a_log_or_of_our_own_has_no_digests(flown):
    with pytest.raises(OptionError, match="ArduPilot that was started here"):
        flown(seconds=0.1, params={"LOG_BACKEND_TYPE": 1.0}).assert_flies_like("x.digests")
    with pytest.raises(OptionError, match="ArduPilot that was started here"):
        flown(seconds=0.1, autopilot="native").assert_flies_like("x.digests")
