# SPDX-License-Identifier: BSD-3-Clause
"""``sitl physics`` and ``--physics``: what they take and what they say."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from sitl.cli import main, parser
from tests.cli.command import sitl


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("physics", "copter", "--listen", "udp:4560"), "'udp' is not known"),
        (("physics", "copter", "--listen", "tcp:here"), "'here' is not a port"),
        (("physics", "copter", "--listen", "tcp:70000"), "'70000' is not a port"),
        (("physics", "copter", "--frame", "erle_rover"), "erle_rover is a rover"),
        (("physics", "rover", "--world", "nowhere"), "nowhere"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--world", "maze"), "other end"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--seed", "3"), "other end"),
        (("run", "copter", "--physics", "hil:tcp:127.0.0.1:4560", "--estimator", "truth"), "other end"),
        (("run", "copter", "--physics", "hil:4560"), "hil:tcp:HOST:PORT"),
        (("run", "copter", "--physics", "gazebo"), "'gazebo' is not known"),
    ],
)
def test_mistakes_are_one_line(words: tuple[str, ...], said: str, tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    if words[0] == "run":
        words = (*words, "--out", "none", "--tcp", "0")
    assert main(words) == 2
    err = capsys.readouterr().err
    assert said in err and len(err.splitlines()) == 1


def test_a_port_that_is_taken(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = sitl("physics", "copter", "--listen", f"tcp:127.0.0.1:{taken.getsockname()[1]}", folder=tmp_path)
    assert done.returncode == 2 and "cannot be opened" in done.stderr


def test_what_is_there_by_default() -> None:
    options = parser().parse_args(["physics", "rover"])
    assert (options.physics, options.listen, options.seed, options.instance) == ("native", "tcp", 0, 0)
