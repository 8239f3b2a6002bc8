# Everything a checkout needs besides make is Python 3.11 or newer; PYTHON names another one.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
SAMPLE := assignments/engine-twin-05.yaml

.PHONY: setup report reports test quick proof hour lint bench fuzz pictures docs clean

setup: $(VENV)/.installed

report: setup
	$(BIN)/reportgen build $(SAMPLE)

reports: setup
	$(BIN)/reportgen build $(wildcard assignments/*.yaml assignments/*/*.yaml)

# What is compiled is kept whatever the environment says: each of the many processes that tests start would do it anew.
test: $(VENV)/.developing
	PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -rs -n auto

# What a change of formulas may break, while it is made: expressions, physics, books, wrong files.
quick: $(VENV)/.developing
	PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -n auto tests/formula tests/physics tests/textbook tests/broken

# What `make test` leaves out: the rest of each matrix, pages in a browser, killed batches, fuzz.
proof: $(VENV)/.developing
	PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest -rs -n auto -m proof

# The first hour of somebody new, from the built wheel in an empty environment.
hour:
	$(PYTHON) -m tests.hour --tools

lint: $(VENV)/.developing
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python -m tests.house

# The site of the documentation, into out/site; a link that leads nowhere is an error.
docs: $(VENV)/.developing
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict

bench: $(VENV)/.developing
	$(BIN)/python -m tests.bench
	$(BIN)/python -m tests.bench.batch
	$(BIN)/python -m tests.bench.page
	$(BIN)/python -m tests.bench.form
	$(BIN)/python -m tests.bench.reading
	$(BIN)/python -m tests.bench.growth --plot docs/pictures/growth.png

# The seed of the day: another ten thousand files each time, and new examples of what holds for any numbers.
fuzz: $(VENV)/.developing
	$(BIN)/python -m pytest -n auto --hypothesis-profile explore $(shell grep -rl "from hypothesis" tests --include=test_*.py)
	$(BIN)/python -W ignore -m tests.fuzz 10000 $(shell date +%Y%m%d)

pictures: $(VENV)/.developing
	$(BIN)/python docs/schemes.py
	$(BIN)/python docs/pictures.py
	$(BIN)/python docs/keys.py
	$(BIN)/python docs/options.py
	$(BIN)/python docs/atlas.py
	$(BIN)/python docs/error_codes.py
	$(BIN)/python docs/quantities.py

clean:
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache

# The stamps are made last, so that an installation that broke off is begun anew.
$(VENV)/.installed: pyproject.toml
	@echo "installing into $(VENV), which takes a minute or two"
	@$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed: make PYTHON=python3.12 …" if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

$(VENV)/.developing: $(VENV)/.installed requirements-dev.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint requirements-dev.lock --editable '.[dev]'
	touch $@
