# SPDX-License-Identifier: BSD-3-Clause
"""World files and ``sitl world``: what can be written, and what is said when something is wrong."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sitl import worlds
from sitl.cli import main
from sitl.worlds.loader import parse
from sitl.worlds.shapes import WorldError
from sitl.worlds.tables import SINGLE, TABLES, written
from tests import mutations

PAGE = Path(__file__).parents[2] / "docs" / "worlds.md"

EVERYTHING = """
[world]
name = "yard"
description = "a yard"
source = "my tape measure"
plan_height = 0.4
[floor]
z = -0.5
friction = 0.7
[[box]]
name = "crate"
centre = [2, 0, 0]
size = [1, 2, 1]
yaw_deg = 30
[[cylinder]]
name = "drum"
centre = [-2, 1, 0.25]
radius = 0.3
height = 0.9
[[segment]]
name = "fence"
from = [5, -5]
to = [5, 3]
z = [-0.5, 1.5]
[[start]]
name = "gate"
position = [0, 0, -0.5]
yaw_deg = 90
[[start]]
name = "pad"
robot = "erle_copter"
position = [1, 3, 0]
[[marking]]
name = "spot"
centre = [0, 0]
radius = 0.4
colour = "red"
[[marking]]
centre = [1, 1]
size = [2, 1]
yaw_deg = 45
[[lap]]
name = "round the crate"
length = 8.5
clearance = 0.3
"""


def test_every_key_is_understood() -> None:
    world = parse(EVERYTHING, "yard.toml")
    assert (world.name, world.description, world.source) == ("yard", "a yard", "my tape measure")
    assert (world.floor_z, world.friction, world.plan_height) == (-0.5, 0.7, 0.4)
    crate, drum, fence = world.solids
    assert isinstance(crate, worlds.Box) and isinstance(drum, worlds.Cylinder) and isinstance(fence, worlds.Box)
    assert crate.yaw == math.radians(30.0) and (crate.low, crate.high) == (-0.5, 0.5)
    assert (drum.low, drum.high) == pytest.approx((-0.2, 0.7))
    assert (fence.centre, fence.size) == ((5.0, -1.0, 0.5), (8.0, 0.01, 2.0)) and fence.yaw == math.pi / 2
    assert [s.name for s in world.starts] == ["gate", "pad"] and world.start("erle_copter").name == "pad"
    assert world.markings[0].radius == 0.4 and world.markings[1].size == (2.0, 1.0)
    assert world.laps[0].clearance == 0.3
    used = {(table, key) for table in TABLES for key in TABLES[table] if f"{key} = " in EVERYTHING}
    assert used == {(table, key) for table in TABLES for key in TABLES[table]} - {("segment", "thickness")}


def test_both_spellings_of_lists_are_the_same() -> None:
    short = "box = [\n  { centre = [0, 3, 0.5], size = [1, 1, 1] },\n  { centre = [3, 0, 0.5], size = [1, 1, 1] },\n]"
    long = "[[box]]\ncentre = [0, 3, 0.5]\nsize = [1, 1, 1]\n[[box]]\ncentre = [3, 0, 0.5]\nsize = [1, 1, 1]"
    assert parse(short, "w.toml") == parse(long, "w.toml")


def test_what_is_left_out() -> None:
    world = parse("", "empty_field.toml")
    assert (world.name, world.solids, world.floor_z, world.friction) == ("empty_field", (), 0.0, 1.0)
    assert world.start().position == (0.0, 0.0, 0.0)


def test_a_file_of_the_users_own_works_by_path(tmp_path: Path) -> None:
    path = tmp_path / "yard.toml"
    path.write_text(EVERYTHING, encoding="utf-8")
    assert worlds.load(path) == worlds.load(str(path)) == parse(EVERYTHING, "yard.toml")
    path.write_text(EVERYTHING.replace("yard", "garden"), encoding="utf-8")
    assert worlds.load(path).name == "garden", "a file is read anew each time"


BOX = "[[box]]\nname = 'b'\ncentre = [0, 0, 0]\n"
START = "[[start]]\nname = 's'\nposition = [0, 0, 0]\n"


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("[[box", "world file 'w.toml' is not TOML: "),
        ("[[bxo]]", "table 'bxo' is not known (did you mean 'box'?); there are [world], [floor], [[box]], "),
        ("gravity = 9.8", "key 'gravity' outside of a table is not known; there are [world]"),
        ("[box]\nsize = [1, 1, 1]", "box is written [[box]], with double brackets, once for each"),
        ("[[world]]\nname = 'x'", "world is written [world] and stands once"),
        ("box = [1]", "box is written [[box]], with double brackets"),
        ("[world]\nnmae = 'x'", "[world]: key 'nmae' is not known (did you mean 'name'?); there are name, description"),
        (
            BOX + "size = [1, 1, 1]\nyaw = 1.57",
            "world file 'w.toml', [[box]] number 1 'b': key 'yaw' is not known (did you mean 'yaw_deg'?)",
        ),
        (
            BOX + "size = [1, 1, 1]\n" + BOX + "size = [1, 0, 1]",
            "[[box]] number 2 'b': size = [1, 0, 1] must be 3 numbers in a list, each from 0.001 to 10000 [m]",
        ),
        (BOX, "[[box]] number 1 'b': size is missing; it is 3 numbers in a list, each from 0.001 to 10000 [m]"),
        (BOX + "size = [1, 1]", "size = [1, 1] must be 3 numbers in a list"),
        (BOX + "size = [1, 1, true]", "size = [1, 1, True] must be 3 numbers in a list"),
        (BOX + "size = [1, 1, nan]", "size = [1, 1, nan] must be 3 numbers in a list"),
        (BOX + "size = 3", "size = 3 must be 3 numbers in a list"),
        (BOX + "size = [1, 1, 1]\nyaw_deg = 400", "yaw_deg = 400 must be a number from -360 to 360 [degrees]"),
        ("[[box]]\nname = 3", "[[box]] number 1: centre is missing"),
        ("[[start]]\nname = 3\nposition = [0, 0, 0]", "[[start]] number 1: name = 3 must be a text in quotes"),
        ("[floor]\nz = inf", "[floor]: z = inf must be a number from -10000 to 10000 [m]"),
        ("[floor]\nfriction = -1", "[floor]: friction = -1 must be a number from 0 to 10"),
        (START + START, "[[start]] number 2 's': name = 's' is there twice"),
        (START.replace(" 0]", " -1]"), "position = (0.0, 0.0, -1.0) is below the floor (z = 0)"),
        (START + BOX + "size = [1, 1, 1]", "position = (0.0, 0.0, 0.0) is inside of box 'b'"),
        ("[[segment]]\nfrom = [0, 0]\nto = [0, 0]\nz = [0, 1]", "is the same point as 'from'"),
        ("[[segment]]\nfrom = [0, 0]\nto = [1, 0]\nz = [1, 1]", "z = (1.0, 1.0) must be the height of the underside"),
        ("[[marking]]\ncentre = [0, 0]", "must have either 'radius' (a disc) or 'size' (a rectangle)"),
        ("[[marking]]\ncentre = [0, 0]\nradius = 1\ncolour = 'pink'", "colour = 'pink' must be one of black, blue"),
    ],
)
def test_mistakes_are_named(content: str, says: str) -> None:
    with pytest.raises(WorldError) as caught:
        parse(content, "w.toml")
    assert says in str(caught.value)
    assert "world file 'w.toml'" in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(WorldError, match=r"absent\.toml' cannot be read: No such file"):
        worlds.load("absent.toml")
    with pytest.raises(WorldError, match="cannot be read: Is a directory"):
        worlds.load(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b"[world]\nname = '\xe9'")
    with pytest.raises(WorldError, match="is not UTF-8 text"):
        worlds.load(tmp_path / "latin.toml")


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=4)
            | st.dictionaries(
                st.sampled_from(sorted({k for t in TABLES.values() for k in t} | set(TABLES))), inner, max_size=4
            )
        ),
        max_leaves=12,
    )
)
def test_whatever_stands_in_a_file_is_a_world_or_a_worlderror(value: object) -> None:
    """No other exception than WorldError comes out of the reader."""
    content = "\n".join(f"{table} = {_toml(value)}" for table in TABLES)
    found = mutations.read_or_refused(lambda: parse(content, "w.toml"), WorldError, "'w.toml'")
    assert found is None or found.name == value["name"]


def _toml(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, str):
        return "'" + "".join(c for c in value if c.isprintable() and c != "'") + "'"
    return {None: "1979-05-27", True: "true", False: "false"}.get(value, str(value)) if value != 1 else "1"  # type: ignore[call-overload]


def test_the_page_explains_every_table_and_key() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for table, keys in TABLES.items():
        line = next(row for row in page.splitlines() if row.startswith(f"| `{written(table)}`"))
        for key in keys:
            assert f"`{key}`" in line, f"{written(table)} {key} is not explained in docs/worlds.md"
    assert set(SINGLE) < set(TABLES)
    for name in worlds.names():
        assert f"| `{name}` |" in page


def test_the_examples_of_the_page_work() -> None:
    page = PAGE.read_text(encoding="utf-8")
    (yard,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    assert len(parse(yard, "yard.toml").solids) == 3
    (example,) = [block for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "readings" in block]
    scope: dict[str, Any] = {}
    exec(example, scope)
    assert [int(r) for r in scope["readings"][::4]] == [0, 4, 1, 1, 0]
    assert scope["near"].distance == pytest.approx(0.234, abs=0.001)


def test_a_byte_order_mark_does_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "marked.toml"
    path.write_bytes('\ufeff[world]\ndescription = "From an editor on Windows."\n'.encode())
    assert worlds.load(path).description == "From an editor on Windows."


def test_a_world_has_a_start() -> None:
    with pytest.raises(WorldError, match="world 'nowhere' has no start pose"):
        worlds.World("nowhere", (), ())


def test_list(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["world", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(worlds.names())


def test_show_writes_a_picture_and_says_what_there_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["world", "show", "maze"]) == 0
    said = capsys.readouterr().out
    assert "12 boxes, 4 cylinders" in said and "original: x 0, y 0, z 0 m" in said and said.endswith("plan: maze.png\n")
    assert (tmp_path / "maze.png").read_bytes().startswith(b"\x89PNG")
    (tmp_path / "mine.toml").write_text("[[cylinder]]\ncentre = [2, 0, 1]\nradius = 0.5\nheight = 2\n")
    assert main(["world", "show", "mine.toml", "--png", "plan.svg", "--height", "3"]) == 0
    assert "cut at z = 3 m" in (tmp_path / "plan.svg").read_text() or (tmp_path / "plan.svg").stat().st_size > 1000


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("show", "mars"), "world 'mars' is not known; it is one of circuit"),
        (("show", "absent.toml"), "world file 'absent.toml' cannot be read"),
        (("show", "circle", "--png", "no/such/folder.png"), "--png 'no/such/folder.png' cannot be written"),
        (("show", "circle", "--png", "plan.doc"), "--png 'plan.doc' cannot be written"),
    ],
)
def test_mistakes(arguments: tuple[str, ...], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["world", *arguments]) == 2
    error = capsys.readouterr().err
    assert says in error and len(error.splitlines()) == 1
