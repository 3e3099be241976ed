# SPDX-License-Identifier: BSD-3-Clause
"""What pyproject.toml cannot say: a wheel takes the pages of docs/ along, for ``sitl help``."""

from __future__ import annotations

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

DOCS = Path(__file__).parent / "docs"


class BuildWithPages(build_py):
    """Copies the pages beside the modules. An editable installation reads them where they are."""

    def run(self) -> None:
        super().run()
        if not self.editable_mode:
            for page in sorted({*DOCS.glob("*.md"), *DOCS.glob("*/*.md")} - {*DOCS.glob("templates/*")}):
                target = Path(self.build_lib, "sitl", "docs", page.relative_to(DOCS))
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(page, target)


setup(cmdclass={"build_py": BuildWithPages})
