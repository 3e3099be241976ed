# SPDX-License-Identifier: BSD-3-Clause
"""Formulas in JSBSim's XML (https://jsbsim-team.github.io/jsbsim/classJSBSim_1_1FGFunction.html).

A formula is a string of XML; an empty one is zero and vanishes from sums and products, so that properties of zero leave
nothing to be computed.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...errors import MissingExtra
from ..engine import EngineError

Term = str | float
"""A formula, the name of a property, or a number."""


def written(term: Term) -> str:
    """A term as XML: "" for zero."""
    if isinstance(term, str):
        return term if not term or term.startswith("<") else f"<p>{term}</p>"
    return f"<v>{float(term)!r}</v>" if term != 0.0 else ""


def _or_zero(term: Term) -> str:
    return written(term) or "<v>0</v>"


def product(*terms: Term) -> str:
    """Of all terms; numbers are multiplied here."""
    number = 1.0
    rest = []
    for term in terms:
        if isinstance(term, str):
            rest.append(written(term))
        else:
            number *= term
    if number == 0.0 or "" in rest:
        return ""
    if number != 1.0 or not rest:
        rest.append(written(number))
    return rest[0] if len(rest) == 1 else f"<product>{''.join(rest)}</product>"


def total(*terms: Term) -> str:
    """Their sum."""
    rest = [text for text in map(written, terms) if text]
    return f"<sum>{''.join(rest)}</sum>" if len(rest) > 1 else "".join(rest)


def difference(left: Term, right: Term) -> str:
    """left - right."""
    if not written(right):
        return written(left)
    return f"<difference>{_or_zero(left)}{written(right)}</difference>"


def least(left: Term, right: Term) -> str:
    """The smaller one."""
    return f"<min>{_or_zero(left)}{_or_zero(right)}</min>"


def greatest(left: Term, right: Term) -> str:
    """The larger one."""
    return f"<max>{_or_zero(left)}{_or_zero(right)}</max>"


def limited(term: Term, bound: float) -> str:
    """Within -bound .. bound."""
    return greatest(least(term, bound), -bound)


def magnitude(term: Term) -> str:
    """Its absolute value."""
    return f"<abs>{_or_zero(term)}</abs>"


def root(term: Term) -> str:
    """Its square root."""
    return f"<sqrt>{_or_zero(term)}</sqrt>"


def if_less(left: Term, right: Term, then: Term, otherwise: Term) -> str:
    """``then`` where left < right."""
    return f"<ifthen><lt>{_or_zero(left)}{_or_zero(right)}</lt>{_or_zero(then)}{_or_zero(otherwise)}</ifthen>"


def function(name: str, formula: Term) -> str:
    """A function, whose value is property ``name``."""
    return f'<function name="{name}">{_or_zero(formula)}</function>'


def component(name: str, formula: Term) -> str:
    """A component of a system: computed in the order of writing; may use its own last value."""
    return f'<fcs_function name="{name}"><function>{_or_zero(formula)}</function></fcs_function>'


NAME = "vehicle"


def library() -> Any:
    """The jsbsim module, told to say nothing but errors.

    Raises:
        MissingExtra: it is not installed.
    """
    try:
        import jsbsim
    except ImportError as missing:
        raise MissingExtra("physics 'jsbsim' needs JSBSim: pip install 'gym-sitl[jsbsim]'") from missing
    if hasattr(jsbsim, "set_logger"):  # not in old ones, which speak
        jsbsim.set_logger(jsbsim.DefaultLogger(jsbsim.LogLevel.ERROR))
    return jsbsim


def load(text: str, dt: float) -> Any:
    """An FGFDMExec with the aircraft of a document, stepping by dt [s].

    JSBSim reads aircraft from files alone: one is written to a temporary folder and is gone again afterwards.

    Raises:
        EngineError: JSBSim does not take it.
    """
    jsbsim = library()
    with TemporaryDirectory(prefix="gym-sitl-jsbsim-") as folder:
        path = Path(folder) / "aircraft" / NAME
        path.mkdir(parents=True)
        (path / f"{NAME}.xml").write_text(text, encoding="utf-8")
        executive = jsbsim.FGFDMExec(folder)
        executive.set_debug_level(0)
        executive.disable_output()
        try:
            loaded = executive.load_model(NAME)
        except jsbsim.BaseError as error:
            raise EngineError(f"JSBSim does not take the aircraft: {error}") from error
    if not loaded:
        raise EngineError("JSBSim does not take the aircraft")
    executive.set_dt(dt)
    return executive
