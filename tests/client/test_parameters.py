# SPDX-License-Identifier: BSD-3-Clause
"""The parameters of a client as a mapping."""

from __future__ import annotations

from typing import Any

import pytest

from sitl import Simulation
from sitl.bridge.dialect import message
from sitl.client import Client, UnknownNameError
from sitl.errors import OptionError


@pytest.fixture(scope="module")
def rover():
    return Client(Simulation("erle_rover"))


def test_names_are_asked_for_as_of_a_dict(rover):
    params, before = rover.params, rover.now
    assert "WP_SPEED" in params and "WP_SPEEED" not in params and 7 not in params
    assert "WP_SPEED" in list(params) and len(params) == len(set(params)) > 500
    assert rover.now == before
    assert params.get("WP_SPEED") == params["WP_SPEED"]
    assert params.get("WP_SPEEED") is None and params.get("WP_SPEEED", 3.0) == 3.0
    with pytest.raises(UnknownNameError, match="WP_SPEED"):
        params["WP_SPEEED"]


def test_all_are_read_together(rover):
    before = rover.now
    items = dict(rover.params.items())
    assert items == rover.params.read_all() and list(items) == list(rover.params)
    assert sorted(rover.params.values()) == sorted(items.values())
    assert rover.now - before < 30.0


def elsewhere(rover: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """The vehicle is not taken for one in this process."""
    monkeypatch.setattr(type(rover.params), "_values", None)


def test_a_vehicle_elsewhere_is_asked(rover, monkeypatch):
    elsewhere(rover, monkeypatch)
    begin = rover.now
    assert "WP_SPEED" in rover.params and rover.now - begin < 0.5
    assert "WP_SPEEED" not in rover.params and rover.params.get("WP_SPEEED", 3.0) == 3.0
    assert len(rover.params) > 500


def test_one_that_says_that_it_has_none_is_believed_at_once(rover, monkeypatch):
    elsewhere(rover, monkeypatch)
    kind, send = message("PARAM_ERROR"), rover.connection.endpoint.send

    def refused(name: str, **fields: Any) -> None:
        send(name, **fields)
        if name == "PARAM_REQUEST_READ":
            told = kind.decode(kind.payload(param_id=fields["param_id"], param_index=-1, error=1))
            rover.connection.inbox.on_message("PARAM_ERROR", told)

    monkeypatch.setattr(rover.connection.endpoint, "send", refused)
    begin = rover.now
    assert "WP_SPEEED" not in rover.params and rover.now - begin < 0.5


@pytest.mark.parametrize("value", ["x", "5", None, [1.0]])
def test_a_value_that_is_no_number_is_named(rover, value):
    before, said = rover.now, "WP_SPEED = .*; a parameter's value is a number"
    with pytest.raises(OptionError, match=said):
        rover.params["WP_SPEED"] = value
    with pytest.raises(OptionError, match=said):
        rover.params.update(CRUISE_SPEED=3.0, WP_SPEED=value)
    with pytest.raises(OptionError, match=said), rover.params.changed(WP_SPEED=value):
        pass
    assert rover.now == before  # nothing was sent


def test_a_name_that_is_no_text_is_named(rover, monkeypatch):
    for _ in range(2):
        with pytest.raises(UnknownNameError, match="no parameter 5: a name is a text"):
            rover.params[5] = 1.0
        elsewhere(rover, monkeypatch)
