# SPDX-License-Identifier: BSD-3-Clause
"""A fault of a test is a text, arguments, or a text with what it does not say in arguments; nothing is said twice."""

from __future__ import annotations

from typing import Any

import pytest

from sitl.errors import OptionError
from sitl.missions.testing.faulty import _apart

NOTHING: dict[str, Any] = {"type": "", "instance": 0, "amount": None, "at": 0.0, "until": None}


def apart(what: str, **given: Any) -> tuple[Any, ...]:
    return _apart(what, **{**NOTHING, **given})


@pytest.mark.parametrize(
    ("what", "given", "found"),
    [
        ("gps", {}, ("gps", "", 0, None, 0.0, None)),
        ("gps", {"at": 3.0, "until": 5.0}, ("gps", "", 0, None, 3.0, 5.0)),
        ("motor:2=0.5@3..5", {}, ("motor", "", 2, 0.5, 3.0, 5.0)),
        ("motor:1", {"amount": 0.0, "at": 4.0}, ("motor", "", 1, 0.0, 4.0, None)),
        ("motor:1=0", {}, ("motor", "", 1, 0.0, 0.0, None)),
        ("gps/wrong", {"instance": 1, "amount": 30.0}, ("gps", "wrong", 1, 30.0, 0.0, None)),
        ("gps@1", {"instance": 1}, ("gps", "", 1, None, 1.0, None)),
        ("gps@3", {"at": 0.0}, ("gps", "", 0, None, 3.0, None)),
    ],
)
def test_what_a_text_does_not_say_arguments_may(what: str, given: Any, found: tuple[Any, ...]) -> None:
    assert apart(what, **given) == found


@pytest.mark.parametrize(
    ("what", "given", "error"),
    [
        ("motor:2", {"instance": 1}, "fault 'motor:2': instance is given twice, 2 and 1"),
        ("motor:1", {"instance": 1}, "fault 'motor:1': instance is given twice, 1 and 1"),
        ("gps/wrong", {"type": "stuck"}, "fault 'gps/wrong': type is given twice, 'wrong' and 'stuck'"),
        ("gps/wrong=1", {"amount": 1.0}, "fault 'gps/wrong=1': amount is given twice, 1.0 and 1.0"),
        ("gps@1", {"at": 1.0}, "fault 'gps@1': at is given twice, 1.0 and 1.0"),
        ("gps@1..5", {"until": 1.0}, "fault 'gps@1..5': until is given twice, 5.0 and 1.0"),
    ],
)
def test_what_is_said_twice_is_named(what: str, given: Any, error: str) -> None:
    with pytest.raises(OptionError) as told:
        apart(what, **given)
    assert str(told.value) == error
