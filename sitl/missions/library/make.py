# SPDX-License-Identifier: BSD-3-Clause
"""``python -m sitl.missions.library.make``: writes the library's files and its index from the drafts."""

from __future__ import annotations

import json
from pathlib import Path

from ..files import save
from . import FOLDER
from .draft import Draft
from .drafts import copter_drafts, rover_drafts

HEAD = """# SPDX-License-Identifier: BSD-3-Clause
# Made by `python -m sitl.missions.library.make`: each mission, its file, and the vehicle and world it is flown with.
"""


def drafts() -> dict[str, dict[str, Draft]]:
    """All, by kind of vehicle and name."""
    return {"copter": copter_drafts(), "rover": rover_drafts()}


def index() -> str:
    """The text of index.toml."""
    lines = [HEAD]
    for kind, found in drafts().items():
        for name, draft in found.items():
            lines.append(f"[{kind}.{name}]")
            row = {"file": f"{kind}/{name}{draft.suffix}", "description": draft.description, **draft.index}
            lines += [f"{key} = {json.dumps(value)}" for key, value in row.items()]
            lines.append("")
    return "\n".join(lines)


def write(folder: Path) -> None:
    """Write everything there."""
    for kind, found in drafts().items():
        (folder / kind).mkdir(parents=True, exist_ok=True)
        for name, draft in found.items():
            save(draft.file(), folder / kind / f"{name}{draft.suffix}")
    (folder / "index.toml").write_text(index(), encoding="utf-8")


if __name__ == "__main__":
    write(FOLDER)
