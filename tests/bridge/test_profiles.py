# SPDX-License-Identifier: BSD-3-Clause
"""The firmwares' faces fit the services that read them."""

from __future__ import annotations

import inspect
from collections import Counter

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.profile import Profile, load
from sitl.bridge.telemetry.builder import messages
from sitl.bridge.wire.choose import message_of
from sitl.vehicle.kinds import KINDS

NAMES = tuple(KINDS)
PROFILES = [load(name) for name in NAMES]


@pytest.mark.parametrize(("name", "profile"), list(zip(NAMES, PROFILES, strict=True)), ids=NAMES)
def test_it_says_the_type_of_its_kind(name: str, profile: Profile) -> None:
    assert profile.mav_type == KINDS[name].mav_type


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_streams(profile: Profile) -> None:
    sent = Counter(name for _, names in profile.groups.values() for name in names)
    assert sent and max(sent.values()) == 1, "a message has one group"
    assert set(sent) <= {message_of(law).kind.name for law in messages(profile)}


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_commands(profile: Profile) -> None:
    known = mavlink.enums["MAV_CMD"]
    for number, entry in profile.commands.items():
        assert number in known
        assert (inspect.getdoc(entry.run) or "").startswith(tuple("123456789")), "begins with its number"


@pytest.mark.parametrize(("name", "profile"), list(zip(NAMES, PROFILES, strict=True)), ids=NAMES)
def test_modes(name: str, profile: Profile) -> None:
    names = {mode.number: mode.name for mode in profile.modes}
    assert names == dict(KINDS[name].firmware.mode_names)
    assert [names[number] for number in (profile.auto, profile.guided, profile.rtl)] == ["AUTO", "GUIDED", "RTL"]
    for stick in profile.sticks:
        assert stick.parameter in KINDS[name].firmware.table
        assert stick.axis in mavlink.MAVLink_manual_control_message.fieldnames
