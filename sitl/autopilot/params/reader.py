# SPDX-License-Identifier: BSD-3-Clause
"""Files of parameters as users have them, read line by line.

One reader for all forms: MAVProxy's and ArduPilot's ``NAME VALUE``, Mission Planner's ``NAME,VALUE``, ``NAME=VALUE``,
and QGroundControl's five columns (vehicle, component, name, value, type). Separators and hexadecimal numbers are taken
as ArduPilot takes them (``--defaults``); docs/reference/parameter-files.md compares the two line by line.
"""

from __future__ import annotations

import math
import os
import re
import stat
from pathlib import Path

from ...errors import SitlError
from .parameter import FLOAT_LIMIT

ENDINGS = (".parm", ".param", ".params")
MAX_BYTES = 1_000_000
"""Of one file; a whole ArduPilot's has 30,000."""
MAX_DEPTH, MAX_INCLUDES = 10, 50
AUTOPILOT = 1
"""The component whose parameters are read from QGroundControl's files (MAV_COMP_ID_AUTOPILOT1)."""

_SEPARATORS = re.compile(r"[\s,=]+")
_NAME = re.compile(r"[A-Za-z]\w*", re.ASCII)
_PARAMETER = re.compile(r"[A-Z][A-Z0-9_]+", re.ASCII)
"""What was certainly meant to be the name of a parameter."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_HEXADECIMAL = re.compile(r"[+-]?0[xX][0-9a-fA-F]{1,16}", re.ASCII)
_DECIMAL_COMMA = re.compile(r"\w+[\s=]+([+-]?\d+,\d+)", re.ASCII)
_COMMENTS = ("#", "//", ";")
_NOT_TAKEN = {"FORMAT_VERSION", "MIS_TOTAL", "FENCE_TOTAL", "RALLY_TOTAL"}
"""What the memory of that autopilot holds: its layout (ArduPilot leaves it out, too), its lists (so does MAVProxy)."""
_SHOWN = 40


class ParameterError(SitlError, ValueError):
    """A parameter's name or value that cannot be taken."""


class Reader:
    """Reads files of parameters, one after the other; later values stand over earlier ones."""

    def __init__(self) -> None:
        self.values: dict[str, float] = {}
        self.read_only: set[str] = set()
        """Names that a file marks ``@READONLY``."""
        self.remarks: list[str] = []
        """What was passed over, for the user."""
        self._includes = 0

    def read(self, path: Path) -> None:
        """Read a file and those that it includes.

        Raises:
            ParameterError: it cannot be read, is no file of parameters, or has a value that is no number.
        """
        data, file = _bytes(path), path.resolve()  # a link stands for the file that it leads to
        self._file(data, str(path), file, file.parent, ())

    def text(self, text: str, source: str, file: Path | None = None, root: Path | None = None,
             within: tuple[Path, ...] = ()) -> None:  # fmt: skip
        """Read a text.

        Args:
            text: the lines.
            source: what messages call it.
            file: where it is from; None: it cannot include others.
            root: the folder out of which includes do not lead.
            within: files that are being read, the first one first.

        Raises:
            ParameterError: names the source, the line and what is wrong with it.
        """
        junk: list[str] = []
        others, taken = 0, 0
        at: dict[str, int] = {}
        for number, line in enumerate(re.split(r"\r\n|\r|\n", text), 1):
            where = f"{source}, line {number}"
            stripped = line.strip()
            if stripped.startswith("@"):
                taken += 1
                self._directive(stripped, where, file, root, within)
                continue
            if not stripped or stripped.startswith(_COMMENTS):
                continue
            found = _entry(stripped, where)
            if found is None:
                junk.append(f"line {number}: {_shortened(stripped)}")
                continue
            component, name, value, flag = found
            taken += 1
            if component not in (None, AUTOPILOT):
                others += 1
            elif name not in _NOT_TAKEN:
                if name in at and self.values[name] != value:
                    was, line_before = self.values[name], at[name]
                    self.remarks.append(f"{where}: {name} is {value:g}, after {was:g} in line {line_before}")
                at[name] = number
                self._take(name, value, flag)
        if junk and not taken:
            raise ParameterError(f"{source}, {junk[0]} is not NAME VALUE, and no other line is")
        if junk:
            more = ", ..." if len(junk) > 3 else ""
            self.remarks.append(f"{source}: {len(junk)} lines are not NAME VALUE: {', '.join(junk[:3])}{more}")
        if others:
            self.remarks.append(f"{source}: {others} parameters of components other than the autopilot are left out")

    def _take(self, name: str, value: float, flag: str) -> None:
        self.values[name] = value
        self.read_only.discard(name)
        if flag == "@READONLY":
            self.read_only.add(name)

    def _file(self, data: bytes, source: str, path: Path, root: Path, within: tuple[Path, ...]) -> None:
        self.text(_decoded(data, source), source, path, root, (*within, path))

    def _directive(self, line: str, where: str, file: Path | None, root: Path | None, within: tuple[Path, ...]) -> None:
        word, *rest = line.split("#", 1)[0].split(None, 1)
        name = "".join(rest).strip().strip("\"'")
        if word.lower() != "@include":
            self.remarks.append(f"{where}: {_shortened(word)} is not known here, and passed over")
        elif file is None or root is None or not name:
            self.remarks.append(f"{where}: {_shortened(line)} names no file")
        elif reason := self._include(name, file, root, within):
            self.remarks.append(f"{where}: @include {_shortened(name)} {reason}; it is passed over")

    def _include(self, name: str, file: Path, root: Path, within: tuple[Path, ...]) -> str | None:
        """Read an included file, or say why it is not read.

        A file of parameters may come from anywhere, so it reaches only files of parameters in its own folder and below.
        """
        try:
            path = (file.parent / name).resolve()
            is_file = stat.S_ISREG(os.stat(path).st_mode) if path.is_relative_to(root) else False
        except FileNotFoundError:
            return "is not there"
        except (OSError, ValueError, RuntimeError) as error:
            return f"cannot be read ({getattr(error, 'strerror', None) or error})"
        if not path.is_relative_to(root):
            return f"leads out of the folder {str(root)!r}; give that file by itself, before this one"
        if path.suffix.lower() not in ENDINGS or not is_file:
            return f"is no file that ends in {', '.join(ENDINGS)}"
        if path in within:
            return "includes itself"
        if len(within) > MAX_DEPTH or self._includes >= MAX_INCLUDES:
            return f"is one too many: {MAX_INCLUDES} includes, {MAX_DEPTH} within each other"
        self._includes += 1
        self._file(_bytes(path), str(file.parent / name), path, root, within)
        return None


def _entry(line: str, where: str) -> tuple[int | None, str, float, str] | None:
    """Component (None: not said), name, value and flag of a line; None when it is none of a parameter.

    Raises:
        ParameterError: it is one, and its value is no number.
    """
    words = _SEPARATORS.split(line.split("#", 1)[0].strip(" \t,="))
    component = None
    if len(words) >= 4 and words[0].isdecimal() and words[1].isdecimal() and len(words[1]) < 4:
        component, words = int(words[1]), words[2:]
    name = words[0]
    if not _NAME.fullmatch(name):
        return None
    if len(words) < 2:
        if "_" in name and _PARAMETER.fullmatch(name):
            raise ParameterError(f"{where}: expected 'NAME VALUE', found {_shortened(line)}")
        return None
    value = _number(words[1])
    if value is None:
        if not _PARAMETER.fullmatch(name):
            return None
        raise ParameterError(f"{where}: {_shortened(words[1])} is not a number ({name})")
    if component is None and (comma := _DECIMAL_COMMA.fullmatch(line.split("#", 1)[0].strip())):
        text = comma[1]
        raise ParameterError(f"{where}: {text!r} has a comma ({name}); write {text.replace(',', '.')}")
    return component, name.upper(), value, words[2] if len(words) > 2 else ""


def _number(text: str) -> float | None:
    """Decimal or hexadecimal; None when it is neither, or larger than any parameter can be."""
    if _HEXADECIMAL.fullmatch(text):
        return float(int(text, 16))
    value = float(text) if _NUMBER.fullmatch(text) else math.inf
    return value if abs(value) <= FLOAT_LIMIT else None


def _shortened(text: str) -> str:
    return repr(text if len(text) <= _SHOWN else text[:_SHOWN] + "...")


def _bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            data = file.read(MAX_BYTES + 1)
    except OSError as error:
        raise ParameterError(f"parameter file {str(path)!r} cannot be read: {error.strerror}") from None
    except ValueError as error:  # a path with a NUL
        raise ParameterError(f"parameter file {str(path)!r} cannot be read: {error}") from None
    if len(data) > MAX_BYTES:
        raise ParameterError(f"parameter file {str(path)!r} is larger than {MAX_BYTES} bytes")
    return data


def _decoded(data: bytes, source: str) -> str:
    """As text; what is not UTF-8 is at most in comments."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return data.decode("utf-16", "replace")
    if b"\0" in data:
        raise ParameterError(f"parameter file {source!r} is not text")
    return data.decode("utf-8-sig", "replace")
