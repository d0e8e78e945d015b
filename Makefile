# Everything runs in an environment that this file makes: Python 3.11 and a compiler are all it needs.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
ENV := .venv
BIN := $(ENV)/bin

.PHONY: serve test check environment openapi judge record peers clean

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

judge: environment
	$(BIN)/python -m tests.core.certified.judge 100000

record: environment
	$(BIN)/python -m benchmarks.method_record

# Peers are installed here and nowhere else. One that cannot be (numbalsoda wants a Fortran compiler) is reported.
PEERS := .venv-peers

peers: $(PEERS)/made
	$(PEERS)/bin/python -m benchmarks.peers

$(PEERS)/made: requirements-dev.lock benchmarks/peers.txt
	$(PYTHON) -m venv $(PEERS)
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-dev.lock
	while read -r peer; do \
		$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check "$$peer" || echo "not installed: $$peer"; \
	done < benchmarks/peers.txt
	touch $@

clean:
	rm -rf $(ENV) $(PEERS) .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find core service -name __pycache__ -prune -exec rm -rf {} +

# A longer fuzz than the tests', with a new seed each time; FUZZ is the number of questions for each endpoint.
FUZZ ?= 2000

# Seconds of load and faults.
SOAK ?= 300

.PHONY: fuzz fuzz-loop schemathesis soak overload health calibration image

fuzz: environment
	POLHODE_FUZZ=$(FUZZ) $(BIN)/python -m pytest -q tests/service/test_fuzz.py

# Whether anything holds the event loop: extreme questions to every endpoint, judged by counts of work and of calls.
fuzz-loop: environment
	POLHODE_FUZZ=$(FUZZ) $(BIN)/python -m pytest -q tests/service/test_event_loop.py

schemathesis: environment
	$(BIN)/python -m tests.service.schema_run

soak: environment
	$(BIN)/python -m benchmarks.soak $(SOAK)

overload: environment
	$(BIN)/python -m benchmarks.service_overload

health: environment
	$(BIN)/python -m benchmarks.service_health

calibration: environment
	$(BIN)/python -m benchmarks.calibration

# The steps of the Dockerfile in a clean Debian, and the image as it is meant to run; needs root and debootstrap.
image: environment
	$(BIN)/python -m tests.image.clean_root
