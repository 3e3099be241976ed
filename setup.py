# SPDX-License-Identifier: BSD-3-Clause
"""What pyproject.toml cannot say: a wheel takes the pages of docs/ along, for ``sitl help``; with ``SITL_WHEEL=x86_64``
(or ``aarch64``) in the environment also the machine code that ``sitl cache ship`` has made for that architecture."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py

ROOT = Path(__file__).parent
DOCS = ROOT / "docs"
SHIPPED = ROOT / "build" / "shipped"
ARCHITECTURE = os.environ.get("SITL_WHEEL", "")
TAG = "manylinux_2_17"
"""Libraries ask for nothing of the system but functions that all C libraries have."""


class BuildWithPages(build_py):
    """Copies pages and machine code beside the modules. An editable installation reads pages where they are, and
    compiles its core."""

    def run(self) -> None:
        super().run()
        if self.editable_mode:
            return
        for page in sorted({*DOCS.glob("*.md"), *DOCS.glob("*/*.md")} - {*DOCS.glob("templates/*")}):
            self._copy(page, "docs", page.relative_to(DOCS))
        shutil.rmtree(Path(self.build_lib, "sitl", "core", "shipped", "libraries"), ignore_errors=True)
        if ARCHITECTURE:
            libraries = sorted(SHIPPED.glob(f"core-{ARCHITECTURE}*.so"))
            if not libraries:
                raise SystemExit(
                    f"SITL_WHEEL={ARCHITECTURE}: no {SHIPPED}/core-{ARCHITECTURE}*.so; sitl cache ship makes it"
                )
            for library in libraries:
                self._copy(library, "core", "shipped", "libraries", library.name)

    def _copy(self, file: Path, *place: str | Path) -> None:
        target = Path(self.build_lib, "sitl", *place)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, target)


class MaybeWithCode(Distribution):
    """Goes where packages with machine code are installed, if it has some."""

    def has_ext_modules(self) -> bool:
        return bool(ARCHITECTURE)


class WheelOfOneArchitecture(bdist_wheel):
    """Names the wheel after the architecture whose machine code it contains; any Python from 3.11 takes it."""

    def get_tag(self) -> tuple[str, str, str]:
        return ("py3", "none", f"{TAG}_{ARCHITECTURE}") if ARCHITECTURE else super().get_tag()


setup(distclass=MaybeWithCode, cmdclass={"build_py": BuildWithPages, "bdist_wheel": WheelOfOneArchitecture})
