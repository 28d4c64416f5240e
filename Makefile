# One word a task. Every target makes what it needs first: `make study` and `make test` work on a fresh clone.
PYTHON ?= python3
BIN := .venv/bin
PIP := $(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt
PORT ?= 8000

.PHONY: help setup gl test-tools study demo test test-long lint docs catalogues clean
help:
	@echo "make study      build the thesis's study and serve it at http://127.0.0.1:$(PORT)"
	@echo "make demo       the same without people: 44 simulated raters, then demo/report/index.html"
	@echo "make test       every test (test-long: the same with larger counts)"
	@echo "make lint docs  style and types; the documentation"
	@echo "make catalogues the survey's texts collected for translation (study_server/locales)"
	@echo "make clean      remove the virtual environment and what the targets above made, except ratings"

setup: .venv/.ready gl
gl:
	@.ci/system gl

.venv/.ready: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "fakesss needs Python 3.11 or newer; name one with: make PYTHON=python3.12" >&2; exit 2; }
	@$(PYTHON) -m venv .venv || { echo "no virtual environment could be made; install with:  sudo apt-get install python3-venv" >&2; exit 2; }
	$(PIP) --editable .
	@touch $@

.venv/.ready-test: .venv/.ready
	$(PIP) --editable '.[test]'
	@touch $@

.venv/.ready-docs: .venv/.ready
	$(PIP) --editable '.[docs]'
	@touch $@

test-tools:
	@.ci/system browser postgres npm

node_modules/.ready: package.json package-lock.json | test-tools
	npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
	@touch $@

study/study.toml: | setup
	$(BIN)/fakesss new study --template thesis

study: setup study/study.toml
	$(BIN)/fakesss run study --port $(PORT)

demo: setup
	@rm -rf demo
	$(BIN)/fakesss new demo --template thesis
	$(BIN)/fakesss build demo
	$(BIN)/fakesss simulate demo --started 44 --completed 38 --seed 2011
	$(BIN)/fakesss report demo

test: setup .venv/.ready-test node_modules/.ready
	$(BIN)/python -m pytest -m "not long" -n 2 --dist worksteal

test-long: setup .venv/.ready-test node_modules/.ready
	$(BIN)/python -m pytest -n 2 --dist worksteal --timeout 3600 --hypothesis-profile long

lint: setup .venv/.ready-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: setup .venv/.ready-docs
	$(BIN)/sphinx-build -q -W -b html docs docs/_build/html
	@echo "docs/_build/html/index.html"

catalogues: setup
	$(BIN)/python -m study_server.wording.catalogues

clean:
	rm -rf .venv node_modules docs/_build build dist demo test-output *.egg-info .pytest_cache .hypothesis .mypy_cache .ruff_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +
