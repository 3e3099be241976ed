# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.cheating [ID...]``: what every id pays to policies that do not do the task.

Two columns are mean returns; the next ones are scores, in which doing nothing has 0 and the trained policy that comes
with the package 1. No cheat may have half of that, and no early end of an episode (a crash, the floor, the end of the
arena) may be worth as much as the worst episode that went on until the time limit. All play the same episodes.
"""

from __future__ import annotations

import argparse
import sys
import warnings

from sitl.envs.ids import NEW

from .table import HEAD, line, row


def main() -> int:
    """Print the table; 1 where something pays that should not."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ids", nargs="*", metavar="ID", help="of sitl envs, with -v1; all are the default")
    parser.add_argument("--episodes", type=int, default=16, help="of each policy on each id (%(default)s)")
    options = parser.parse_args()
    warnings.filterwarnings("ignore", module="gymnasium")
    names = [name if name.startswith("sitl/") else f"sitl/{name}" for name in options.ids] or list(NEW)
    if unknown := [name for name in names if name not in NEW]:
        parser.error(f"{unknown[0]!r} is none of the ids -v1")
    print(HEAD, flush=True)
    pays = []
    for name in names:
        found = row(name, options.episodes)
        print(line(found), flush=True)
        pays += [f"{name}: {fault}" for fault in found.faults]
    print("\nNothing pays that should not." if not pays else "\nIt pays:\n" + "\n".join(pays))
    return int(bool(pays))


if __name__ == "__main__":
    sys.exit(main())
