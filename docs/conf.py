# SPDX-License-Identifier: BSD-3-Clause
"""How Sphinx builds the documentation site: ``make docs`` writes it to build/docs."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]

import make_scenes  # noqa: E402

import sitl  # noqa: E402
from sitl.autopilot.params import docs  # noqa: E402
from sitl.vehicle.kinds import KINDS  # noqa: E402

project = "gym-sitl"
author = "the authors of gym-sitl"
project_copyright = author
version = release = sitl.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
]
exclude_patterns = ["templates"]  # what docs/make_pages.py fills in

myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 4
nb_execution_mode = "force"  # docs/notebooks; a cache would keep what older code printed
nb_execution_raise_on_error = True
nb_execution_timeout = 600

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autosummary_generate = True
autosummary_ignore_module_all = False
napoleon_numpy_docstring = False
napoleon_use_rtype = False
nitpick_ignore_regex = [(r"py:.*", r".*")]  # types of other packages in signatures; links between pages are all checked
copybutton_prompt_text = r"\$ |>>> "
copybutton_prompt_is_regexp = True

templates_path = ["_templates"]  # a class shows its methods in full
html_theme = "pydata_sphinx_theme"
html_title = "gym-sitl"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_theme_options = {
    "logo": {"text": f"gym-sitl {release}"},
    "use_edit_page_button": False,
    "navbar_end": ["theme-switcher"],
    "footer_start": ["copyright"],
    "footer_end": ["sphinx-version"],
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
    "navigation_with_keys": False,
}
html_sidebars = {"index": []}


def prepare(app: Any, name: str, source: list[str]) -> None:
    """What a page lacks on the site and has in the repository: folders to link to, a list of the pages beside it; and
    what it has on the site alone: scenes."""

    def without_folder(link: re.Match[str]) -> str:
        return link[1] if (ROOT / "docs" / name).parent.joinpath(link[2]).is_dir() else link[0]

    firmware = name.removeprefix("parameters-")
    if firmware in KINDS and firmware != name:
        source[0] = docs.page(firmware, KINDS[firmware].firmware.table)
    source[0] = re.sub(r"\[([^\]]+)\]\((\.\./[^)#]+)\)", without_folder, source[0])
    source[0] = make_scenes.embed(name, source[0])
    if name == "envs/index":
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\n*\n```\n"


def fly_scenes(app: Any) -> None:
    """Write the flights that pages show."""
    if app.builder.format == "html":
        make_scenes.make(Path(app.outdir) / "_static" / "scenes")


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("builder-inited", fly_scenes)
    app.connect("source-read", prepare)
