# Two commands do all the set-up on a fresh machine (Python 3.11, Node 20, make): `make run` and `make test`.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
STAMPS := .stamps
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)
MEASUREMENTS := docs/measurements
PAGE_SOURCES := $(shell find frontend -path frontend/node_modules -prune -o -path frontend/dist -prune -o -type f -print 2>/dev/null)

.PHONY: run test coverage check check-types check-python check-page kernel bench figures long fuzz load page-load sensor-faults truth takeovers battery-home codegen example architecture containers wheel requirements audit soak chaos compare-direction-finders setup setup-dev build browser unit played system stories clean help fly-real screens

# The tests start some two hundred servers and vehicles: where no bytecode is kept, each compiles every source again.
unexport PYTHONDONTWRITEBYTECODE

# Says where `make` is: $(call step,NUMBER/OF ALL,WHAT,HOW LONG).
step = @printf '\n[%s] %s (%s)\n' "$(1)" "$(2)" "$(3)"

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 28

run: ## server, embedded SQLite, simulated vehicle and emitter; the page is open to use
	$(call step,1/4,Python packages into .venv,a minute or two the first time)
	@$(MAKE) --no-print-directory setup
	$(call step,2/4,packages of the page,half a minute the first time)
	@$(MAKE) --no-print-directory frontend/node_modules/.installed
	$(call step,3/4,the page,a few seconds after a change)
	@$(MAKE) --no-print-directory build
	$(call step,4/4,the server,half a minute the first time: it compiles the planner; Ctrl-C ends it)
	@$(BIN)/crossfix serve

setup: $(VENV)/.installed ## the Python environment in .venv

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed; set PYTHON=")'
	$(PYTHON) -m venv $(VENV)

# Every package is compared with the hash that stands beside its version; what builds them is among them. The lists are
# whole: pip that looks for what they need by itself may take a newer version of a package with an extra, and refuse it.
# PIP_COMPILES=--no-compile leaves it to Python to compile what is imported, a third of all: tests start sooner so.
PIP := $(BIN)/pip install --quiet --disable-pip-version-check --no-deps $(PIP_COMPILES)

$(VENV)/.installed: pyproject.toml setup.py requirements/run.txt | $(VENV)/bin/python
	$(PIP) --require-hashes -r requirements/run.txt
	$(PIP) --no-build-isolation -e .
	@$(BIN)/pip check --quiet
	@touch $@

setup-dev: $(VENV)/.installed-dev

$(VENV)/.installed-dev: $(VENV)/.installed requirements/development.txt
	$(PIP) --require-hashes -r requirements/development.txt
	@$(BIN)/pip check --quiet
	@touch $@

frontend/node_modules/.installed: frontend/package.json frontend/package-lock.json
	cd frontend && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

build: frontend/dist/.built ## the page, into frontend/dist

frontend/dist/.built: frontend/node_modules/.installed $(PAGE_SOURCES)
	cd frontend && npm run --silent build -- --logLevel warn
	@touch $@

browser: ## Debian's Chromium, if there is none
	@command -v chromium >/dev/null || ($(SUDO) apt-get update -qq && $(SUDO) apt-get install -qq -y --no-install-recommends chromium)

test: ## everything CI runs
	$(call step,1/2,packages; style; imports; schemas; figures; the page and its tests; machine code; unit tests,ten minutes)
	@$(MAKE) --no-print-directory -j 2 --output-sync=recurse check-python check-page build unit PIP_COMPILES=--no-compile
	$(call step,2/2,whole missions; what a user does on the page in Chromium; types in what these leave of the processors,ten minutes)
	@$(MAKE) --no-print-directory -j 2 played check-types GIVING_WAY='nice -n 19'

played: ## whole missions and stories, one after the other, since they wait for the wall clock
	@$(MAKE) --no-print-directory system
	@$(MAKE) --no-print-directory stories

check: ## style, types, import contracts, wire schema, figures, picture, compose file, page unit tests
	@$(MAKE) --no-print-directory -j 2 --output-sync=recurse check-types check-python check-page

# A second thread would check anew what the first one knows. It allocates so much that room for what is young saves an
# eighth of its time.
check-types: setup-dev
	NODE_OPTIONS=--max-semi-space-size=128 $(GIVING_WAY) $(BIN)/pyright

check-python: setup-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/python -m backend.api.schema --check frontend/src/wire/openapi.json
	$(BIN)/python -m backend.reasons.catalogue --check frontend/src/i18n/reasons.en.ts
	$(BIN)/python -m tests.spoken --check tests/golden/reasons.json
	$(BIN)/python -m tests.fact_fields --check tests/golden/facts.json
	$(BIN)/python -m tests.benchmarks.figures --check
	$(BIN)/python -m docs.drawing --check
	$(BIN)/check-jsonschema --builtin-schema vendor.compose-spec docker-compose.yml

check-page: frontend/node_modules/.installed
	cd frontend && npm run --silent codegen -- --check
	cd frontend && npm run --silent check

# Both in one process: they share functions, which are kept on disk only inside of what calls them.
kernel: setup-dev ## machine code of plans and beliefs, compiled once here, not by each test worker
	$(BIN)/python -c "from threading import Event; from backend.wiring import compile_beliefs; from planner.plan import warm_up; warm_up(); compile_beliefs(Event())"

# By file, since what a file computes once is computed once; xdist knows no groups under this pytest.
# tests/conftest.py holds the marks to the folders, so that no run has to import the others' tests.
# tests/conftest.py also puts the files that take longest first; xdist's own order knows only how many tests they have.
BY_FILE := --dist loadfile --no-loadscope-reorder
UNIT_TESTS := $(BIN)/pytest -n 4 $(BY_FILE) --hypothesis-profile ci -m "not system and not browser and not long" \
  --ignore tests/browser --ignore tests/system

unit: kernel ## tests without a vehicle or a browser
	$(UNIT_TESTS) --durations 25

coverage: kernel ## how much of the code the unit tests run: they take longer so
	$(UNIT_TESTS) --cov --cov-report=
	@echo "The unit tests run $$($(BIN)/coverage report --format=total) % of the code; by file: $(BIN)/coverage report"

# These wait for the wall clock most of the time, so that more of them than there are cores go on beside one another;
# and a machine that stands still for seconds fails them: what failed once is tried once more, and the summary names it
# (RERUN), so that it is looked into.
ONCE_MORE := --reruns 1 -rR

system: setup-dev build kernel ## whole missions over real sockets
	$(BIN)/pytest tests/system tests/fuzz -m "system and not long" -n 3 --dist worksteal $(ONCE_MORE) --durations 8

stories: setup-dev build browser kernel ## what a user does on the page, in Chromium; in a process of its own, since it keeps an event loop
	$(BIN)/pytest tests/browser -m "not long" -n 3 $(BY_FILE) $(ONCE_MORE) --durations 8

# Not in `make test`, which is to end within twenty minutes.
long: setup-dev build browser kernel ## every screen's looks; stories of other sizes and whole seasons; the kernel against its reference 10,000 times
	$(BIN)/pytest -m long -n 2 $(BY_FILE) $(ONCE_MORE) --timeout 3600 --durations 8

fuzz: setup-dev build kernel ## 100,000 odd requests and messages to a running server: hours
	CROSSFIX_FUZZ_OUT=$(MEASUREMENTS) CROSSFIX_FUZZ_REQUESTS=100000 CROSSFIX_FUZZ_MESSAGES=100000 $(BIN)/pytest tests/fuzz -n 2 --timeout 86400

load: setup-dev build ## a hundred viewers, five of them stalled: latency and memory over ten minutes
	$(BIN)/python -m tests.benchmarks.live_load fanout --seconds 600 --out $(MEASUREMENTS)

page-load: setup-dev build browser ## the page: after a start, belief on screen, frames at 20 Hz, memory in replay, bytes per minute: an hour and a half
	$(BIN)/python -m tests.benchmarks.page_weight --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.page_start --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.page_belief --bearings 20 --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.page_frames --minutes 10 --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.page_bytes --minutes 5 --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.page_replay --minutes 60 --out $(MEASUREMENTS)

sensor-faults: setup-dev ## a thousand simulated missions for each sensor fault: an hour on one core
	$(BIN)/python -m tests.benchmarks.sensor_faults --missions 1000 --out $(MEASUREMENTS)

truth: setup-dev ## a thousand simulated missions for each way in which bearings are wrong: is what is claimed true? An hour
	$(BIN)/python -m tests.benchmarks.truth --missions 1000 --out $(MEASUREMENTS)

takeovers: setup-dev ## 200 pilots' switches aimed at our commands on each simulated autopilot, and headings in time: half an hour
	$(BIN)/python -m tests.benchmarks.takeover_aimed --flavour px4 --times 200 --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.takeover_aimed --flavour ardupilot --times 200 --out $(MEASUREMENTS)
	$(BIN)/python -m tests.benchmarks.heading_time --out $(MEASUREMENTS)

battery-home: setup-dev ## a thousand simulated returns in wind: what was promised of the battery, and what they took
	$(BIN)/python -m tests.benchmarks.battery_home --flights 1000 --out $(MEASUREMENTS)

SCREENS ?= test-results/screens
screens: setup-dev build browser ## every screen in both themes and three sizes into SCREENS, and what is clipped there: ten minutes; README=1 for its pictures
	$(BIN)/python -m tests.browser.sweep $(SCREENS) $(if $(README),--readme docs/screens)

codegen: setup-dev frontend/node_modules/.installed ## wire schema and TypeScript types from the pydantic models
	$(BIN)/python -m backend.api.schema frontend/src/wire/openapi.json
	$(BIN)/python -m backend.reasons.catalogue frontend/src/i18n/reasons.en.ts
	$(BIN)/python -m tests.spoken tests/golden/reasons.json
	$(BIN)/python -m tests.fact_fields tests/golden/facts.json
	cd frontend && npm run --silent codegen

architecture: setup-dev ## the picture of docs/architecture.md, from the imports
	$(BIN)/python -m docs.drawing

COMPOSE ?= docker compose
HTTPS_PORT ?= 443
HTTP_PORT ?= 80
containers: setup-dev ## walk through docs/install-for-a-team.md: image, mission, killed containers, restore; REMARK= into the record with OUT=
	COMPOSE_PROFILES=simulated ADDRESS=localhost SPEEDUP=1 HTTPS_PORT=$(HTTPS_PORT) HTTP_PORT=$(HTTP_PORT) \
	  $(BIN)/python -m tests.containers.fly --compose "$(COMPOSE)" \
	  --url https://localhost:$(HTTPS_PORT) --plain http://localhost:$(HTTP_PORT) $(if $(OUT),--out $(OUT) --remark "$(REMARK)")

wheel: setup-dev build ## dist/crossfix-VERSION.whl with the page inside: pipx install it, then crossfix serve
	$(BIN)/pip wheel --quiet --no-deps --no-build-isolation -w dist .
	@ls dist/crossfix-*.whl

requirements: ## requirements/*.txt with the hashes of what constraints.txt pins; after each change there
	$(PYTHON) -m venv $(STAMPS)/uv && $(STAMPS)/uv/bin/pip install --quiet uv
	cd requirements && ./compile.sh $(abspath $(STAMPS)/uv/bin/uv)

audit: setup-dev ## known vulnerabilities of the packages that are installed, of Python and of the page
	$(PYTHON) -m venv $(STAMPS)/audit && $(STAMPS)/audit/bin/pip install --quiet --no-deps --require-hashes -r requirements/audit.txt
	$(STAMPS)/audit/bin/pip-audit --disable-pip --require-hashes -r requirements/run.txt
	cd frontend && npm audit --omit=dev

SCALE ?= 1
CAMPAIGN = $(BIN)/python -m tests.benchmarks.campaign $@ $(if $(SHORT),--short,--scale $(SCALE)) $(if $(OUT),--out $(OUT))
soak: setup-dev build ## a hundred viewers for ten minutes, aborts under load, files of 50 MB: figures 6, 7 and 20; SHORT=1: five minutes
	$(CAMPAIGN)

chaos: setup-dev build kernel ## kills, random stories, outages, bad links, takeovers, odd requests: figures 8, 10, 12, 13, 15 and 19; hours, or SHORT=1
	$(CAMPAIGN)

example: setup-dev ## the flight that the page plays as its example, recorded again: after each change of the wire
	$(BIN)/python frontend/scripts/record_example.py

SWEEPS ?= 2000
compare-direction-finders: setup-dev ## three direction finders on 2,000 simulated sweeps per condition: the table and plot of docs/direction-finding.md
	$(BIN)/python -m tests.benchmarks.direction_finders --sweeps $(SWEEPS) --reliability docs/images/sigma_reliability.svg --out $(MEASUREMENTS)

bench: setup ## the planner's speed on this machine
	$(BIN)/python -m tests.benchmarks.planner_speed --out $(MEASUREMENTS)

FLAVOUR ?= px4
STRIKES ?= 96
fly-real: setup-dev ## a running autopilot, VEHICLE=its address: it takes off, is flown as every vehicle must, and pilots take it over
	@test -n "$(VEHICLE)" || { echo "Which vehicle? For instance: make fly-real VEHICLE=udpin://127.0.0.1:14540 FLAVOUR=px4"; exit 2; }
	@CROSSFIX_TEST_VEHICLE=$(VEHICLE) $(BIN)/pytest tests/contracts/vehicle -k real --timeout 900; suite=$$?; \
	$(BIN)/python -m tests.strikes.steady $(VEHICLE) --flavour $(FLAVOUR) --out $(MEASUREMENTS); steady=$$?; \
	$(BIN)/python -m tests.strikes $(VEHICLE) --flavour $(FLAVOUR) --times $(STRIKES) --out $(MEASUREMENTS); exit $$((suite + steady + $$?))

figures: setup-dev ## docs/measurements.md and the tables of the pages, from docs/measurements/*.json
	$(BIN)/python -m tests.benchmarks.figures

clean: ## removes everything that make created, but not the data
	rm -rf $(VENV) $(STAMPS) .coverage frontend/node_modules frontend/dist
