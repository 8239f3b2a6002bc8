"""What the page for administrators shows: a unit and a container file that start the program as it is."""

from __future__ import annotations

import configparser
import json
import re
import shlex
from collections.abc import Sequence

import typer

from reportgen.cli import app
from tests.documents import fences, text_of

PAGE = "docs/reference/server.md"


def parsed(words: Sequence[str]) -> dict[str, object]:
    """The parameters of a call of `reportgen`, with any path before it; it must be one that the program has."""
    program = typer.main.get_command(app)
    start = next(index for index, word in enumerate(words) if word.rpartition("/")[2] == "reportgen")
    name, *rest = words[start + 1 :]
    command = vars(program)["commands"][name]
    context = command.make_context(name, list(rest), parent=typer.Context(program), resilient_parsing=True)
    parameters: dict[str, object] = context.params
    strict = command.context_class(command, info_name=name, **program.context_settings)
    command.make_parser(strict).parse_args(list(rest))
    return parameters


def test_the_unit_starts_the_server() -> None:
    (text,) = fences(PAGE, "ini")
    unit = configparser.ConfigParser(strict=True, interpolation=None)
    unit.optionxform = str  # type: ignore[assignment, method-assign]
    unit.read_string(text)
    call = parsed(shlex.split(unit["Service"]["ExecStart"]))
    assert str(call["folder"]) == unit["Service"]["ReadWritePaths"]
    assert str(call["base_url"]).startswith("https://")
    assert unit["Service"]["User"] in text_of(PAGE)
    assert unit["Service"]["UMask"] == "0077"


def test_the_container_starts_the_server() -> None:
    (text,) = fences(PAGE, "dockerfile")
    lines = re.sub(r"\\\n\s*", " ", text).splitlines()
    steps: dict[str, str] = {}
    for line in lines:
        name, _, content = line.partition(" ")
        assert name in {"FROM", "RUN", "USER", "VOLUME", "EXPOSE", "ENTRYPOINT", "CMD"}
        steps[name] = content
    call = parsed([*json.loads(steps["ENTRYPOINT"]), *json.loads(steps["CMD"])])
    assert (str(call["folder"]), call["host"], call["port"]) == (steps["VOLUME"], "0.0.0.0", int(steps["EXPOSE"]))
    assert f"useradd --system --uid 990 --create-home {steps['USER']}" in steps["RUN"]


def test_every_call_on_the_page_is_one_that_the_program_has() -> None:
    shown = "\n".join((*fences(PAGE, "sh"), *fences(PAGE, "text")))
    calls = re.findall(r"(?:/opt/reportgen/bin/)?reportgen serve [^\n]+", shown)
    assert len(calls) >= 3
    for call in calls:
        parsed(shlex.split(call))
