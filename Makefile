# Aliases only; what they call can be called by hand as well.
PYTHON ?= python3
CORES ?= $(shell nproc 2>/dev/null || getconf _NPROCESSORS_ONLN)
BIN = .venv/bin
# Processes run side by side; threads of linear algebra would wait for one another.
export OPENBLAS_NUM_THREADS = 1

.PHONY: env study test quick long bench blind recovery

env: .venv/installed

.venv/installed: requirements.lock
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "error: Python 3.11 or later is needed, e.g. make env PYTHON=python3.12")'
	$(PYTHON) -m venv .venv
	$(BIN)/pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(BIN)/pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	@touch $@

study: env
	$(BIN)/snakemake -j$(CORES)

test: env
	$(BIN)/python -m pytest

quick: env
	$(BIN)/python -m pytest -m "not slow and not long"

long: env
	$(BIN)/python -m pytest -m long

bench: env
	$(BIN)/python tests/bench

blind: env
	$(BIN)/python -m tests.blind

recovery: env
	$(BIN)/python -m tests.recovery
