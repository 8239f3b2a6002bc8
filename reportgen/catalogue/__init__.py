"""The machines the house knows: one module each, imported when its kind is asked for.

A module gives `KIND` (its name in a file), `TITLES` (a line each language), `TURNS` of the driver in a
cycle, the models `Parameters` and, if it has one, `Indicator`, and `CHECKS`; `added_positions` if a turn
has more positions than the evenly spaced ones; `machine`, which makes a `Machine` of an assignment.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from reportgen import installation
from reportgen.assignment import reading
from reportgen.assignment.common import Assignment, Kind, file_model, none_added
from reportgen.errors import Problem
from reportgen.notation.numbers import Language

MODULES: Mapping[str, str] = {
    "engine-twin": "engine_twin",
    "engine-single": "engine_single",
    "slider-crank": "slider_crank",
    "four-bar": "four_bar",
    "lever-six-bar": "lever_six_bar",
    "slotted-lever": "slotted_lever",
    "shaper": "shaper",
    "engine-v": "engine_v",
    "linkage": "linkage",
}
"""Module of this package by kind; a new machine adds its line here and nowhere else."""


def module(kind: str) -> ModuleType:
    """The module of a kind; raises `KeyError` for a kind nobody knows."""
    return import_module(f"{__name__}.{MODULES[kind]}")


def kind(name: str) -> Kind:
    """What the reader of assignment files must know of a kind; raises `KeyError`."""
    machine = module(name)
    return Kind(
        machine.KIND,
        machine.Parameters,
        getattr(machine, "Indicator", None),
        machine.TURNS,
        machine.CHECKS,
        getattr(machine, "added_positions", none_added),
        getattr(machine, "INDICATOR_OPTIONAL", False),
    )


KINDS = reading.Kinds(tuple(MODULES), kind)


def titles(language: Language) -> dict[str, str]:
    """Each kind with its line of description."""
    return {name: title(name, language) for name in MODULES}


def title(name: str, language: Language) -> str:
    """The line of description of a kind; raises `KeyError`."""
    return str(module(name).TITLES[language])


def load(path: Path, language: Language | None = None) -> Assignment:
    """The assignment of a file; raises `AssignmentError` with all its faults."""
    return reading.load(path, KINDS, language)


def check(path: Path, language: Language | None = None) -> list[Problem]:
    """All faults of a file, none if it is in order."""
    return reading.check(path, KINDS, language)


def sample(name: str, language: Language) -> str:
    """The commented assignment file to fill in of a kind; raises `KeyError`."""
    if name not in MODULES:
        raise KeyError(name)
    file = f"{name}.yaml"
    return (installation.templates() / language / "new" / file).read_text(encoding="utf-8")


def schema() -> dict[str, Any]:
    """JSON Schema (2020-12) of an assignment file of any kind."""
    from pydantic import BaseModel
    from pydantic.json_schema import JsonSchemaMode, models_json_schema

    # All at once: models of one name in different kinds get names of their own.
    models: list[tuple[type[BaseModel], JsonSchemaMode]] = [
        (file_model(kind(name)), "validation") for name in MODULES
    ]
    kinds, definitions = models_json_schema(models, by_alias=True)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "reportgen assignment",
        "oneOf": [kinds[model] for model in models],
        **definitions,
    }
