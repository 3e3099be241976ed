# SPDX-License-Identifier: BSD-3-Clause
"""A law that is chosen by a number."""

from __future__ import annotations

from sitl.core import fingerprint
from sitl.core.dispatch import by_number
from sitl.core.kernels import LAWS, law


@law
def twice(x: float) -> float:
    """2 x"""
    return 2.0 * x


@law
def thrice(x: float) -> float:
    """3 x"""
    return 3.0 * x


@law
def same(x: float) -> float:
    """x"""
    return x


SCALE = by_number("scale", {2: twice, 3: thrice, 4: same}, same)


def test_the_law_of_the_number_is_called_or_the_other_one() -> None:
    assert [SCALE(number, 5.0) for number in (2, 3, 4, -1, 99)] == [10.0, 15.0, 5.0, 5.0, 5.0]


def test_it_is_a_law_and_what_it_calls_belongs_to_its_fingerprint() -> None:
    assert SCALE in LAWS
    reached: list[str] = []
    fingerprint._walk(SCALE, set(), set(), reached)
    assert {line.split()[1].rsplit(".", 1)[1] for line in reached if line.startswith("def")} == {
        "scale", "twice", "thrice", "same",
    }  # fmt: skip


def test_it_compiles() -> None:
    import numba

    from sitl.core.compile import make_jitable

    make_jitable()
    chosen = SCALE

    @numba.njit
    def compiled(number: int, x: float) -> float:
        return chosen(number, x)

    assert [compiled(number, 5.0) for number in (2, 3, 7)] == [10.0, 15.0, 5.0]
