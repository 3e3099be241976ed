# SPDX-License-Identifier: BSD-3-Clause
"""The gallery: each example that draws a picture runs as it stands, finds what its page says, and draws."""

from __future__ import annotations

import builtins
import importlib.util
import re
import runpy
import struct
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sitl.cli.example_programs import EXAMPLES, source
from sitl.simulation import Core
from tests.clients.conftest import ROOT, Fly

DRAWN = [name for name, example in EXAMPLES.items() if "matplotlib" in example.needs]
IN_PROCESS = [name for name in DRAWN if EXAMPLES[name].command.startswith("python ")]
CLIENTS = [name for name in DRAWN if name not in IN_PROCESS]
URLS = {"mavsdk_geofence": "udpin://127.0.0.1:PORT", "on_board_log": "udp:127.0.0.1:PORT"}
URL = "udpin:127.0.0.1:PORT"
IMAGES, PAGE = ROOT / "docs/images/gallery", ROOT / "docs/gallery.md"
IMPORTED = {"dronekit": "dronekit", "mavproxy": "MAVProxy", "mavsdk": "mavsdk", "pettingzoo": "pettingzoo"}
"""First word of an example's name -> what it imports that is not always installed."""


def numbers(pattern: str, said: str) -> list[float]:
    """The number of each match."""
    return [float(number) for number in re.findall(pattern, said)]


def small_errors_move_it(said: str) -> bool:
    small, middle, large = numbers(r"really moves by (\S+) m", said)
    return small > 2.0 and middle > 4.0 and large < 0.5


def feed_forward_is_nearer(said: str) -> bool:
    plain, better = numbers(r": (\S+) m rms", said)
    return better < 0.3 * plain


def modes_stop_it(said: str) -> bool:
    further = numbers(r"goes +(\S+) m further", said)
    return len(further) == 5 and 8.0 < min(further) < max(further) < 25.0


def wind_costs(said: str) -> bool:
    lean, battery = numbers(r"lean (\S+) deg", said), numbers(r"battery (\d+) %", said)
    return lean[0] + 2 < lean[1] < lean[2] - 2 and battery[0] > battery[2]


def it_learns(said: str) -> bool:
    (first,), (last,) = numbers(r"first 50 episodes (-?\d+)", said), numbers(r"last 50 (-?\d+)", said)
    return first < 0.0 and last > 800.0


def softer_is_slower(said: str) -> bool:
    rises = numbers(r"degrees after (\S+) s", said)
    return len(rises) == 3 and rises[0] < 0.6 and rises == sorted(rises)


def only_the_controller_arrives(said: str) -> bool:
    random, controlled = numbers(r"(\d+) arrivals", said)
    return random < 10 and controlled > 100


FOUND: dict[str, str | Callable[[str], bool]] = {
    "camera_views": r"6\.0 s: the nearest tree is [2-9]\.\d m away",
    "dronekit_goto": r"(?s)20 m above .*landed and disarmed$",
    "fleet_flower": r"256 copters, 12 s: \d+ times real time",
    "gps_glitch": small_errors_move_it,
    "mavproxy_session": r"(?s)> takeoff 10.*landed and disarmed$",
    "mavsdk_geofence": r"(?s)Polygon fence breached.*outside.*landed and disarmed$",
    "mission_wind": wind_costs,
    "on_board_log": r"log 1: 0\.\d MB",
    "pettingzoo_swarm": r"(?s)straight on: [1-4] copters hit.*giving way: 0 copters hit",
    "pymavlink_mission": r"(?s)item 7 reached.*landed and disarmed$",
    "pymavlink_tuning": softer_is_slower,
    "q_learning": it_learns,
    "race_baseline": r"(?s)random: reward -\d+.*rover-race: reward 1[5-9]\d, best lap 5\d\.\d s",
    "rover_wall_following": r"out after [34]\d\d m and [34]\d\d s, walls hit: 0",
    "seeded_worlds": r"(?s)forest:seed=7,difficulty=0\.2: .*track:seed=7,difficulty=0\.9: \d+ solids",
    "vector_env": only_the_controller_arrives,
    "velocity_controller": feed_forward_is_nearer,
    "what_if": modes_stop_it,
}
"""What an example has to say."""


def check(name: str, said: str, picture: Path) -> None:
    """What it said is right, and the picture has the shape of the one in the documentation."""
    found = FOUND[name]
    assert re.search(found, said.strip()) if isinstance(found, str) else found(said), said
    assert size(picture) == size(IMAGES / picture.name)


def size(picture: Path) -> tuple[int, int]:
    """Width and height of a PNG."""
    data = picture.read_bytes()
    assert data.startswith(b"\x89PNG")
    width, height = struct.unpack(">II", data[16:24])
    return width, height


def skip_unless_installed(name: str) -> None:
    needed = ["matplotlib", *(module for word, module in IMPORTED.items() if name.startswith(word))]
    for module in needed:
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"{module} is not installed")


@pytest.mark.slow
@pytest.mark.parametrize("name", CLIENTS)
def test_a_script_of_a_client_draws(name: str, fly: Fly, tmp_path: Path) -> None:
    skip_unless_installed(name)
    words = EXAMPLES[name].command.split()
    speedup = words[words.index("--speedup") + 1]
    said = fly(ROOT / "examples" / f"{name}.py", URLS.get(name, URL), speedup=speedup, folder=tmp_path)
    assert "clock cannot be held" not in said, "sitl exec gives it the vehicle's"
    check(name, said, tmp_path / f"{name}.png")


@pytest.mark.slow
@pytest.mark.parametrize("name", IN_PROCESS)
def test_a_program_draws(
    name: str, core: Core, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    skip_unless_installed(name)
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [str(source(name))])
    plt.switch_backend("Agg")
    try:
        runpy.run_path(str(source(name)), run_name="__main__")
    finally:
        plt.close("all")
    check(name, capsys.readouterr().out, tmp_path / f"{name}.png")


@pytest.mark.parametrize("name", DRAWN)
def test_without_a_package_it_says_in_one_line_what_to_install(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    imported = builtins.__import__

    def without(module: str, *others: Any, **named: Any) -> Any:
        if module.startswith("matplotlib"):
            raise ModuleNotFoundError(f"No module named {module!r}", name="matplotlib")
        return imported(module, *others, **named)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(SystemExit, match=r"matplotlib is missing: pip install matplotlib") as end:
        runpy.run_path(str(source(name)), run_name="__main__")
    missing = " ".join(sorted(EXAMPLES[name].needs))
    said = sorted(str(end.value).partition("pip install ")[2].split())
    assert "\n" not in str(end.value) and set(missing.split()) <= {*said}, said


def test_the_page_shows_each_example() -> None:
    page = PAGE.read_text(encoding="utf-8")
    shown = re.findall(r"\(images/gallery/(\w+)\.png\)", page)
    assert sorted(shown) == sorted(DRAWN) == sorted(path.stem for path in IMAGES.glob("*.png"))
    for name, example in EXAMPLES.items():
        assert f"\n{example.command}\n" in page, name
        assert f"](../examples/{source(name).name})" in page, name
    for path in IMAGES.glob("*.png"):
        assert path.stat().st_size < 60_000, path
