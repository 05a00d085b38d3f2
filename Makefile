# Two commands do all the set-up on a fresh machine (Python 3.11, Node 20, make): `make run` and `make test`.
PYTHON ?= $(shell command -v python3.11 || command -v python3)
VENV := .venv
BIN := $(VENV)/bin
SUDO := $(shell [ "$$(id -u)" = 0 ] || echo sudo)
PAGE_SOURCES := $(shell find frontend -path frontend/node_modules -prune -o -path frontend/dist -prune -o -type f -print 2>/dev/null)

.PHONY: run test check kernel bench long fuzz load page-load sensor-faults codegen compare-direction-finders setup setup-dev build browser unit system stories clean help

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*##/\t/' | expand -t 28

run: setup build ## server, embedded SQLite, simulated vehicle and emitter; the page is open to use
	$(BIN)/crossfix serve

setup: $(VENV)/.installed ## the Python environment in .venv

$(VENV)/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is needed; set PYTHON=")'
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[server,study]'
	@touch $@

setup-dev: $(VENV)/.installed-dev

$(VENV)/.installed-dev: $(VENV)/.installed
	$(BIN)/pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	@touch $@

frontend/node_modules/.installed: frontend/package.json frontend/package-lock.json
	cd frontend && npm ci --no-audit --no-fund --loglevel=error
	@touch $@

build: frontend/dist/.built ## the page, into frontend/dist

frontend/dist/.built: frontend/node_modules/.installed $(PAGE_SOURCES)
	cd frontend && npm run --silent build
	@touch $@

browser: ## Debian's Chromium, when there is none
	@command -v chromium >/dev/null || ($(SUDO) apt-get update -qq && $(SUDO) apt-get install -qq -y --no-install-recommends chromium)

test: check kernel ## everything CI runs; missions wait for the wall's clock, so the unit tests fill their pauses, and no browser does
	$(MAKE) -j2 -Otarget unit system
	$(MAKE) stories

check: setup-dev frontend/node_modules/.installed ## style, types, import contracts, wire schema, page unit tests
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/pyright
	$(BIN)/python -m backend.api.schema --check frontend/src/wire/openapi.json
	cd frontend && npm run --silent codegen -- --check
	cd frontend && npm run --silent check

kernel: setup-dev ## compiled once, not by each worker in a test
	$(BIN)/python -c "from planner.plan import warm_up; warm_up()"

unit: kernel ## tests without a vehicle or a browser
	nice -n 10 $(BIN)/pytest -n 2 --hypothesis-profile ci -m "not system and not browser and not long"

system: setup-dev build ## whole missions over real sockets
	$(BIN)/pytest -m "system and not browser" --durations 8

stories: setup-dev build browser ## what a user does on the page, in Chromium; a process of its own: it keeps an event loop
	$(BIN)/pytest -n 2 --dist loadfile -m browser --durations 8

long: setup-dev ## the kernel against its reference 10,000 times, and tables computed anew: a quarter of an hour
	$(BIN)/pytest -m long --timeout 3600

fuzz: setup-dev build ## 100,000 odd requests and messages against a running server; hours
	CROSSFIX_FUZZ_REQUESTS=100000 CROSSFIX_FUZZ_MESSAGES=100000 $(BIN)/pytest tests/fuzz --timeout 86400

load: setup-dev build ## a hundred viewers, five of them stalled: latency and memory over ten minutes
	$(BIN)/python -m tests.benchmarks.live_load fanout

page-load: setup-dev build browser ## the page: belief on screen, frames at 20 Hz, memory in replay, bytes a minute; an hour and a half
	$(BIN)/python -m tests.benchmarks.page_belief --bearings 20
	$(BIN)/python -m tests.benchmarks.page_frames --minutes 10
	$(BIN)/python -m tests.benchmarks.page_bytes --minutes 5
	$(BIN)/python -m tests.benchmarks.page_replay --minutes 60

sensor-faults: setup-dev ## a thousand simulated missions for each fault of the sensor: an hour on one core
	$(BIN)/python -m tests.benchmarks.sensor_faults --missions 1000

codegen: setup-dev frontend/node_modules/.installed ## wire schema and TypeScript types from the pydantic models
	$(BIN)/python -m backend.api.schema frontend/src/wire/openapi.json
	cd frontend && npm run --silent codegen

SWEEPS ?= 2000
compare-direction-finders: setup-dev ## three direction finders on 2,000 simulated sweeps a condition: the table and plot of docs/direction-finding.md
	$(BIN)/python -m hardware.direction_finding.comparison --sweeps $(SWEEPS) --reliability docs/images/sigma_reliability.svg

bench: setup ## the planner's speed on this machine
	$(BIN)/crossfix bench

clean: ## everything that was made, but not the data
	rm -rf $(VENV) frontend/node_modules frontend/dist
