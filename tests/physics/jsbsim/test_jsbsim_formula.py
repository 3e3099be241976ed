# SPDX-License-Identifier: BSD-3-Clause
"""Formulas in XML: numbers are folded, zeros vanish."""

from __future__ import annotations

from sitl.physics.jsbsim.formula import component, difference, function, if_less, limited, product, total


def test_zero_is_nothing() -> None:
    assert product("a/b", 0.0) == ""
    assert total("", product("a", 0.0)) == ""
    assert total("a", product("b", 0.0)) == "<p>a</p>"
    assert difference("a", "") == "<p>a</p>"


def test_numbers_of_a_product_become_one() -> None:
    assert product(2.0, "a", 0.25, "b") == "<product><p>a</p><p>b</p><v>0.5</v></product>"
    assert product(2.0, "a", 0.5) == "<p>a</p>"
    assert product(2.0, 3.0) == "<v>6.0</v>"


def test_nothing_where_a_number_is_needed_is_zero() -> None:
    assert difference("", "a") == "<difference><v>0</v><p>a</p></difference>"
    assert function("f", "") == '<function name="f"><v>0</v></function>'
    assert component("g", 1.0) == '<fcs_function name="g"><function><v>1.0</v></function></fcs_function>'


def test_bounds_and_cases() -> None:
    assert limited("a", 2.0) == "<max><min><p>a</p><v>2.0</v></min><v>-2.0</v></max>"
    assert if_less("a", 0.0, 1.0, "b") == ("<ifthen><lt><p>a</p><v>0</v></lt><v>1.0</v><p>b</p></ifthen>")
