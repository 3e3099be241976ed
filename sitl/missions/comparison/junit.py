# SPDX-License-Identifier: BSD-3-Clause
"""Results as JUnit XML for continuous integration."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as xml

from . import words
from .compare import Comparison


@dataclass(frozen=True)
class Case:
    """One test."""

    suite: str
    name: str
    seconds: float = 0.0
    """Wall time [s]."""
    failure: str = ""
    """Description of the failure; "": it passed."""
    error: str = ""
    """Reason why it could not be run; "": it was run."""
    output: str = ""
    """Further output."""


def cases_of(comparison: Comparison) -> list[Case]:
    """A case for each figure that is judged."""
    found = []
    for figure in comparison.figures:
        if figure.is_judged:
            value, limit = words.number(figure.value, figure.unit), words.number(figure.limit, figure.unit)
            text = f"{figure.title}: {value}, {limit} allowed. {figure.words}".strip()
            found.append(Case(comparison.new.name, figure.name, 0.0, "" if figure.ok else text, output=text))
    return found


def write(path: str | Path, cases: list[Case]) -> None:
    """Write a file; cases of the same suite must stand together."""
    root = xml.Element("testsuites", name="sitl mission")
    for name in dict.fromkeys(case.suite for case in cases):
        mine = [case for case in cases if case.suite == name]
        suite = xml.SubElement(
            root,
            "testsuite",
            name=name,
            tests=str(len(mine)),
            failures=str(sum(bool(case.failure) for case in mine)),
            errors=str(sum(bool(case.error) for case in mine)),
            time=f"{sum(case.seconds for case in mine):.3f}",
        )
        for case in mine:
            _add(suite, case)
    xml.indent(root)
    Path(path).write_bytes(xml.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def _add(suite: xml.Element, case: Case) -> None:
    element = xml.SubElement(suite, "testcase", classname=case.suite, name=case.name, time=f"{case.seconds:.3f}")
    for tag, text in (("failure", case.failure), ("error", case.error)):
        if text:
            xml.SubElement(element, tag, message=_plain(text.splitlines()[0])).text = _plain(text)
    if case.output:
        xml.SubElement(element, "system-out").text = _plain(case.output)


def _plain(text: str) -> str:
    """A text without characters that XML cannot contain."""
    return "".join(c if c in "\t\n\r" or " " <= c <= "\ud7ff" or "\ue000" <= c <= "\ufffd" else "?" for c in text)
