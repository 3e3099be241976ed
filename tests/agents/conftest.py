# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of learning share."""

from __future__ import annotations

import argparse

import pytest

from sitl.agents import cli as agents_cli
from sitl.errors import SitlError


@pytest.fixture
def sitl(monkeypatch, tmp_path, capsys):
    """Runs a command in an empty folder; gives its code, output and errors, 2 and the message for a user's mistake."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        top = argparse.ArgumentParser(prog="sitl")
        agents_cli.add_parser(top.add_subparsers(dest="command", required=True))
        try:
            options = top.parse_args([str(word) for word in words])
            code = options.function(options)
        except SitlError as error:
            return 2, "", str(error)
        except SystemExit:
            return 2, "", capsys.readouterr().err
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run
