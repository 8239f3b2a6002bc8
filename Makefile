# Everything a checkout needs besides make is Python 3.11 or newer; PYTHON names another one.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
SAMPLE := assignments/engine-twin-05.yaml

.PHONY: setup report reports test lint bench pictures clean

setup: $(VENV)/.installed

report: setup
	$(BIN)/reportgen build $(SAMPLE)

reports: setup
	$(BIN)/reportgen build $(wildcard assignments/*.yaml)

test: $(VENV)/.developing
	$(BIN)/python -m pytest -rs -n auto --dist loadfile

lint: $(VENV)/.developing
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: $(VENV)/.developing
	$(BIN)/python -m tests.bench
	$(BIN)/python -m tests.bench.batch

# The README's pictures: a page with a plan, and the kinematic scheme of each kind of machine.
define PICTURES
import dataclasses
from pathlib import Path
import pymupdf
from PIL import Image
from reportgen import api, catalogue

def save(page, clip, dpi, name):
    pixels = page.get_pixmap(dpi=dpi, clip=clip)
    picture = Image.frombytes("RGB", (pixels.width, pixels.height), pixels.samples)
    picture.quantize(96, Image.Quantize.FASTOCTREE).save(Path("docs", name), optimize=True)

def document(file):
    return api.document(api.load(file, "en"))

def pages(tree):
    return pymupdf.open(stream=api.typeset(tree, "typst")[1])

def scheme(tree):
    figure = next(block for block in tree.blocks if getattr(block, "key", "") == "fig.scheme")
    alone = dataclasses.replace(figure, caption=(), key="", number="")
    return dataclasses.replace(tree, header=("", ""), footer=("", ""), blocks=(alone,))

report = pages(document("$(SAMPLE)"))
page = next(page for page in report if page.search_for(": Velocity plan at") or page.search_for(". Velocity plan at"))
save(page, None, 100, "page.png")
for kind in catalogue.MODULES:
    page = pages(scheme(document(min(Path("assignments").glob(f"{kind}-*.yaml")))))[0]
    body = page.rect + (0, 72, 0, -72)
    drawn = pymupdf.Rect()
    for path in page.get_drawings():
        if path["rect"] in body:
            drawn |= path["rect"]
    save(page, drawn + (-15, -12, 15, 4), 60, f"{kind}.png")
endef
export PICTURES

pictures: $(VENV)/.developing
	$(BIN)/python -c "$$PICTURES"

clean:
	rm -rf $(VENV) .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache

# The stamps are made last, so that an installation that broke off is begun anew.
$(VENV)/.installed: pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed: make PYTHON=python3.12 …" if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	touch $@

$(VENV)/.developing: $(VENV)/.installed requirements-dev.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint requirements-dev.lock --editable '.[dev]'
	touch $@
