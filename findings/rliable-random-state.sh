#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# rliable 1.2.0: intervals do not repeat, though get_interval_estimates and StratifiedBootstrap take a random_state that is to make them
# reproducible. Runs are drawn by np.random.choice, the global generator, and random_state is left as it was: two calls with
# RandomState(1) give different intervals. np.random.seed before each call makes them equal. A plain `pip install rliable` does not even
# import: arch 7.2.0, which it comes with, raises TypeError with pandas 3.1.1; with pandas 2.3.3 it works.
# Seen: the lines below. Fails if two calls with the same random_state agree, or rliable is imported with pandas 3.1.1.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install -q rliable==1.2.0 arch==7.2.0 pandas==3.1.1 numpy==2.4.6
"$work/venv/bin/python" - <<'PYTHON'
try:
    import rliable.library
    raised = None
except TypeError as error:
    raised = error
print(f"import with pandas 3.1.1: {raised!r}")
assert raised is not None and "deprecate_kwarg" in str(raised)
PYTHON
"$work/venv/bin/pip" install -q pandas==2.3.3
"$work/venv/bin/python" - <<'PYTHON'
import numpy as np
from rliable import library, metrics

scores = {"ours": np.random.default_rng(0).normal(0.5, 0.1, (5, 4))}


def interval(random_state=None):
    def mean(rows):
        return np.array([metrics.aggregate_iqm(rows)])

    return library.get_interval_estimates(scores, mean, reps=200, random_state=random_state)[1]["ours"].ravel()


given = [interval(np.random.RandomState(1)) for _ in range(2)]
print(f"random_state=RandomState(1), twice: {given[0]}, {given[1]}")
assert not np.array_equal(*given)
seeded = []
for _ in range(2):
    np.random.seed(1)
    seeded.append(interval())
print(f"np.random.seed(1), twice: {seeded[0]}, {seeded[1]}")
assert np.array_equal(*seeded)
PYTHON
