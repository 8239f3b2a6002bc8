"""Every name that a template uses stands in the table of names, and nothing stands there that no template uses."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from unittest import mock

import pytest
from jinja2 import Environment, meta, nodes

from reportgen import api
from reportgen.base.kinds import SAMPLE
from reportgen.base.template_folders import search_path, templates
from reportgen.base.topics import topics
from reportgen.base.words import SECTION, load_words, sections
from reportgen.cases import opened
from reportgen.document import Block
from reportgen.document.template_rendering import GLOBALS, Prose, _environment
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.report import named_figures, named_tables, template_names
from reportgen.report.topic_views import VIEWS

ROOT = templates()
REPOSITORY = Path(__file__).parents[2]
ASSIGNMENTS = REPOSITORY / "assignments"
OTHERS = {
    "plane-motion/01.yaml": {"catalogue/plane-motion.md", "steps.md"},
    "cam/roller-01.yaml": {"catalogue/cam.md"},
    "gears/pair-equal-sliding.yaml": {"catalogue/gear-pair.md"},
    "gears/train-motor.yaml": {"catalogue/planetary-train.md"},
    "friction/belt.yaml": {"catalogue/friction.md"},
    "rotor/rotor-two-planes.yaml": {"catalogue/rotor.md"},
    "engine-balance/v-six.yaml": {"catalogue/engine-balance.md"},
    "turning-moment/curve.yaml": {"catalogue/turning-moment.md"},
    "structure/geared-bars.yaml": {"catalogue/structure.md"},
    "synthesis/best-crank-rocker.yaml": {"catalogue/synthesis.md#synthesis-"},
    "synthesis/crank-rocker-by-frame.yaml": {"catalogue/synthesis.md#synthesis-"},
    "synthesis/slider-crank-by-offset.yaml": {"catalogue/synthesis.md#synthesis-"},
    "synthesis/three-points-logarithm.yaml": {"catalogue/synthesis.md#three-points-"},
}
"""The files of words of each kind of work that is no machine, by one of its assignments.

A file with sections for several tasks stands with the beginning of their names behind #.
"""
Sections = Mapping[tuple[Path, str], nodes.Template]
OF_TOPICS = {name for hooks in VIEWS.among(topics()) for name in (*hooks.values, *hooks.functions)}
OF_REPORT = {*template_names.PROPERTIES, *template_names.VALUES, *template_names.FUNCTIONS, *OF_TOPICS}


@cache
def environment() -> Environment:
    """The environment that templates are rendered in, with the names that it gives to each of them."""
    return _environment((ROOT,))


@cache
def parsed() -> Sections:
    return {
        (path.relative_to(ROOT), name): environment().parse(section.text)
        for path in sorted(ROOT.rglob("*.md"))
        for name, section in sections(path).items()
        if name not in (SECTION, SAMPLE)
    }


def of_machines() -> Sections:
    others = {file.partition("#")[0] for files in OTHERS.values() for file in files}
    return {place: tree for place, tree in parsed().items() if named(place[0]) not in others}


def of_another(file: str) -> Sections:
    wanted = [one.partition("#") for one in OTHERS[file]]
    return {
        (path, section): tree
        for (path, section), tree in parsed().items()
        if any(named(path) == name and section.startswith(prefix) for name, _, prefix in wanted)
    }


def named(path: Path) -> str:
    """The place of a file in the folder of its language."""
    return path.relative_to(path.parts[0]).as_posix()


def used(trees: Sections) -> dict[str, tuple[Path, str]]:
    """The names that templates use without binding them themselves, each with a template that does."""
    return {name: path for path, tree in trees.items() for name in meta.find_undeclared_variables(tree)}


def bound(trees: Sections) -> set[str]:
    """The names that templates bind, which those that they include may use."""
    named = (one for tree in trees.values() for one in tree.find_all(nodes.Name))
    return {one.name for one in named if one.ctx != "load"}


def handed(file: str) -> set[str]:
    """The names that the templates of an assignment's report and task get."""
    case, found, render = opened(api.load(ASSIGNMENTS / file)), set[str](), Prose.render

    def noted(prose: Prose, name: str, names: Mapping[str, object]) -> tuple[Block, ...]:
        found.update(names)
        return render(prose, name, names)

    with mock.patch.object(Prose, "render", noted):
        case.document()
        task_of(case, key_of(case))
    return found


def called(function: str) -> Iterator[str]:
    """The first arguments of a function where templates call it."""
    for path, tree in of_machines().items():
        for call in tree.find_all(nodes.Call):
            if isinstance(call.node, nodes.Name) and call.node.name == function:
                (name, *_) = call.args
                assert isinstance(name, nodes.Const), (path, call.lineno)
                yield name.value


@cache
def documented() -> set[str]:
    """The names that the page on templates explains."""
    text = (REPOSITORY / "docs" / "reference" / "template-language.md").read_text(encoding="utf-8")
    section = text.split("## Names in templates\n")[1].split("\n## ")[0]
    rows = [line.split(" | ")[0] for line in section.splitlines() if line.startswith("| `")]
    return set(re.findall(r"`(\w+)", "\n".join(rows)))


def test_every_name_that_a_template_uses_is_in_the_table() -> None:
    known = handed("shaper-01.yaml") | OF_TOPICS | bound(of_machines()) | set(GLOBALS)
    assert {name: path for name, path in used(of_machines()).items() if name not in known} == {}


def test_every_name_in_the_table_is_used_or_explained() -> None:
    assert OF_REPORT - set(used(of_machines())) - documented() == set()


def test_every_name_that_is_explained_exists() -> None:
    assert documented() - OF_REPORT - set(GLOBALS) == set()


def test_no_name_stands_in_two_tables() -> None:
    of_topics = [name for hooks in VIEWS.among(topics()) for name in (*hooks.values, *hooks.functions)]
    own = [*template_names.PROPERTIES, *template_names.VALUES, *template_names.FUNCTIONS, *GLOBALS, *of_topics]
    assert len(own) == len(set(own))


@pytest.mark.parametrize("file", OTHERS)
def test_the_templates_of_other_work_use_the_names_that_they_get_and_all_of_them(file: str) -> None:
    names, trees = handed(file), of_another(file)
    known = names | bound(trees) | set(GLOBALS)
    assert {name: path for name, path in used(trees).items() if name not in known} == {}
    assert names - set(used(trees)) == set()


@pytest.mark.parametrize("kind", ["figure", "table"])
def test_figures_and_tables_are_those_that_templates_name(kind: str) -> None:
    """A table of quantities by their ids has words of its own and no row."""
    named = set(called(kind))
    rows = set(named_figures.FIGURES if kind == "figure" else named_tables.TABLES)
    rows.update(
        name for hooks in VIEWS.among(topics()) for name in (hooks.figures if kind == "figure" else hooks.tables)
    )
    assert rows - named == set()
    words = {name for path in search_paths() for name in load_words(path)["tables"]} if kind == "table" else set()
    assert named - rows <= words


def search_paths() -> Iterator[tuple[Path, ...]]:
    for kind in sorted({api.load(file).kind for file in ASSIGNMENTS.glob("*.yaml")}):
        yield search_path("en", kind=kind)


def test_no_table_of_rows_is_wider_than_the_text() -> None:
    widths = {name: sum(made.widths) for name, made in named_tables.TABLES.items() if hasattr(made, "widths")}
    assert {name: width for name, width in widths.items() if width > 160} == {}
