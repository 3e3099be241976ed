# SPDX-License-Identifier: BSD-3-Clause
"""Members of an IntEnum in compiled laws."""

from __future__ import annotations

from enum import IntEnum

from numba import njit, types

import sitl.core.numba_records  # noqa: F401  as whatever compiles laws imports it


class Choice(IntEnum):
    ONE = 1
    TWO = 2


@njit
def halved(number):
    return 0.5 * float(number)


@njit
def chosen(number):
    found = Choice.ONE
    if number > 1:
        found = number
    return found


@njit
def halves(number):
    return halved(Choice.TWO) + halved(number) + halved(Choice.ONE | Choice.TWO)


def test_a_member_is_its_number():
    assert halves(4) == 1.0 + 2.0 + 1.5
    assert (chosen(0), chosen(2)) == (1, 2), "members and numbers are of one type"


def test_what_takes_members_and_numbers_is_compiled_once():
    halves(4)
    assert [type(argument) for (argument,) in halved.signatures] == [type(types.int64)]
