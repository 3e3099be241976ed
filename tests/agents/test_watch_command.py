# SPDX-License-Identifier: BSD-3-Clause
"""``sitl watch``: films and the window."""

from __future__ import annotations

import argparse

import numpy as np
import pytest

from sitl.agents import showing
from sitl.agents.cli import watch
from sitl.agents.errors import AgentError
from sitl.agents.gif import Gif
from sitl.agents.runs.watch import Watch
from sitl.agents.showing import Reel
from sitl.agents.tabular import training
from tests.agents.small_runs import new
from tests.full_disk import WORDS, full_disk

pytest.importorskip("pygame", reason="pictures need the extra 'viz'")
Image = pytest.importorskip("PIL.Image", reason="pictures need the extra 'viz'")


@pytest.fixture
def run(tmp_path):
    folder = new(tmp_path / "run", episodes=3)
    training.train(folder, Watch())
    return folder


def call(*words):
    parser = argparse.ArgumentParser()
    watch.add_parser(parser.add_subparsers())
    options = parser.parse_args(["watch", *map(str, words)])
    return options.function(options)


def test_a_gif_shows_each_step_in_its_time(run, tmp_path, capsys):
    path = tmp_path / "film.gif"
    assert call(run.path, "--out", path, "--max-steps", 12, "--speed", 4) == 0
    printed = capsys.readouterr().out
    steps = int(printed.split(" steps")[0].split(": ")[1])
    with Image.open(path) as film:
        assert film.n_frames == steps + 1 and film.info["duration"] == 150 and film.info["loop"] == 0
        first = np.asarray(film.convert("RGB"))
        film.seek(steps)
        assert (np.asarray(film.convert("RGB")) != first).any()
    assert f"{steps + 1} pictures" in printed


def test_a_gif_gets_colours_that_the_first_picture_did_not_have(tmp_path):
    path = tmp_path / "film.gif"
    rng = np.random.default_rng(1)
    pictures = [np.full((40, 60, 3), 250, np.uint8) for _ in range(40)]
    for k, picture in enumerate(pictures):  # a trail that grows, in colours of its own
        picture[10, : k + 1] = (70, 130, 180)
        picture[20:30, k : k + 10] = (200, 50, 40) if k > 20 else (40, 90, 160)
        picture[35, :12] = rng.integers(0, 256, 3)
    with Reel(path, 0.1) as reel:
        for picture in pictures:
            reel.add(picture)
    with Image.open(path) as film:
        assert film.n_frames == 40 and film.info["duration"] == 100
        for k, picture in enumerate(pictures):
            film.seek(k)
            shown = np.asarray(film.convert("RGB")).astype(int)
            assert np.abs(shown - picture)[(picture == (200, 50, 40)).all(axis=2)].max(initial=0) <= 16
            assert k < 12 or np.abs(shown - picture).max() <= 16


def test_a_gif_that_finds_the_disk_full_is_removed(tmp_path):
    path = tmp_path / "film.gif"
    film = Gif(path, 0.1)
    noise = np.random.default_rng(1).integers(0, 255, (400, 400, 3), np.uint8)
    film.add(noise)
    with full_disk(2000), pytest.raises(AgentError, match=rf"film\.gif cannot be written: {WORDS}"):
        for _ in range(5):
            noise = noise[::-1]
            film.add(noise)
    film.close()
    assert not list(tmp_path.iterdir())


def test_a_gif_whose_pictures_do_not_change_has_them_all(tmp_path):
    path = tmp_path / "film.gif"
    with Reel(path, 0.1) as reel:
        for _ in range(3):
            reel.add(np.zeros((4, 6, 3), np.uint8))
    assert reel.pictures == 3
    with Image.open(path) as film:
        assert film.n_frames == 3 and not np.asarray(film.convert("RGB")).any()
    with Reel(tmp_path / "none.gif", 0.1):
        pass
    assert not (tmp_path / "none.gif").exists()


def test_a_long_gif_is_written_as_it_grows(tmp_path):
    path = tmp_path / "film.gif"
    with Reel(path, 0.1) as reel:
        sizes = []
        for shade in range(40):
            reel.add(np.random.default_rng(shade).integers(0, 256, (200, 300, 3), dtype=np.uint8))
            sizes.append(path.stat().st_size)
    assert sizes[-1] > sizes[20] > sizes[0] > 0


def test_how_an_episode_ended_is_on_the_film(run, tmp_path, capsys):
    path = tmp_path / "film.gif"
    every = round(0.04 / (0.6 / 60.0))
    counts = set()
    for limit in range(7, 7 + every):
        assert call(run.path, "--out", path, "--speed", 60, "--max-steps", limit) == 0
        steps = int(capsys.readouterr().out.split(" steps")[0].split(": ")[1])
        with Image.open(path) as film:
            assert film.n_frames == len({*range(0, steps + 1, every), steps})
        counts.add(steps % every)
    assert len(counts) > 1


def test_environments_that_do_not_say_how_long_a_step_is(tmp_path):
    cliff = new(tmp_path / "cliff", env="CliffWalking-v1", max_steps=20, episodes=2)
    training.train(cliff, Watch())
    call(cliff.path, "--out", tmp_path / "film.GIF", "--max-steps", 4)
    with Image.open(tmp_path / "film.GIF") as film:
        assert film.info["duration"] == 200


def test_a_fast_film_leaves_pictures_out(tmp_path):
    for step_s, every in ((1.0, 1), (0.04, 1), (0.01, 4), (0.001, 40)):
        reel = Reel(tmp_path / "film.gif", step_s)
        assert reel.every == every and [reel.wants() for _ in range(41)].count(True) == -(-41 // every)


def test_an_mp4_is_what_ffmpeg_makes_of_the_pictures(run, tmp_path, monkeypatch):
    program = tmp_path / "ffmpeg"
    program.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    path = tmp_path / "film.mp4"
    with Reel(path, 0.1) as reel:
        for shade in (10, 20, 30):
            reel.add(np.full((4, 6, 3), shade, np.uint8))
    assert path.read_bytes() == b"".join(bytes([shade]) * 72 for shade in (10, 20, 30))
    program.write_text("#!/bin/sh\ncat > /dev/null\necho no such encoder >&2\nexit 1\n")
    with pytest.raises(AgentError, match="no such encoder"), Reel(path, 0.1) as reel:
        reel.add(np.zeros((4, 6, 3), np.uint8))


def test_a_window_plays_until_it_is_closed(run, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    import pygame

    ended, calls = [], []

    def closed():
        calls.append(pygame.display.get_init())
        return len(calls) == 4

    monkeypatch.setattr(showing, "_window_closed", closed)
    showing.window(run, 5, 0, 1e6, lambda *episode: ended.append(episode))
    assert calls == [True] * 4 and [row[:2] for row in ended] == [(0, 3)]


def test_a_window_that_nobody_can_see_is_refused(run, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(AgentError, match=r"no screen .neither DISPLAY nor .* is set.*--out FILE\.gif"):
        call(run.path, "--window")


def test_the_page_plays_the_episodes_that_are_asked_for(run, capsys):
    pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
    assert call(run.path, "--episodes", 2, "--max-steps", 3, "--speed", 10_000) == 0
    printed = capsys.readouterr().out
    assert "page: http://127.0.0.1:" in printed and "episode 1: " in printed and "episode 2: " not in printed


def test_a_gif_stays_small_and_each_frame_of_its_end_lasts_longer(tmp_path, monkeypatch):
    monkeypatch.setattr(showing, "LARGEST", 60_000)
    rng, shown = np.random.default_rng(1), 0
    with Reel(tmp_path / "long.gif", 0.1) as reel:
        for _ in range(400):
            if reel.wants():
                reel.add(rng.integers(0, 255, (40, 40, 3), np.uint8))
    assert (tmp_path / "long.gif").stat().st_size < 70_000 and reel.every >= 8
    with Image.open(tmp_path / "long.gif") as film:
        assert film.n_frames == reel.pictures
        for frame in range(film.n_frames):
            film.seek(frame)
            shown += film.info["duration"]
    assert 40_000 <= shown < 40_000 + 100 * reel.every


def test_the_pace_waits_for_what_is_left_of_a_step():
    now, slept = [10.0], []

    def sleep(seconds):
        slept.append(round(seconds, 9))
        now[0] += seconds

    pace = showing.Pace(0.5, lambda: now[0], sleep)
    pace()
    now[0] += 0.2
    pace()
    now[0] += 0.9
    pace()
    pace()
    assert slept == [0.3, 0.5]


def test_what_cannot_be_is_refused(run, tmp_path, monkeypatch):
    with pytest.raises(AgentError, match=r"\.gif or an \.mp4"):
        call(run.path, "--out", tmp_path / "film.avi")
    with pytest.raises(AgentError, match="no folder"):
        call(run.path, "--out", tmp_path / "nowhere" / "film.gif")
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(AgentError, match="ffmpeg"):
        call(run.path, "--out", tmp_path / "film.mp4")
    for words in (("--speed", "0"), ("--speed", "nan"), ("--seed", "-1"), ("--episodes", "0")):
        with pytest.raises(SystemExit):
            call(run.path, *words)
    with pytest.raises(AgentError, match="chosen by --out"):
        call(run.path, "--option", "render_mode=human")
    with pytest.raises(AgentError, match="--max-steps limits"):
        call(run.path, "--out", tmp_path / "film.gif", "--option", "max_episode_steps=5")
    with pytest.raises(AgentError, match="cannot be written"):
        call(run.path, "--out", "/proc/film.gif", "--max-steps", "3")
    with pytest.raises(AgentError, match="neither a run"):
        call(tmp_path / "nothing")
