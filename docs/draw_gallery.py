# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_gallery.py [NAME...]``: runs examples as a user would; keeps the pictures of gallery.md."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

from sitl.cli.example_programs import EXAMPLES

IMAGES = Path(__file__).parent / "images" / "gallery"
COLOURS = 128
"""Of a picture."""


def draw(name: str) -> None:
    """Copy an example into an empty folder, run its command there, and keep the picture that it draws."""
    with tempfile.TemporaryDirectory() as desk:
        commands = Path(desk) / "bin"
        commands.mkdir()
        for program, module in (("python", ""), ("sitl", " -m sitl")):
            (commands / program).write_text(f'#!/bin/sh\nexec "{sys.executable}"{module} "$@"\n')
            (commands / program).chmod(0o755)
        environment = {**os.environ, "PATH": f"{commands}{os.pathsep}{os.environ['PATH']}"}
        for line in (f"sitl examples {name} --copy", EXAMPLES[name].command):
            subprocess.run(["sh", "-c", line], cwd=desk, env=environment, check=True)
        image = Image.open(Path(desk) / f"{name}.png").convert("RGB")
        image.quantize(COLOURS, Image.Quantize.MAXCOVERAGE).save(IMAGES / f"{name}.png", optimize=True)


def main() -> None:
    """Draw them."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[1:] or [name for name in EXAMPLES if "matplotlib" in EXAMPLES[name].needs]:
        draw(name)


if __name__ == "__main__":
    main()
