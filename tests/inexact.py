# SPDX-License-Identifier: BSD-3-Clause
"""Finds arithmetic whose last bits depend on the machine: on the C library, the processor, the version of Python.

Allowed is what IEEE 754 rounds to one value (+, -, *, /, square roots), what is exact, and NumPy's sums: their order
depends on shapes alone.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import NamedTuple

EXACT_MATH = frozenset(
    """ceil comb copysign degrees e fabs factorial floor fmod frexp fsum gcd inf isclose isfinite isinf isnan isqrt lcm
    ldexp modf nan nextafter perm pi prod radians remainder sqrt tau trunc ulp""".split()  # noqa: SIM905
)
"""Of ``math``; ``hypot`` and ``dist`` are Python's own algorithm, which changes with its versions."""
NUMPY = frozenset(
    """acos acosh angle arccos arccosh arcsin arcsinh arctan arctan2 arctanh argpartition asin asinh atan atan2 atanh
    cbrt convolve corrcoef correlate cos cosh cov dot einsum emath exp exp2 expm1 fft float_power geomspace hypot i0
    inner linalg log log10 log1p log2 logaddexp logaddexp2 logspace matmul matvec partition polyfit pow power roots
    sin sinc sinh tan tanh tensordot vdot vecdot vecmat""".split()  # noqa: SIM905
)
"""Of NumPy: several ulp, a BLAS, a complex length, or an order that no rule gives."""
DRAWN = frozenset(
    """beta binomial chisquare dirichlet exponential f gamma geometric gumbel hypergeometric laplace logistic lognormal
    logseries multinomial multivariate_normal negative_binomial noncentral_chisquare normal pareto poisson power
    rayleigh standard_cauchy standard_exponential standard_gamma standard_normal standard_t triangular vonmises wald
    weibull zipf""".split()  # noqa: SIM905
)
"""Methods of NumPy's generators that call the C library; ``random``, ``uniform``, ``integers``, ``choice`` do not."""
MODULES = frozenset({"cmath", "random", "scipy", "statistics"})
_WHOLE = frozenset({"len", "bool", "int", "bit_count", "count", "sum"})


class Use(NamedTuple):
    """One use."""

    line: int
    what: str
    """As it is written, "math.sin"."""


def uses(source: str) -> list[Use]:
    """All uses in a module, by line."""
    tree = ast.parse(source)
    finder = _Finder(tree)
    return sorted(set(finder.found()))


class _Finder:
    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._modules: dict[str, str] = {}
        """Name in this module -> "math" or "numpy"."""
        self._others: set[str] = set()
        """Names that were imported from elsewhere."""
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                for alias in node.names:
                    name = alias.asname or alias.name.partition(".")[0]
                    if alias.name.partition(".")[0] in ("math", "numpy"):
                        self._modules[name] = alias.name.partition(".")[0]
            elif isinstance(node, ast.ImportFrom):
                self._others |= {alias.asname or alias.name for alias in node.names}

    def found(self) -> Iterator[Use]:
        for node in ast.walk(self._tree):
            for what in self._of(node):
                yield Use(getattr(node, "lineno", 0), what)

    def _of(self, node: ast.AST) -> Iterator[str]:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.partition(".")[0] in MODULES)
            yield from (alias.name for alias in node.names if alias.name.startswith(("numpy.linalg", "numpy.fft")))
        elif isinstance(node, ast.ImportFrom) and not node.level:
            yield from self._imported(node)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield from self._attribute(self._modules.get(node.value.id, ""), node.attr)
        elif isinstance(node, ast.BinOp | ast.AugAssign):
            yield from _operator(node)
        elif isinstance(node, ast.Constant) and isinstance(node.value, complex):
            yield "complex"
        if isinstance(node, ast.Call):
            yield from self._call(node)

    def _imported(self, node: ast.ImportFrom) -> Iterator[str]:
        module = (node.module or "").partition(".")[0]
        for alias in node.names:
            if module in MODULES:
                yield f"{node.module}.{alias.name}"
            elif module == "numpy" and (node.module or "").count("."):
                yield from self._attribute("numpy", (node.module or "").split(".")[1])
            else:
                yield from self._attribute(module, alias.name)

    @staticmethod
    def _attribute(module: str, name: str) -> Iterator[str]:
        if module == "math" and name not in EXACT_MATH:
            yield f"math.{name}"
        if module == "numpy" and name in NUMPY:
            yield f"np.{name}"

    def _call(self, node: ast.Call) -> Iterator[str]:
        called = node.func
        if isinstance(called, ast.Name) and called.id not in self._others:
            if called.id in ("complex", "hash", "pow"):
                yield f"{called.id}()"
            if called.id == "sum" and not _is_whole(node.args[0]):
                yield "sum()"
        if not isinstance(called, ast.Attribute):
            return
        owner = called.value.id if isinstance(called.value, ast.Name) else ""
        if called.attr in ("argsort", "sort_values") and not _is_stable(node):
            yield ".argsort()"
        if owner in self._modules or owner in self._others:
            return
        if called.attr in DRAWN:
            yield f".{called.attr}()"
        if called.attr == "dot":
            yield ".dot()"


def _is_stable(node: ast.Call) -> bool:
    return any(key.arg == "kind" and ast.unparse(key.value) in ("'stable'", "'mergesort'") for key in node.keywords)


def _operator(node: ast.BinOp | ast.AugAssign) -> Iterator[str]:
    if isinstance(node.op, ast.MatMult):
        yield "@"
    if isinstance(node.op, ast.Pow) and not (isinstance(node, ast.BinOp) and _is_power_of_numbers(node)):
        yield "**"


def _is_power_of_numbers(node: ast.BinOp) -> bool:
    """2**31, 10**15, 2.0**-54: whole numbers, or a power of two."""
    base, exponent = node.left, node.right
    if isinstance(exponent, ast.UnaryOp) and isinstance(base, ast.Constant) and base.value in (2, 2.0):
        exponent = exponent.operand
    numbers = [part.value for part in (base, exponent) if isinstance(part, ast.Constant)]
    return len(numbers) == 2 and isinstance(numbers[1], int) and (isinstance(numbers[0], int) or numbers[0] == 2.0)


def _is_whole(summed: ast.expr) -> bool:
    """Whether it can be seen that whole numbers are added; since Python 3.12 ``sum`` of floats adds up differently."""
    if isinstance(summed, ast.GeneratorExp | ast.ListComp):
        return _is_whole_number(summed.elt)
    if isinstance(summed, ast.Call) and ast.unparse(summed.func) == "map":
        return ast.unparse(summed.args[0]) in _WHOLE
    return False


def _is_whole_number(node: ast.expr) -> bool:
    if isinstance(node, ast.Compare):
        return True
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.Not) or _is_whole_number(node.operand)
    if isinstance(node, ast.BoolOp):
        return all(map(_is_whole_number, node.values))
    if isinstance(node, ast.BinOp):
        if isinstance(node.op, ast.LShift | ast.RShift | ast.BitAnd | ast.BitOr | ast.FloorDiv):
            return True
        return _is_whole_number(node.left) and _is_whole_number(node.right)
    if isinstance(node, ast.IfExp):
        return _is_whole_number(node.body) and _is_whole_number(node.orelse)
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int)
    if isinstance(node, ast.Call):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        return name in _WHOLE
    return False
