# SPDX-License-Identifier: BSD-3-Clause
"""Sticks, storage, statistics and numbered logs, in this process."""

from __future__ import annotations

import json
import math
import os
import struct
import sysconfig
from pathlib import Path

import pytest

from sitl import vehicles
from sitl.autopilot.mission.item import MissionItem, home_item
from sitl.bridge.services.parameter_protocol import ParameterService
from sitl.bridge.signing import SigningState
from sitl.core.mavlink import MavCmd
from sitl.core.vectors import Vec3
from sitl.drop_in import server
from sitl.drop_in.command_line import parse
from sitl.drop_in.server import Session
from sitl.drop_in.statistics import SINCE_S, Statistics
from sitl.drop_in.stick_port import StickPort
from sitl.drop_in.storage import Storage, StorageError
from sitl.errors import OptionError
from sitl.foreign.choice import choose
from sitl.logs.dataflash.log import attach
from sitl.logs.dataflash.numbered import NumberedLogs
from sitl.simulation import Core, Simulation
from tests import mutations
from tests.full_disk import WORDS, full_disk
from tests.logs.dataflash.conftest import read_log


@pytest.fixture
def simulation(core: Core) -> Simulation:
    return Simulation("ardupilot_quad", core=core)


def test_sixteen_sticks_reach_the_radio_and_stay(simulation: Simulation) -> None:
    port = StickPort(simulation.v, "127.0.0.1", 0)
    rc = simulation.v.autopilot.rc
    port.receive(struct.pack("<16H", *range(1200, 1216)))
    simulation.advance(30.0)  # no other frame: the receiver repeats the last one
    assert [int(pulse) for pulse in rc.channels] == [*range(1200, 1216), 0, 0]
    assert rc.receiver_ok
    port.receive(struct.pack("<8H", 0, *range(1301, 1308)))
    simulation.advance(0.1)
    assert [int(pulse) for pulse in rc.channels] == [1200, *range(1301, 1308), *range(1208, 1216), 0, 0]
    port.close()


def test_channels_that_were_never_sent_are_at_rest(simulation: Simulation) -> None:
    port = StickPort(simulation.v, "127.0.0.1", 0, 1000)
    port.receive(struct.pack("<16H", *(0,) * 7, 1165, *(0,) * 8))
    simulation.advance(1.0)
    rc = simulation.v.autopilot.rc
    assert rc.receiver_ok
    assert [int(pulse) for pulse in rc.channels[:10]] == [1500, 1500, 1000, 1500, 1800, 1000, 1000, 1165, 0, 0]
    port.close()


def test_a_failing_transmitter_is_lost_although_sticks_come(simulation: Simulation) -> None:
    port = StickPort(simulation.v, "127.0.0.1", 0)
    port.receive(struct.pack("<16H", *(1500,) * 16))
    simulation.advance(1.0)
    assert simulation.v.autopilot.rc.receiver_ok
    simulation.v.autopilot.params.SIM.RC_FAIL = 1
    simulation.parameter_changed("SIM_RC_FAIL")
    simulation.advance(3.0)
    assert not simulation.v.autopilot.rc.receiver_ok
    port.close()


def test_storage_keeps_and_forgets(tmp_path: Path) -> None:
    path = tmp_path / "kept.json"
    storage = Storage(path)
    storage.write()
    assert not path.exists(), "nothing to keep"
    items = (home_item(1, 2, 3.0), MissionItem(MavCmd.NAV_WAYPOINT, x=5, y=6, z=7.5))
    storage.keep("WPNAV_SPEED", 450.0)
    storage.keep_mission(items)
    fence = tuple(MissionItem(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0, 3.0, x=k, y=k * k) for k in range(3))
    points = (MissionItem(MavCmd.NAV_RALLY_POINT, x=5, y=6, z=7.0),)
    storage.keep_lists(fence, points)
    storage.write()
    again = Storage(path)
    assert (again.parameters, again.mission) == ({"WPNAV_SPEED": 450.0}, items)
    assert (again.fence, again.rally) == (fence, points)
    assert [file.name for file in tmp_path.iterdir()] == ["kept.json"]
    assert Storage.wiped(path).parameters == {} and not path.exists()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[]",
        '{"parameters": {"A": "b"}, "mission": []}',
        '{"parameters": 5}',
        '{"parameters": {}, "mission": [], "fence": [[5001, 0, 2]]}',
        '{"parameters": {"A": 1e999}, "mission": [[16, 0, 0, 0, 0, 0, 1.5]]}',
        f'{{"parameters": {{"A": {10**400}}}, "mission": []}}',
        '{"parameters": {}, "mission": [], "rally": [[5100, 0, 0, 0, 0, 0, 1, 2, 1e30]]}',
        '{"parameters": {}, "mission": [], "fence": [[5001, 0, 1e39, 0, 0, 0, 1, 2, 0]]}',
        '{"parameters": {}, "mission": [[16, 0, 0, 0, 0, 0, 99999999999, 0, 0]]}',
        '{"parameters": {}, "mission": [], "signing": ["", 1e400]}',
    ],
)
def test_damaged_storage_is_named(tmp_path: Path, text: str) -> None:
    path = tmp_path / "kept.json"
    path.write_text(text)
    with pytest.raises(StorageError, match=r"kept.json' is damaged .*-w begins anew"):
        Storage(path)


def test_storage_with_any_damage_is_read_or_named(tmp_path: Path) -> None:
    path = tmp_path / "kept.json"
    storage = Storage(path)
    storage.keep("WPNAV_SPEED", 450.0)
    storage.keep_mission((home_item(1, 2, 3.0), MissionItem(MavCmd.NAV_WAYPOINT, x=5, y=6, z=7.5)))
    fence = tuple(MissionItem(MavCmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0, 3.0, x=k, y=k * k) for k in range(3))
    storage.keep_lists(fence, (MissionItem(MavCmd.NAV_RALLY_POINT, x=5, y=6, z=7.0),))
    storage.keep_signing(SigningState(bytes(32), 7))
    storage.write()
    content = path.read_bytes()
    changed = (json.dumps(value).encode() for value in mutations.of_json(json.loads(content), 300))
    kinds = set()
    for damaged in (*changed, *mutations.of_bytes(content, 100)):
        path.write_bytes(damaged)
        kinds.add(type(mutations.read_or_refused(lambda: Storage(path), StorageError, str(path))))
    assert kinds == {Storage, type(None)}


def test_storage_that_cannot_be_written_stays_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "kept.json"
    storage = Storage(path)
    storage.keep("WPNAV_SPEED", 450.0)
    storage.write()
    storage.keep("WPNAV_SPEED", 500.0)
    with full_disk(), pytest.raises(StorageError, match=rf"kept\.json' cannot be written: {WORDS}"):
        storage.write()
    assert Storage(path).parameters == {"WPNAV_SPEED": 450.0}
    assert [file.name for file in tmp_path.iterdir()] == ["kept.json"]
    storage.write()  # there is room again
    assert Storage(path).parameters == {"WPNAV_SPEED": 500.0}


def test_statistics_count_boots_and_time(simulation: Simulation) -> None:
    kept: dict[str, float] = {}
    statistics = Statistics(simulation, kept.__setitem__)
    params = simulation.v.autopilot.params
    assert kept == {"STAT_BOOTCNT": 1.0} and params["STAT_BOOTCNT"] == 1.0
    for _ in range(95):
        simulation.advance(1.0)
        statistics.follow()
    assert (params["STAT_RUNTIME"], params["STAT_FLTTIME"]) == (90.0, 0.0), "kept each half minute"
    simulation.request_reboot()
    simulation.advance(0.0)
    statistics.follow()
    assert params["STAT_BOOTCNT"] == kept["STAT_BOOTCNT"] == 2.0
    params["STAT_RESET"] = 0.0
    simulation.advance(1.0)
    statistics.follow()
    assert [params[f"STAT_{name}"] for name in ("BOOTCNT", "RUNTIME")] == [0.0, 0.0]
    assert params["STAT_RESET"] == simulation.bridge.epoch_us // 1_000_000 + 96 - SINCE_S


def test_statistics_count_flights_and_what_is_flown(simulation: Simulation) -> None:
    kept: dict[str, float] = {}
    statistics = Statistics(simulation, kept.__setitem__)
    ap = simulation.v.autopilot
    ap.arming.armed, ap.arming.landed = True, False
    for north in (0.0, 3.0, 3.2, 1000.0):
        ap.estimate.pos = Vec3(north, 0.0, 0.0)
        statistics._second()
    assert "STAT_FLTCNT" not in kept, "up to the last half minute"
    ap.arming.landed = True
    statistics._second()
    assert [kept[f"STAT_{name}"] for name in ("FLTCNT", "FLTTIME", "RUNTIME")] == [1.0, 4.0, 5.0]
    assert kept["STAT_DISTFLWN"] == 303.0, "less than half a metre in a second is noise, more than 300 m an error"
    assert simulation.parameters["STAT_DISTFLWN"] == 303.0


def test_logs_are_numbered_over_runs(core: Core, tmp_path: Path) -> None:
    folder = tmp_path / "logs"
    for number in (1, 2):
        simulation = Simulation("ardupilot_quad", core=core, params={"LOG_DISARMED": 1})
        logs = attach(simulation, folder, NumberedLogs)
        simulation.advance(2.0)
        entries = logs.entries()
        assert [entry.number for entry in entries] == list(range(1, number + 1)), "those of earlier runs, too"
        path = folder / f"{number:08d}.BIN"
        assert logs.read(number, 0, 1 << 30) == path.read_bytes() and entries[-1].size == path.stat().st_size > 1000
        simulation.close()
        assert (folder / "LASTLOG.TXT").read_bytes() == b"%d\r\n" % number
    simulation = Simulation("ardupilot_quad", core=core, params={"LOG_DISARMED": 1})
    logs = attach(simulation, folder, NumberedLogs)
    logs.erase()
    assert list(folder.iterdir()) == [] and logs.entries() == []
    simulation.close()


def test_what_a_fault_sets_is_not_kept(core: Core, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A real one keeps SIM_ parameters that a client sets, and so does this one."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Session, "_open_ports", lambda session: None)
    session = Session("ardurover", parse(["-w"]), say=lambda text: None)
    simulation = session.simulation
    set_parameter = simulation.bridge.get(ParameterService).set
    for text in ("gps@0.5..1", "battery=9", "rc"):
        simulation.fail(text)
    set_parameter("SIM_WIND_SPD", 3.0)
    set_parameter("SIM_RC_FAIL", 2.0)
    simulation.advance(0.7)
    assert simulation.parameters["SIM_GPS1_ENABLE"] == 0.0
    simulation.advance(0.7)
    session.close()
    kept = Storage(tmp_path / "ardurover-storage.json").parameters
    assert {name: value for name, value in kept.items() if name.startswith("SIM_")} == {
        "SIM_WIND_SPD": 3.0, "SIM_RC_FAIL": 2.0,
    }  # fmt: skip


def test_logs_tell_defaults_of_files_and_what_is_counted(
    core: Core, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Session, "_open_ports", lambda session: None)
    (tmp_path / "files.parm").write_text("WP_SPEED 1.5\nLOG_DISARMED 1\n")
    session = Session("ardurover", parse(["-w", "--defaults", "files.parm"]), say=lambda text: None)
    simulation = session.simulation
    simulation.bridge.get(ParameterService).set("WP_SPEED", 3.0)
    simulation.advance(31.0)
    for _ in range(31):
        session._statistics._second()
    session.close()
    rows = [(m.Name, m.Value, m.Default) for m in read_log(tmp_path / "logs" / "00000001.BIN")["PARM"]]
    assert ("WP_SPEED", 3.0, 1.5) in rows and ("LOG_DISARMED", 1.0, 1.0) in rows
    later = [(name, value) for name, value, default in rows if math.isnan(default)]
    assert later == [("MIS_TOTAL", 1.0), ("STAT_RUNTIME", 30.0)]


def test_a_model_that_there_is_not_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(OptionError, match=r"--model 'zeppelin' is none of \+, quad, .*JSON:HOST.*erle_copter"):
        Session("arducopter", parse(["--model", "zeppelin"]))


def test_a_model_may_be_the_file_of_an_airframe_of_this_kind(tmp_path: Path) -> None:
    for frame in ("erle_copter", "erle_rover"):
        (tmp_path / f"{frame}.toml").write_text(vehicles.to_toml(vehicles.load(frame)))
    own, rover = (str(tmp_path / f"{frame}.toml") for frame in ("erle_copter", "erle_rover"))
    assert server._model("copter", parse(["--model", own])) == (own, "native")
    with pytest.raises(OptionError, match=r"erle_rover\.toml' is a rover; this program runs a copter"):
        server._model("copter", parse(["--model", rover]))


def test_the_search_for_a_real_one_passes_our_scripts_by(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ours", "real"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "arducopter").write_text("#!/bin/sh\n")
        (tmp_path / name / "arducopter").chmod(0o755)
    monkeypatch.setattr(sysconfig, "get_path", lambda name: str(tmp_path / "ours"))
    monkeypatch.setenv("PATH", os.pathsep.join(str(tmp_path / name) for name in ("ours", "real")))
    choice = choose("ardupilot", "copter")
    assert choice is not None and choice.program == (tmp_path / "real" / "arducopter").resolve()
    monkeypatch.setenv("PATH", str(tmp_path / "ours"))
    with pytest.raises(OptionError, match="no program 'arducopter' in PATH"):
        choose("ardupilot", "copter")
