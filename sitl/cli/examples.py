# SPDX-License-Identifier: BSD-3-Clause
"""``sitl examples``: the programs that come with the package, listed and copied."""

from __future__ import annotations

import argparse
import filecmp
from collections.abc import Iterator
from pathlib import Path

from ..core.whole_file import write_whole
from ..errors import OptionError, did_you_mean
from .example_programs import EXAMPLES, source, title
from .output import add_json_option, print_json

COPIES = Path("examples")
"""Folder in which copies are put: the commands of the documentation find them there."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("examples")
    parser.add_argument("name", nargs="?", metavar="NAME", help="one of the list (default: all)")
    parser.add_argument("--copy", action="store_true", help=f"copy it to the folder {COPIES}, to run and to change it")
    add_json_option(parser, "a list of examples")
    parser.set_defaults(function=examples)


def examples(options: argparse.Namespace) -> int:
    """List examples, describe one, or copy them.

    Raises:
        OptionError: a name that is not known; a file of that name is there, and is another.
    """
    if options.name is not None and options.name not in EXAMPLES:
        hint = did_you_mean(options.name, EXAMPLES) or "; sitl examples lists them"
        raise OptionError(f"example {options.name!r} is not known{hint}")
    names = [options.name] if options.name else list(EXAMPLES)
    if options.json:
        print_json([
            {"name": name, "title": title(name), "command": EXAMPLES[name].command, "needs": EXAMPLES[name].needs,
             "source": str(source(name))}
            for name in names
        ])  # fmt: skip
    elif not options.copy:
        show(names)
    if options.copy:
        copied = [copy(name, COPIES) for name in names]
        if not options.json:
            print(*copied, sep="\n")
            print(
                f"run it: {EXAMPLES[names[0]].command}" if options.name else "sitl examples NAME tells how to run one"
            )
    return 0


def show(names: list[str]) -> None:
    """Print a table, or all about one example."""
    if len(names) > 1:
        width = max(map(len, names))
        for name in names:
            print(f"{name:{width}s}  {title(name)}")
        return
    (name,) = names
    print(f"{title(name)}\n\n  source: {source(name)}\n  copy:   sitl examples {name} --copy")
    print(f"  run:    {EXAMPLES[name].command}")
    if EXAMPLES[name].needs:
        print(f"  needs:  pip install {' '.join(EXAMPLES[name].needs)}")


def copy(name: str, folder: Path) -> Path:
    """Copy an example into a folder, and return where it is. A copy that is the same already is left.

    Raises:
        OptionError: a file of that name is there, and is another; the folder cannot be written.
    """
    path = source(name)
    files = [path] if path.is_file() else list(_files(path))
    wanted = [(file, folder / file.relative_to(path.parent)) for file in files]
    for file, target in wanted:
        if target.exists() and not filecmp.cmp(file, target, shallow=False):
            raise OptionError(f"{target} is there and differs from the example: move it away, or delete it")
    try:
        for file, target in wanted:
            target.parent.mkdir(parents=True, exist_ok=True)
            write_whole(target, file.read_bytes(), OptionError)
    except OSError as error:
        raise OptionError(f"{folder} cannot be written: {error.strerror}") from None
    return folder / path.name


def _files(folder: Path) -> Iterator[Path]:
    return (file for file in sorted(folder.rglob("*")) if file.is_file() and "__pycache__" not in file.parts)
