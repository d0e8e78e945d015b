# Everything runs in an environment that this file makes. `make serve` installs what the service needs to run, the other
# targets install what the tests need, too.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
ENV := .venv
# Byte code that is written once saves every process seconds at its start.
unexport PYTHONDONTWRITEBYTECODE
BIN := $(ENV)/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes
# Wheels are compiled to byte code when they are first imported: most of what scipy holds never is.
PIP += --no-compile

.PHONY: serve test check kernels environment openapi judge plans textbook references record peers peers-scenes newest clean
.PHONY: browser pictures vendor site release release-contract

serve: $(ENV)/runs
	@$(BIN)/python -m service

test: environment
	@$(MAKE) --no-print-directory -j2 check kernels
	$(BIN)/python -m pytest -q -n 3 --dist worksteal

# All that is drawn or listed, of which `make test` takes a sample; before a release, and after a change of a kernel.
.PHONY: thorough

thorough: kernels
	THOROUGH=1 $(BIN)/python -m pytest -q -n 3 --dist worksteal

check: environment
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python clients/python/generate.py
	cd clients/python && ../../$(BIN)/mypy --strict polhode_client

# Otherwise every process of the tests would compile all of them.
kernels: environment
	$(BIN)/python -m service.execution.compilation

environment: $(ENV)/made

$(ENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 15))' || \
		{ echo "Polhode needs Python 3.11 to 3.14; name it: make PYTHON=/path/to/python3.11 $(MAKECMDGOALS)"; exit 1; }
	@$(PYTHON) -m venv $(ENV)

$(ENV)/runs: requirements.lock | $(ENV)/bin/python
	@echo "installing the packages of requirements.lock into $(ENV), once..."
	@$(PIP) -r requirements.lock
	@touch $@

$(ENV)/made: requirements-dev.lock | $(ENV)/bin/python
	@echo "installing the packages of requirements-dev.lock into $(ENV), once..."
	@$(PIP) -r requirements-dev.lock
	@touch $@ $(ENV)/runs

# Wheel, client packages, site and the promises of the API, which later versions are held to.
release: openapi release-contract site
	$(BIN)/python -m pip wheel --quiet --no-deps --wheel-dir build/release . ./clients/python
	cd clients/typescript && npm install --no-audit --no-fund && npm pack --ignore-scripts --pack-destination ../../build/release
	git archive --output build/release/image-context.tar.gz HEAD Dockerfile requirements.lock core docker service examples

release-contract: environment
	$(BIN)/python -m tests.service.openapi.contract docs/openapi.json > docs/releases/$$($(BIN)/python -c 'from service import VERSION; print(VERSION)').json

openapi: environment
	$(BIN)/python -m service --openapi > docs/openapi.json

judge: environment
	$(BIN)/python -m tests.core.certified.judge 100000
	$(BIN)/python -m tests.core.multibody.judge 10000
	$(BIN)/python -m tests.core.multibody.named_judge 1000
	$(BIN)/python -m tests.core.multibody.contact_judge 10000
	$(BIN)/python -m tests.core.multibody.audit.judge 20000
	$(BIN)/python -m tests.core.multibody.relations.judge 20000
	$(BIN)/python -m tests.oracles.plain_engine.comparison.run 5000 0
	$(BIN)/python -m tests.oracles.plain_engine.comparison.run changes 1000 0 plain_engine_changes.json
	$(BIN)/python -m tests.oracles.plain_engine.comparison.run catalogue

plans: environment
	RANDOM_QUESTIONS=300 $(BIN)/python -m pytest -q tests/service/test_plan.py -k random

# Every textbook question that is asked backwards, some of them for seconds.
textbook: environment
	WHOLE_TEXTBOOK=1 $(BIN)/python -m pytest -q tests/service/textbook

# Published problems in pairs of doubles: writes docs/references.md.
references: environment
	$(BIN)/python -m benchmarks.references

record: environment
	$(BIN)/python -m benchmarks.method_record

# Peers are installed here and nowhere else. One that cannot be (numbalsoda wants a Fortran compiler) is reported.
PEERS := .venv-peers

peers: $(PEERS)/made
	$(PEERS)/bin/python -m benchmarks.peers

peers-scenes: $(PEERS)/made
	$(PEERS)/bin/python -m benchmarks.described_scenes
	$(PEERS)/bin/python -m benchmarks.contact_peers

$(PEERS)/made: requirements-dev.lock benchmarks/peers.txt
	$(PYTHON) -m venv $(PEERS)
	$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check -r requirements-dev.lock
	while read -r peer; do \
		$(PEERS)/bin/python -m pip install --quiet --disable-pip-version-check "$$peer" || echo "not installed: $$peer"; \
	done < benchmarks/peers.txt
	touch $@

# The tests with the newest release of the server, whose minor version is otherwise pinned; to be run on a schedule.
NEWEST := .venv-newest

newest:
	$(PYTHON) -m venv $(NEWEST)
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.lock
	$(NEWEST)/bin/python -m pip install --quiet --disable-pip-version-check --upgrade uvicorn
	$(NEWEST)/bin/python -m pip list 2>/dev/null | grep -i uvicorn
	$(NEWEST)/bin/python -m pytest -q -n 3 --dist worksteal

# What is read and written of MJCF against MuJoCo itself, which is in this environment alone.
.PHONY: mujoco
MUJOCO := .venv-mujoco

mujoco:
	$(PYTHON) -m venv $(MUJOCO)
	$(MUJOCO)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements-dev.lock
	$(MUJOCO)/bin/python -m pip install --quiet --disable-pip-version-check "$$(grep ^mujoco benchmarks/peers.txt)"
	$(MUJOCO)/bin/python -m pytest -q -n 2 -k mujoco tests/core/interchange

# The pages in a real Chromium (Debian: apt-get install chromium), driven from an environment of its own.
BROWSER := .venv-browser
CHROMIUM := $(shell command -v chromium || command -v chromium-browser || command -v google-chrome)

ifeq ($(CHROMIUM),)
browser pictures:
	@echo "skipped: no Chromium is installed here, and the pages are tested in no other browser"
else
browser: $(ENV)/runs $(BROWSER)/made
	$(BROWSER)/bin/python -m pytest -q --confcutdir=tests/browser tests/browser

pictures: $(ENV)/runs $(BROWSER)/made
	$(BROWSER)/bin/python -m tests.browser.pictures
endif

$(BROWSER)/made: tests/browser/requirements.txt
	$(PYTHON) -m venv $(BROWSER)
	$(BROWSER)/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	@touch $@

# Types of the pages' scripts, which JSDoc states; needs npm and its registry.
.PHONY: types

types:
	rm -rf build/types && mkdir -p build/types
	cp tests/browser/types/package.json tests/browser/types/tsconfig.json build/types
	cd build/types && npm install --no-audit --no-fund --silent && npx tsc -p tsconfig.json

# The documentation as a static site in build/site/html, which loads nothing from elsewhere.
SITE := .venv-site

site: $(ENV)/runs $(SITE)/made
	$(BIN)/python -m docs.site build/site
	NO_MKDOCS_2_WARNING=1 $(SITE)/bin/mkdocs build --quiet --config-file build/site/mkdocs.yml
	@! grep -rlE '<(script|img|link)[^>]* (src|href)="?https?:' build/site/html --include='*.html'

$(SITE)/made: docs/site/requirements.txt
	$(PYTHON) -m venv $(SITE)
	$(SITE)/bin/python -m pip install --quiet --disable-pip-version-check -r $<
	@touch $@

# The vendored files of the pages, from the npm packages of the versions in service/page/vendor/package.json.
VENDOR := service/page/vendor

vendor:
	rm -rf build/vendor && mkdir -p build/vendor
	cp $(VENDOR)/package.json $(VENDOR)/three.entry.mjs build/vendor
	cd build/vendor && npm install --no-audit --no-fund && npm run build
	cp build/vendor/three.js build/vendor/uplot.js build/vendor/swagger-ui-bundle.js build/vendor/swagger-ui.css $(VENDOR)
	cp build/vendor/node_modules/uplot/dist/uPlot.min.css $(VENDOR)/uplot.css
	cp build/vendor/node_modules/three/LICENSE $(VENDOR)/three.LICENSE.txt
	cp build/vendor/node_modules/uplot/LICENSE $(VENDOR)/uplot.LICENSE.txt
	cat build/vendor/node_modules/swagger-ui-dist/NOTICE build/vendor/node_modules/swagger-ui-dist/LICENSE > $(VENDOR)/swagger-ui.LICENSE.txt
	cp build/vendor/node_modules/swagger-ui-dist/swagger-ui-bundle.js.LICENSE.txt $(VENDOR)/swagger-ui-bundle.LICENSE.txt
	cp build/vendor/node_modules/katex/dist/katex.min.js build/vendor/node_modules/katex/dist/katex.min.css docs/site/katex
	cp build/vendor/node_modules/katex/LICENSE docs/site/katex/LICENSE.txt
	for font in docs/site/katex/fonts/*; do cp build/vendor/node_modules/katex/dist/fonts/$$(basename $$font) $$font; done

clean:
	rm -rf $(ENV) $(PEERS) $(NEWEST) $(BROWSER) $(SITE) build .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find core service -name __pycache__ -prune -exec rm -rf {} +

# A longer fuzz than the tests', with a new seed each time; FUZZ is the number of questions for each endpoint.
FUZZ ?= 2000

# Seconds of load and faults.
SOAK ?= 300

# What hostile clients and users of the machine have tried: docs/deployment.md has the table. On the loopback interface alone.
ATTACKS := tests/service/test_server.py tests/service/test_fuzz.py tests/service/http/test_raw_streams.py \
	tests/service/test_slow_readers.py tests/service/http/test_limits.py tests/service/http/test_keys.py \
	tests/service/http/test_compression.py tests/service/test_event_loop.py tests/service/test_nginx.py \
	tests/service/http/test_dispatch.py tests/service/http/test_held_bytes.py \
	tests/service/execution/test_admission.py tests/service/execution/test_worker_pool.py \
	tests/service/studies/test_cluster.py tests/service/studies/test_engine.py tests/service/studies/test_resources.py \
	tests/clients/test_learning_platforms.py tests/clients/test_lti_bridge.py

.PHONY: attacks

attacks: kernels
	timeout 1800 $(BIN)/python -m pytest -q $(ATTACKS)

.PHONY: clients

# Generated clients compile in strict mode and call every operation; those in TypeScript need npm and its registry.
clients: kernels
	$(BIN)/python -m pytest -q tests/clients/generated_clients.py tests/clients/generated_typescript.py

.PHONY: fuzz spoilt fuzz-loop schemathesis soak scheduling health image dial studies mutants

# Small changes of the code, each of which a test has to notice: MUTANTS of them, drawn by MUTANTS_SEED.
MUTANTS ?= 300
MUTANTS_SEED ?= 1

mutants: kernels
	$(BIN)/python -m tests.mutation $(MUTANTS) $(MUTANTS_SEED)

fuzz: environment
	POLHODE_FUZZ=$(FUZZ) $(BIN)/python -m pytest -q tests/service/test_fuzz.py

# Numbered, spoilt questions to every endpoint: a run goes on where it was ended. SPOILT is the number of the last.
SPOILT ?= 100000

spoilt: kernels
	mkdir -p build
	$(BIN)/python -W ignore -m tests.service.mutation_run $(SPOILT) build/spoilt.txt

# Whether anything holds the event loop: extreme questions to every endpoint, judged by counts of work and of calls.
fuzz-loop: environment
	POLHODE_FUZZ=$(FUZZ) $(BIN)/python -m pytest -q tests/service/test_event_loop.py

schemathesis: environment
	$(BIN)/python -m tests.service.schema_run

soak: environment
	$(BIN)/python -m benchmarks.soak $(SOAK)

scheduling: environment
	$(BIN)/python -m benchmarks.scheduling

health: environment
	$(BIN)/python -m benchmarks.service_health

# Studies by real servers on real clusters, with kills; then what they cost.
studies: environment
	$(BIN)/python -m tests.service.studies.real_clusters
	$(BIN)/python -m benchmarks.studies

# Whether the errors of fits are true, over 1,000 sets of data.
.PHONY: coverage
coverage: environment
	$(BIN)/python -m benchmarks.coverage_of_fits

# Error against work of every method over 200 bodies: a study, and its figure in docs/accuracy.md.
dial: environment
	$(BIN)/python -m benchmarks.dial

# The steps of the Dockerfile in a clean Debian, and the image as it is meant to run; needs root and debootstrap.
image: environment
	$(BIN)/python -m tests.image.clean_root
