# SPDX-License-Identifier: BSD-3-Clause
"""A contract for import-linter: no module needs itself, directly or by others. Also imports of types, and those within
functions, count: a module that is read with another one in mind is not below it.

pyproject.toml names it; ``make lint`` checks it.
"""

from __future__ import annotations

from collections.abc import Iterator

from grimp import ImportGraph
from importlinter import Contract, ContractCheck
from importlinter.application import output


def circles(graph: ImportGraph) -> list[list[str]]:
    """The largest sets of modules, each of which reaches all others of its set by imports; sorted."""
    order: list[str] = []
    seen: set[str] = set()
    for start in sorted(graph.modules):
        for module in _finished(graph.find_modules_directly_imported_by, start, seen):
            order.append(module)
    taken: set[str] = set()
    sets = [list(_finished(graph.find_modules_that_directly_import, module, taken)) for module in reversed(order)]
    return sorted(sorted(found) for found in sets if len(found) > 1)


def _finished(neighbours, start: str, seen: set[str]) -> Iterator[str]:
    """What is reached from ``start`` and not ``seen`` yet: each module after all that it reaches."""
    if start in seen:
        return
    seen.add(start)
    path = [(start, iter(sorted(neighbours(start))))]
    while path:
        module, rest = path[-1]
        following = next((other for other in rest if other not in seen), None)
        if following is None:
            path.pop()
            yield module
        else:
            seen.add(following)
            path.append((following, iter(sorted(neighbours(following)))))


class NoCirclesContract(Contract):
    """No circle of imports."""

    def check(self, graph: ImportGraph, verbose: bool) -> ContractCheck:
        found = circles(graph)
        lines = []
        for modules in found:
            lines.append(f"{len(modules)} modules need each other:")
            for module in modules:
                for other in sorted(graph.find_modules_directly_imported_by(module) & set(modules)):
                    places = graph.get_import_details(importer=module, imported=other)
                    numbers = ", ".join(sorted({f"l.{place['line_number']}" for place in places}))
                    lines.append(f"- {module} -> {other} ({numbers})")
        return ContractCheck(kept=not found, metadata={"lines": lines})

    def render_broken_contract(self, check: ContractCheck) -> None:
        for line in check.metadata["lines"]:
            output.print_error(line, bold=False)
