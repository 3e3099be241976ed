# SPDX-License-Identifier: BSD-3-Clause
"""The firmwares' profiles fit the services that read them, and the page about MAVLink says what the code does."""

from __future__ import annotations

import inspect
import re
from collections import Counter
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge import docs
from sitl.bridge.dialect import message_by_id
from sitl.bridge.profile import Profile, load
from sitl.bridge.telemetry.builder import builders
from sitl.vehicle.kinds import KINDS
from tests.bridge.fakes import Bench

NAMES = tuple(KINDS)
PROFILES = [load(name) for name in NAMES]


@pytest.mark.parametrize(("name", "profile"), list(zip(NAMES, PROFILES, strict=True)), ids=NAMES)
def test_it_says_the_type_of_its_kind(name: str, profile: Profile) -> None:
    assert profile.mav_type == KINDS[name].mav_type


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_streams(profile: Profile) -> None:
    sent = Counter(name for _, names in profile.groups.values() for name in names)
    assert sent and max(sent.values()) == 1, "a message has one group"
    assert set(sent) <= set(builders(profile))


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


DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_up_to_date() -> None:
    template = (DOCS / "templates" / "mavlink.md").read_text(encoding="utf-8")
    assert (DOCS / "mavlink.md").read_text(encoding="utf-8") == docs.page(template), "run: python docs/make_pages.py"


def test_every_message_in_and_out_is_on_the_page(bench: Bench) -> None:
    page = (DOCS / "mavlink.md").read_text(encoding="utf-8")
    assert set(docs.handled()) == {message_by_id(number).name for number in bench.bridge._handlers}
    for name in docs.handled():
        assert f"{name} (" in page
    for kind, _ in bench.bridge.telemetry.values():
        assert f"| {kind.id} | {kind.name} |" in page
    assert not re.search(r"\{\w+\}", page), "a table is missing"


def test_every_command_says_what_it_does() -> None:
    for line in docs.commands().splitlines()[2:]:
        assert len(line.split("|")[5].strip()) > 10, line
