# Everything runs in an environment that this file makes: Python 3.11 and a compiler are all it needs.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
ENV := .venv
BIN := $(ENV)/bin

.PHONY: serve test check environment openapi benchmarks peers clean

serve: environment
	$(BIN)/python -m service

test: environment check
	$(BIN)/python -m pytest -q -n 2 --dist worksteal

check: environment
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

environment: $(ENV)/made

$(ENV)/made: requirements-dev.lock
	$(PYTHON) -m venv $(ENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.lock
	touch $@

openapi: environment
	$(BIN)/python -m service --openapi > docs/openapi.json

clean:
	rm -rf $(ENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find core service -name __pycache__ -prune -exec rm -rf {} +
