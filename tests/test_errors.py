# SPDX-License-Identifier: BSD-3-Clause
"""Every error of the package is a ``SitlError``, and the command line prints any of them in one line."""

from __future__ import annotations

import importlib
import pkgutil

import pytest

import sitl
from sitl import cli
from sitl.errors import MissingExtra, OptionError, SitlError

EXTRAS = {"jsbsim", "matplotlib", "pybullet", "pygame", "ray", "stable_baselines3", "torch"}


def exceptions() -> set[type[BaseException]]:
    """The exception classes that the package's modules define."""
    found = set()
    for module in pkgutil.walk_packages(sitl.__path__, "sitl."):
        if module.name.endswith("__main__") or module.name.startswith("sitl.examples."):  # programs of users
            continue
        try:
            loaded = importlib.import_module(module.name)
        except ModuleNotFoundError as error:
            assert error.name in EXTRAS, module.name
            continue
        except MissingExtra:
            continue
        for value in vars(loaded).values():
            if isinstance(value, type) and issubclass(value, BaseException) and value.__module__.startswith("sitl."):
                found.add(value)
    return found


def test_every_error_has_the_common_base() -> None:
    found = {one for one in exceptions() if not issubclass(one, Warning)}
    assert len(found) > 35 and {SitlError, OptionError} <= found
    assert not [one for one in found if not issubclass(one, SitlError)]


def test_the_command_line_prints_it_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class AddedError(SitlError, KeyError):
        """As another package has one."""

    def fail(options: object) -> int:
        raise AddedError("no such thing")

    monkeypatch.setattr(cli.cache, "cache", fail)
    assert cli.main(["cache", "show"]) == 2
    assert capsys.readouterr().err == "sitl cache: no such thing\n"
