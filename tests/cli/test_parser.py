# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes in a command line, what ``sitl`` alone prints, and what a shell gets that completes words."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from sitl.cli import WELCOME, main, parser
from sitl.cli.command_list import COMMANDS
from tests.cli.command import ROOT, environment


@pytest.fixture(autouse=True)
def alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """No other package adds commands."""
    monkeypatch.setattr(metadata, "entry_points", lambda **wanted: [])


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("rnu", "sitl: COMMAND 'rnu' is not known; did you mean 'run'?"),
        ("run", "sitl run: vehicle (copter or rover) is missing"),
        ("run coptr", "vehicle 'coptr' is not known; did you mean 'copter'?"),
        ("run copter --speedpu 3", "there is no option --speedpu; did you mean '--speedup'?"),
        ("run copter --speedpu=3", "there is no option --speedpu; did you mean '--speedup'?"),
        ("run copter --speed 3", "there is no option --speed; did you mean"),
        ("run copter x", "'x' is one argument too many"),
        ("run copter --speedup", "--speedup: expected one argument"),
        ("run copter --estimator magic", "--estimator 'magic' is not known; it is one of ekf, truth"),
        ("world", "sitl world: ACTION (list or show) is missing"),
        ("world shwo", "ACTION 'shwo' is not known; did you mean 'show'?"),
        ("evaluate", "sitl evaluate: RUN is missing"),
    ],
)
def test_a_mistake_is_one_line_with_a_hint(words: str, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    out, err = capsys.readouterr()
    assert ended.value.code == 2 and not out
    assert said in err and err.count("\n") == 1 and "--help)" in err


def test_alone_it_tells_what_one_can_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    shown = capsys.readouterr().out
    assert shown == WELCOME
    named = [line.split()[1] for line in shown.splitlines() if line.startswith("  sitl ")]
    assert len(named) == 5 and set(named) <= set(COMMANDS)


def test_every_command_of_the_table_is_declared_by_its_module() -> None:
    whole = parser().format_help()
    for name, listed in COMMANDS.items():
        assert name in whole
        words = [name, "--help"]
        if listed.module != "sitl.cli.drop_in":
            with pytest.raises(SystemExit) as ended:
                parser(words).parse_args(words)
            assert ended.value.code == 0


def test_only_the_command_that_is_given_is_loaded() -> None:
    code = "import sys; from sitl.cli import parser; parser(['world', 'list']); print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], env=environment(), capture_output=True, text=True, check=True
    ).stdout.split()
    assert "sitl.cli.world" in loaded
    assert not {"sitl.cli.run", "sitl.simulation", "numba"} & set(loaded)


def complete(line: str, tmp_path: Path) -> set[str]:
    """What the program answers to a shell that wants ``line`` completed."""
    out = tmp_path / "words"
    settings = {
        **environment(),
        "_ARGCOMPLETE": "1",
        "_ARGCOMPLETE_STDOUT_FILENAME": str(out),
        "_ARGCOMPLETE_IFS": "\n",
        "COMP_LINE": line,
        "COMP_POINT": str(len(line)),
    }
    subprocess.run([sys.executable, "-m", "sitl"], env=settings, cwd=ROOT, check=True, timeout=120)
    return {word.strip() for word in out.read_text().split("\n")}


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("sitl tr", {"train"}),
        ("sitl run ", {"copter", "rover"}),
        ("sitl run copter --speed", {"--speedup"}),
        ("sitl world ", {"list", "show"}),
    ],
)
def test_a_shell_completes_commands_options_and_choices(line: str, words: set[str], tmp_path: Path) -> None:
    assert words <= complete(line, tmp_path)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_code_for_shells(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", shell]) == 0
    code = capsys.readouterr().out
    assert "sitl" in code and ("complete" in code or "compdef" in code)
    if shell == "bash" and os.path.exists("/bin/bash"):
        subprocess.run(["/bin/bash", "-n"], input=code, text=True, check=True)


LOADING = """
import os, runpy, signal, sys

class Pressed:
    "Ctrl-C is pressed while the command is being loaded."
    def find_spec(self, name, *rest):
        if name == "sitl.cli.command_list":
            os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Pressed())
sys.argv = ["sitl", "world", "list"]
runpy.run_module("sitl", run_name="__main__")
"""


def test_ctrl_c_while_the_command_is_loaded_ends_it_without_a_traceback() -> None:
    done = subprocess.run([sys.executable, "-c", LOADING], env=environment(), capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")
