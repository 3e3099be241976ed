# SPDX-License-Identifier: BSD-3-Clause
"""The firmwares' faces fit the services that read them."""

from __future__ import annotations

import inspect
from collections import Counter

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.profile import Profile, load
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
    assert set(sent) <= {message_of(law).kind.name for law in profile.core.builders}


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


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_messages_that_laws_take(profile: Profile) -> None:
    assert {message_of(law).kind.name for law in profile.takes} == {
        "SET_POSITION_TARGET_LOCAL_NED",
        "SET_POSITION_TARGET_GLOBAL_INT",
        "SET_ATTITUDE_TARGET",
        "RC_CHANNELS_OVERRIDE",
        "MANUAL_CONTROL",
    }
