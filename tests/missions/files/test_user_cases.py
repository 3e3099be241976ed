# SPDX-License-Identifier: BSD-3-Clause
"""Small files of the kinds that users have: each is read, converted and flown, or refused with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl import cli
from sitl.core.mavlink import MavCmd
from sitl.missions.files import MissionFileError, load

CASES = Path(__file__).parent / "cases"


def commands(name: str) -> list[int]:
    """Commands of a mission, home first."""
    return [item.command for item in load(CASES / name).mission.items]


def test_numbers_are_those_of_the_lines() -> None:
    assert commands("gap.txt") == [16, 22, 16, 20]


def test_command_0_is_home() -> None:
    assert commands("cmd0home.txt") == [16, 22, 16, 20]
    assert load(CASES / "cmd0home.txt").home == pytest.approx((-35.363261, 149.16523, 584.0))


def test_the_line_of_a_jump_to_home() -> None:
    with pytest.raises(MissionFileError, match=r"jump0\.txt:5: DO_JUMP to item 0 cannot be flown: item 0 is home"):
        load(CASES / "jump0.txt")


def test_an_old_format_says_what_to_do() -> None:
    with pytest.raises(MissionFileError, match=r"v100\.txt:2: action 16 of 'QGC WPL 100' is not known.*save it as"):
        load(CASES / "v100.txt")


def test_a_fence_without_a_place_to_return_to_says_what_to_do() -> None:
    with pytest.raises(
        MissionFileError, match=r"old_fence\.fen:5: the last location is that of line 1.*Put a location to"
    ):
        load(CASES / "old_fence.fen")


def test_a_polygon_is_a_fence() -> None:
    (area,) = load(CASES / "poly.poly").polygons
    assert area.corners == ((-35.3631, 149.1651), (-35.3631, 149.1654), (-35.3634, 149.1654))


@pytest.mark.parametrize("target", ["again.plan", "again.txt"])
def test_a_conversion_keeps_the_place_of_a_return(target: str, tmp_path: Path) -> None:
    assert cli.main(["mission", "convert", str(CASES / "rtl_place.txt"), str(tmp_path / target)]) == 0
    item = load(tmp_path / target).mission.items[2]
    assert (item.command, item.x, item.y) == (MavCmd.NAV_RETURN_TO_LAUNCH, -353595860, 1491646390)
    assert "-35.359586" in (tmp_path / target).read_text()


@pytest.mark.parametrize(
    ("name", "said"),
    [("aux218.txt", "item 3 of 3 RTL done"), ("payloadplace.txt", "item 2 of 3 PayloadPlace done")],
)
def test_switches_and_loads_are_flown(
    name: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["mission", "fly", str(CASES / name)]) == 0
    assert said in capsys.readouterr().out
