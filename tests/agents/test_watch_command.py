# SPDX-License-Identifier: BSD-3-Clause
"""``sitl watch``: films and the window."""

from __future__ import annotations

import argparse

import numpy as np
import pytest
from small_runs import new

from agents import showing
from agents.cli import watch
from agents.errors import AgentError
from agents.film import Reel
from agents.runs.watch import Watch
from agents.tabular import training

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
    told = capsys.readouterr().out
    steps = int(told.split(" steps")[0].split(": ")[1])
    with Image.open(path) as film:
        assert film.n_frames == steps + 1 and film.info["duration"] == 150 and film.info["loop"] == 0
        first = np.asarray(film.convert("RGB"))
        film.seek(steps)
        assert (np.asarray(film.convert("RGB")) != first).any()
    assert f"{steps + 1} pictures" in told


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
    with pytest.raises(SystemExit):
        call(run.path, "--speed", "0")
    with pytest.raises(AgentError, match="neither a run"):
        call(tmp_path / "nothing")
