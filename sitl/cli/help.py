# SPDX-License-Identifier: BSD-3-Clause
"""``sitl help``: the pages of the documentation, without a browser and without a network."""

from __future__ import annotations

import argparse
import pydoc
import re
import sys
from functools import cache
from pathlib import Path

from ..errors import OptionError, did_you_mean

PACKAGE = Path(__file__).parents[1]
_COMMENT = re.compile(r"^<!--.*?-->\n+", re.M | re.S)
FOLDERS = ("tutorials", "envs", "notebooks", "reference", "")
"""Of the pages, in the order in which they are listed."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("help")
    parser.add_argument("topic", nargs="?", metavar="TOPIC", help="a page (default: list them), or a command")
    parser.set_defaults(function=show)


def show(options: argparse.Namespace) -> int:
    """Print a page, or the list of pages.

    Raises:
        OptionError: there is no such page.
    """
    from .command_list import COMMANDS

    found = pages()
    if options.topic is None:
        width = max(map(len, found))
        print(*(f"{name:{width}s}  {title(page)}" for name, page in found.items()), sep="\n")
        print("\n`sitl help` with one of these names prints that page")
        return 0
    topic = options.topic.removeprefix("docs/").removesuffix(".md")
    topic = topic if topic in found else topic.rpartition("/")[2]
    if topic in found:
        text = _COMMENT.sub("", found[topic].read_text(encoding="utf-8"))
        pydoc.pager(text) if sys.stdout.isatty() else print(text, end="")
        return 0
    if topic in COMMANDS:
        from . import main

        return main([topic, "--help"])
    known = did_you_mean(topic, [*found, *COMMANDS])
    raise OptionError(f"there is no page {topic!r}{known or '; `sitl help` lists them'}")


@cache
def pages() -> dict[str, Path]:
    """The pages by their names: those of the wheel, or of the repository that this package is in. A name that a page
    of the top has, too, is distinguished by the folder."""
    root = next((folder for folder in (PACKAGE / "docs", PACKAGE.parent / "docs") if folder.is_dir()), PACKAGE / "docs")
    every = [page for folder in FOLDERS for page in sorted((root / folder).glob("*.md")) if page.stem != "index"]
    top = {page.stem for page in every if page.parent == root}

    def name(page: Path) -> str:
        return f"{page.parent.name}/{page.stem}" if page.parent != root and page.stem in top else page.stem

    return {name(page): page for page in every}


def title(page: Path) -> str:
    """Its first heading."""
    lines = page.read_text(encoding="utf-8").splitlines()
    return next((line.removeprefix("# ") for line in lines if line.startswith("# ")), page.stem)
