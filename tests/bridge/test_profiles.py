# SPDX-License-Identifier: BSD-3-Clause
"""The firmwares' profiles fit the services that read them, and the page about MAVLink says what the code does."""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge import docs, services
from sitl.bridge.dialect import message_by_id
from sitl.bridge.docs import BY_SERVICES
from sitl.bridge.firmware_profile import Profile, load
from sitl.bridge.services.service import Handler, Service
from sitl.bridge.wire.choose import message_of
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
    assert set(sent) <= {*BY_SERVICES, *(message_of(law).kind.name for law in profile.core.builders)}


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_numbers_of_streams_are_mavlinks(profile: Profile) -> None:
    """MAV_DATA_STREAM, under the names of ArduPilot's parameters."""
    assert {number: name for number, (name, _) in profile.groups.items()} == {
        mavlink.MAV_DATA_STREAM_RAW_SENSORS: "RAW_SENS", mavlink.MAV_DATA_STREAM_EXTENDED_STATUS: "EXT_STAT",
        mavlink.MAV_DATA_STREAM_RC_CHANNELS: "RC_CHAN", mavlink.MAV_DATA_STREAM_RAW_CONTROLLER: "RAW_CTRL",
        mavlink.MAV_DATA_STREAM_POSITION: "POSITION", mavlink.MAV_DATA_STREAM_EXTRA1: "EXTRA1",
        mavlink.MAV_DATA_STREAM_EXTRA2: "EXTRA2", mavlink.MAV_DATA_STREAM_EXTRA3: "EXTRA3",
    }  # fmt: skip


def test_who_it_says_it_is(bench: Bench) -> None:
    """The capabilities of an ArduCopter, and the version that is followed."""
    (m,) = bench.telemetry("AUTOPILOT_VERSION")
    assert (m.capabilities, m.flight_sw_version, m.uid) == (0xFBEF, 4 << 24 | 7 << 16, 1)
    assert len(bytes(m.flight_custom_version)) == 8 and int(bytes(m.flight_custom_version), 16) >= 0


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_commands(profile: Profile) -> None:
    known = mavlink.enums["MAV_CMD"]
    for number, entry in profile.commands.items():
        assert number in known or number in docs.NEWER
        assert (inspect.getdoc(entry.run) or "").startswith(tuple("123456789")), "begins with its number"


@pytest.mark.parametrize(("name", "profile"), list(zip(NAMES, PROFILES, strict=True)), ids=NAMES)
def test_modes(name: str, profile: Profile) -> None:
    names = {mode.number: mode.name for mode in profile.modes}
    assert names == dict(KINDS[name].firmware.mode_names)
    assert [names[number] for number in (profile.auto, profile.guided, profile.rtl)] == ["AUTO", "GUIDED", "RTL"]


@pytest.mark.parametrize("profile", PROFILES, ids=NAMES)
def test_messages_that_laws_take(profile: Profile) -> None:
    assert {message_of(law).kind.name for law in profile.core.takers} == {
        "SET_POSITION_TARGET_LOCAL_NED",
        "SET_POSITION_TARGET_GLOBAL_INT",
        "SET_ATTITUDE_TARGET",
        "RC_CHANNELS_OVERRIDE",
        "MANUAL_CONTROL",
        "GLOBAL_POSITION_INT",
        "FOLLOW_TARGET",
        "LANDING_TARGET",
        "OBSTACLE_DISTANCE",
        "DISTANCE_SENSOR",
        "OBSTACLE_DISTANCE_3D",
        "OPTICAL_FLOW",
        "VISION_POSITION_ESTIMATE",
        "GLOBAL_VISION_POSITION_ESTIMATE",
        "VICON_POSITION_ESTIMATE",
        "ATT_POS_MOCAP",
        "VISION_SPEED_ESTIMATE",
        "VISION_POSITION_DELTA",
        "ODOMETRY",
    }


DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_up_to_date() -> None:
    template = (DOCS / "templates" / "mavlink.md").read_text(encoding="utf-8")
    assert (DOCS / "mavlink.md").read_text(encoding="utf-8") == docs.page(template), (
        "run: python docs/make_pages.py mavlink"
    )


def make_pages(*words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(DOCS / "make_pages.py"), *words]
    environment = os.environ | {"PYTHONPATH": str(DOCS.parent)}
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)


def test_a_page_that_is_not_made_is_refused_by_name() -> None:
    done = make_pages("mavlink", "extending")
    assert done.returncode == 2
    assert done.stderr.endswith("page 'extending' is not made here; there are comparison, mavlink, physics\n")


def test_every_message_in_and_out_is_on_the_page(bench: Bench) -> None:
    page = (DOCS / "mavlink.md").read_text(encoding="utf-8")
    assert set(docs.handled()) == {message_by_id(number).name for number in bench.bridge._handlers}
    taken = {message_of(law).kind.name for profile in PROFILES for law in profile.core.takers}
    for name in docs.handled().keys() | taken:
        assert f"{name} (" in page
    for kind in bench.bridge.telemetry.values():
        assert f"| {kind.id} | {kind.name} |" in page
    assert not re.search(r"\{\w+\}", page), "a table is missing"


def test_every_command_says_what_it_does() -> None:
    for line in docs.commands().splitlines()[2:]:
        assert len(line.split("|")[5].strip()) > 10, line


def test_services_of_others_are_known_once(monkeypatch: pytest.MonkeyPatch) -> None:
    class Own(Service):
        pass

    monkeypatch.setattr(services, "_registered", [])
    for _ in range(2):
        services.register_service(Own)
    assert services.all_services() == (*services.ALL_SERVICES, Own)
    for odd in ("Own", int):
        with pytest.raises(TypeError, match="is no subclass"):
            services.register_service(odd)  # type: ignore[arg-type]
    assert isinstance(Bench().bridge.get(Own), Own)


@pytest.mark.parametrize(
    ("taken", "said"),
    [("PING", "two services handle PING"), ("SET_ATTITUDE_TARGET", "SET_ATTITUDE_TARGET, which a law")],
)
def test_a_message_is_taken_in_one_place(taken: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    class Second(Service):
        def handlers(self) -> dict[str, Handler]:
            return {taken: lambda channel, fields, sender: None}

    monkeypatch.setattr(services, "_registered", [Second])
    with pytest.raises(ValueError, match=said):
        Bench()


def test_what_is_no_service_cannot_be_registered() -> None:
    with pytest.raises(TypeError, match="is no subclass of sitl"):
        services.register_service(Bench)  # type: ignore[arg-type]
