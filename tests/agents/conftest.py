# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of learning share."""

from __future__ import annotations

import pytest

from sitl.cli import parser
from sitl.errors import SitlError


@pytest.fixture
def sitl(monkeypatch, tmp_path, capsys):
    """Runs a command in an empty folder; gives its code, output and errors, 2 and the message for a user's mistake."""
    monkeypatch.chdir(tmp_path)

    def run(*words):
        words = [str(word) for word in words]
        try:
            options = parser(words).parse_args(words)
            code = options.function(options)
        except SitlError as error:
            return 2, "", str(error)
        except SystemExit:
            return 2, "", capsys.readouterr().err
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run
