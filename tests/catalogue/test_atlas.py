"""Machines of the atlas: every machine of the program in memory, files of a department, formulas, and their faults."""

from __future__ import annotations

import math
import os
import pickle
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from reportgen import catalogue
from reportgen.assignment.parameter_formulas import ANGLE, Amount, FormulaError, formula
from reportgen.base.atlas_words import machine_source, machine_words
from reportgen.base.field_words import field_words
from reportgen.base.kinds import kinds, title, titles
from reportgen.base.template_folders import ATLAS_VARIABLE, MOST_MACHINES, atlas_files, languages
from reportgen.base.topics import topics
from reportgen.base.words import templates_hash
from reportgen.base.yaml_source import read_text
from reportgen.cases import open_case
from reportgen.catalogue import atlas, linkage
from reportgen.catalogue.atlas_file import checked
from reportgen.catalogue.optional_chapters import lacking
from reportgen.cli import app
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from reportgen.page.edit_session import EditSession
from reportgen.page.kind_cards import scheme_file
from reportgen.page.pulled_values import placing_values
from reportgen.results import results
from tests.kinds import ATLAS_MACHINE
from tests.lanes import matrix
from tests.page.test_first_view import schemes

MACHINES = sorted(atlas_files())
SLOTTER = """
words:
  en:
    title: A slotter <b>& more</b> %% given
    description: "Crank *1* turns {{ own.about }} steadily; $x$ is said."
    parameters: {a: length of the crank, h: distance of the axes, w: speed of the crank}
    links: {3: the slotted link}
parameters:
  a: {default: 50 mm, least: 20 mm, most: 90 mm}
  h: {default: 150 mm, least: 100 mm}
  w: {default: 60 rpm}
linkage:
  frame: {A: [0 mm, 0 mm], D: [0 mm, -h]}
  driver: {type: crank, centre: A, pin: B, length: a, n: w}
  groups:
    - {type: RPR, links: [2, 3], joints: [B, C, D]}
  points: {E: {link: 3, at: [h + a + 20 mm, 0 mm]}}
"""


@pytest.fixture
def department(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a department with a slotter, named by the environment."""
    folder = tmp_path / "machines"
    folder.mkdir()
    (folder / "slotter.yaml").write_text(SLOTTER, "utf-8")
    monkeypatch.setenv(ATLAS_VARIABLE, str(folder))
    return folder


def examined(kind: str, parameters: str, folder: Path) -> list[str]:
    """Return the errors of an assignment with some parameters, as they are printed."""
    file = folder / "mine.yaml"
    file.write_text(f"kind: {kind}\nreport: {{language: en}}\nparameters: {parameters}\n", "utf-8")
    return [str(problem) for problem in catalogue.check(file)]


@pytest.mark.parametrize("kind", MACHINES)
def test_the_file_of_a_machine_is_right_and_complete(kind: str) -> None:
    """It assembles with its defaults, has all words in each language, a starter file in each, and a sample."""
    machine = atlas.machine_of(kind)
    content = machine.compiled.content
    assert checked(machine.compiled, machine_source(atlas_files()[kind]), linkage.CHECKS) == []
    links = {str(link) for group in content.linkage["groups"] for link in group["links"]} | {"1"}
    for language in languages():
        words = content.words[language]
        assert words.uses
        assert words.parameters.keys() == machine.compiled.parameters.keys()
        assert words.links.keys() <= links
    for language in languages():
        assert catalogue.understood(read_text(catalogue.sample(kind, language)), Path("x.yaml"))[1] == []
    for sample in catalogue.examples(kind).values():
        assert catalogue.check(sample) == []
    assert catalogue.examples(kind)


@pytest.mark.parametrize("kind", matrix(MACHINES, [ATLAS_MACHINE]))
def test_a_machine_has_its_report_key_task_and_scheme(kind: str) -> None:
    """They are made in memory.  A scheme that differs is drawn anew by `python docs/schemes.py`."""
    sample = min(catalogue.examples(kind).values(), key=lambda path: path.stat().st_size)
    case = open_case(sample, "vi")
    key = key_of(case)
    assert (key.kind, results(case)["kind"]) == (kind, kind)
    assert len(key.asked) > 20
    about = atlas.machine_of(kind).compiled.content.words["vi"].description
    assert about in str(task_of(case, key).blocks)
    assert pickle.loads(pickle.dumps(case.assignment)) == case.assignment
    document, drawn = open_case(sample, "en").document(), schemes()
    assert len(document.blocks) > 100
    assert drawn.as_file(kind, drawn.scheme_in(document)) == scheme_file(kind).read_text(encoding="utf-8")


def test_a_machine_of_a_department_is_served_as_any_kind(department: Path, tmp_path: Path) -> None:
    assert "atlas/slotter" in kinds()
    assert examined("atlas/slotter", "{a: 45 mm}", tmp_path) == []
    made = catalogue.machine_of(catalogue.read_source(tmp_path / "mine.yaml"), tmp_path / "mine.yaml")
    assert made is not None
    assert made.linkage.driver.length == pytest.approx(0.045)
    assert made.linkage.points[0].local == pytest.approx(0.215)
    assert made.facts["called"] == {"l.AB": "Length of the crank", "n": "Speed of the crank"}
    words = field_words("atlas/slotter", "vi")["parameters.a"]
    assert (words.name, words.remark) == ("length of the crank", "20 mm … 90 mm")
    about = next(
        one["properties"]["a"]
        for one in catalogue.schema("en")["definitions"].values()
        if {"h", "w"} <= one["properties"].keys()
    )
    assert (about["x-unit"], about["x-range"]) == ("mm", {"minimum": 20.0, "maximum": 90.0})
    assert about["description"] == "length of the crank, 20 mm … 90 mm"


def test_text_of_a_machine_is_never_markup_nor_a_template(department: Path, tmp_path: Path) -> None:
    examined("atlas/slotter", "{}", tmp_path)
    case = open_case(tmp_path / "mine.yaml")
    assert case.title == "A slotter <b>& more</b> %% given"
    assert "Text(text='Crank *1* turns {{ own.about }} steadily; $x$ is said.'" in str(case.document().blocks)


@pytest.mark.parametrize(
    ("change", "at", "code"),
    [
        (("h + a + 20 mm", "h + aa"), "h + aa", "formula-name"),
        (("h + a + 20 mm", "h + w"), "h + w", "formula-units"),
        (("h + a + 20 mm", "h*a"), "h*a", "formula-units"),
        (("h + a + 20 mm", "h/(a - a)"), "h/(a", "formula-value"),
        (("h + a + 20 mm", "h.si"), "h.si", "formula-syntax"),
        (("h + a + 20 mm", "sin(h)"), "sin(h)", "formula-units"),
        (("h + a + 20 mm", "h + a + 2 mm^2/a"), "h + a", "formula-syntax"),
        (("h + a + 20 mm", "h + a + 1 mm*_0/h"), "h + a", "formula-syntax"),
        (("w: {", "m: {"), "m: {", "parameter-name"),
        (("w: {", "g: {"), "g: {", "parameter-name"),
        (("w: {", "plane: {"), "plane: {", "parameter-name"),
        (("w: {", "in: {"), "in: {", "parameter-name"),
        (("n: w", "n: 60 rpm"), "w: {", "parameter-unused"),
        (("least: 20 mm, most", "least: 60 mm, most"), "50 mm", "out-of-range"),
        (("least: 20 mm, most", "least: 20 N, most"), "20 N", "wrong-unit"),
        (("links: {3", "links: {x"), "x: the", "no-such-link"),
        (("  en:", "  xx:"), "xx:", "choice"),
        (("title: A", "titel: A"), "titel", "unknown-key"),
        (("joints: [B, C, D]", "joints: [B, C, X]"), "X]", "no-such-point"),
        (("type: RPR", "type: RPX"), "RPX", "choice"),
        (("[h + a + 20 mm", "[h: ["), ", 0 mm]}}", "syntax"),
        (
            ("RPR, links: [2, 3],", "RRR, lengths: [a, a/2], side: left, links: [2, 3],"),
            "{type: RRR",
            "never-assembled",
        ),
    ],
)
def test_a_fault_of_a_machine_is_at_its_place_and_stops_no_other(
    department: Path, tmp_path: Path, change: tuple[str, str], at: str, code: str
) -> None:
    assert SLOTTER.count(change[0]) == 1
    file, text = department / "bad.yaml", SLOTTER.replace(*change)
    file.write_text(text, "utf-8")
    before = text[: text.index(at)]
    place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
    found = examined("atlas/bad", "{}", tmp_path)
    assert [line for line in found if f"{file}:{place}: error[{code}]" in line], found
    assert examined("atlas/slotter", "{}", tmp_path) == []
    assert "atlas/bad" not in catalogue.sound_kinds()
    assert titles("en")["atlas/slotter"].startswith("A slotter")


def test_a_fault_of_the_linkage_is_at_the_parameter_that_causes_it(department: Path, tmp_path: Path) -> None:
    assert "mine.yaml:3:17: error[out-of-range]" in examined("atlas/slotter", "{a: 95 mm}", tmp_path)[0]
    rods = "RRR, lengths: [170 mm, h], side: left"
    text = SLOTTER.replace("RPR", rods)
    (department / "rocker.yaml").write_text(text, "utf-8")
    assert examined("atlas/rocker", "{a: 45 mm}", tmp_path) == []
    (found,) = examined("atlas/rocker", "{a: 90 mm, h: 100 mm}", tmp_path)
    assert "mine.yaml:3:27: error[no-assembly]" in found


def test_a_formula_without_a_value_is_a_fault_at_the_parameters(department: Path, tmp_path: Path) -> None:
    """Whether the root of a negative number, or a value that a linkage refuses."""
    for formula_of_a, code in (("sqrt(a^2 - 0.1*h^2)", "formula-value"), ("a - 45 mm", "out-of-range")):
        text = SLOTTER.replace("length: a,", f"length: {formula_of_a},")
        (department / "rooted.yaml").write_text(text, "utf-8")
        assert examined("atlas/rooted", "{}", tmp_path) == []
        for topic in ("", ", flywheel: {delta: 1/50}", ", balancing: {}"):
            found = examined("atlas/rooted", f"{{a: 40 mm{topic}}}", tmp_path)
            assert re.search(rf"mine.yaml:3:\d+: error\[{code}\]", found[0])


@pytest.mark.parametrize("unit", ["foo", "[N]", "{a: N}"])
def test_an_unknown_unit_of_a_table_is_a_fault(department: Path, tmp_path: Path, unit: str) -> None:
    load = f"loads: [{{by: angle, link: 3, torque_unit: {unit}, angle: [0 deg, 360 deg], values: [h, h]}}]"
    (department / "bad.yaml").write_text(SLOTTER.replace("  points:", f"  {load}\n  points:"), "utf-8")
    found = examined("atlas/bad", "{}", tmp_path)
    assert any("bad.yaml:17:" in line and "error[unknown-unit]" in line for line in found), found


def test_words_of_a_wrong_form_are_left_out(department: Path) -> None:
    """Where the titles of all kinds are listed, as in the form, a faulty machine has its name."""
    words = SLOTTER.replace("title: A slotter <b>& more</b> %% given", "title: {a: b}\n    uses: {a: b}")
    (department / "bad.yaml").write_text(words.replace("links: {3: the slotted link}", "links: none"), "utf-8")
    assert titles("en")["atlas/bad"] == "bad"
    assert "links" not in machine_words(atlas_files()["atlas/bad"], "en")


def test_a_topic_is_added_to_a_machine_that_is_loaded_by_its_defaults(department: Path, tmp_path: Path) -> None:
    mass = "masses: [{link: 3, at: E, G: 20 N}]"
    (department / "heavy.yaml").write_text(SLOTTER.replace("  points:", f"  {mass}\n  points:"), "utf-8")
    assert examined("atlas/heavy", "{flywheel: {delta: 1/50}, balancing: {}}", tmp_path) == []
    machine = catalogue.module("atlas/heavy").machine(catalogue.load(tmp_path / "mine.yaml"))
    assert machine.topics.keys() == {"flywheel", "balancing"}
    assert "flywheel-without-loads" in examined("atlas/slotter", "{flywheel: {delta: 1/50}}", tmp_path)[0]


def test_a_machine_without_masses_lacks_only_chapters_that_a_file_can_add(department: Path, tmp_path: Path) -> None:
    examined("atlas/slotter", "{}", tmp_path)
    assignment = catalogue.load(tmp_path / "mine.yaml")
    machine = catalogue.module("atlas/slotter").machine(assignment)
    wanted = [group for _, groups in lacking(machine, assignment.parameters) for group in groups]
    assert wanted
    assert all(group and group[0][1] in topics() for group in wanted)


def test_the_form_names_the_file_of_a_faulty_machine_and_still_takes_changes(department: Path, tmp_path: Path) -> None:
    (department / "bad.yaml").write_text(SLOTTER.replace("-h]", "-hh]"), "utf-8")
    examined("atlas/bad", "{a: 45 mm}", tmp_path)
    session = EditSession(partial(open_case, tmp_path / "mine.yaml"), "en", path=tmp_path / "mine.yaml")
    assert "<code>bad.yaml:13</code> “hh” is not a parameter of this machine" in session.form()
    session.edit({"op": "set", "where": ["parameters", "a"], "value": "46 mm", "was": "45 mm"})
    assert "{a: 46 mm}" in (tmp_path / "mine.yaml").read_text("utf-8")


def test_a_point_that_is_dragged_changes_the_parameter_behind_it(department: Path, tmp_path: Path) -> None:
    examined("atlas/slotter", "{a: 45 mm, h: 150 mm}", tmp_path)
    values = placing_values(catalogue.read_source(tmp_path / "mine.yaml"), tmp_path / "mine.yaml")[1]
    assert {value.where[1]: (value.low, value.high) for value in values} == {"a": (20.0, 90.0), "h": (100.0, np.inf)}


def test_a_table_of_loads_has_formulas_with_units(department: Path, tmp_path: Path) -> None:
    loads = "loads: [{by: angle, link: 3, torque_unit: N m, angle: [0 deg, 90 deg, 360 deg], values: [0, M/2, -1 N*h]}]"
    text = SLOTTER.replace("  w: {", "  M: {default: 0.4 kN m}\n  w: {").replace("  points:", f"  {loads}\n  points:")
    (department / "loaded.yaml").write_text(text, "utf-8")
    assert examined("atlas/loaded", "{M: 30 N m}", tmp_path) == []
    given = catalogue.load(tmp_path / "mine.yaml").parameters
    assert given.expanded.loads[0].values == (0.0, 15.0, -0.15)


def test_a_folder_has_machines_alone_and_no_link_leads_out(department: Path, tmp_path: Path) -> None:
    outside = tmp_path / "outside.yaml"
    outside.write_text(SLOTTER, "utf-8")
    (department / "stray.yaml").symlink_to(outside)
    (department / "Not A Name.yaml").write_text(SLOTTER, "utf-8")
    (department / "notes.txt").write_text("text", "utf-8")
    assert [name for name in atlas_files() if name not in MACHINES] == ["atlas/slotter"]
    (department / "large.yaml").write_text(SLOTTER + "#" * 500_000, "utf-8")
    assert "error[too-large]" in examined("atlas/large", "{}", tmp_path)[0]


def test_a_machine_without_words_in_a_language_has_those_of_another(department: Path) -> None:
    assert title("atlas/slotter", "vi").startswith("A slotter")
    (department / "slotter.yaml").write_text("words: [", "utf-8")
    assert title("atlas/slotter", "vi") == "slotter"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("-b", -0.2),
        ("a/2 + b*0.5", 0.15),
        ("sqrt(a*b)", 0.02**0.5),
        ("2*(a + 3 cm)", 0.26),
        ("a^2/b", 0.05),
        ("b·sin(30 deg)", 0.1),
        ("a + b*cos(acos(0.5))", 0.2),
        ("b − 50mm", 0.15),
    ],
)
def test_a_formula_is_evaluated_with_its_units(text: str, value: float) -> None:
    metre = Amount(1.0, (("meter", 1.0),))
    given = {"a": Amount(0.1, metre.dimension), "b": Amount(0.2, metre.dimension)}
    found = formula(text, frozenset(given)).value(given)
    assert found.si == pytest.approx(value, rel=1e-12)
    assert found.dimension == metre.dimension


@pytest.mark.parametrize(
    "text",
    ["a.real", "a[0]", "print(a)", "a if a else b", "lambda: a", "a**99", "'a'", "True", "(a", "a, b", "a" * 200],
)
def test_a_formula_is_nothing_but_arithmetic(text: str) -> None:
    with pytest.raises(FormulaError):
        formula(text, frozenset("ab"))


def test_the_commands_take_a_folder_of_machines(
    department: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """`new` begins a file that `check` accepts; `kinds` prints the good machines and the faults of the others."""
    monkeypatch.delenv(ATLAS_VARIABLE)

    def run(*arguments: object) -> tuple[int, str, str]:
        with monkeypatch.context() as patch:
            # The option sets the variable, which is as before once the command has ended.
            patch.setenv(ATLAS_VARIABLE, "")
            with pytest.raises(SystemExit) as end:
                app([*map(str, arguments)], prog_name="reportgen")
        printed = capsys.readouterr()
        return int(end.value.code or 0), printed.out, printed.err

    (department / "bad.yaml").write_text(SLOTTER.replace("-h]", "-hh]"), "utf-8")
    code, listed, faults = run("kinds", "--atlas", department, "--lang", "en")
    assert code == 1
    assert "atlas/bad" not in listed
    assert re.search(r"^atlas/slotter +A slotter <b>& more</b> %% given$", listed, re.MULTILINE)
    assert faults.startswith(f"{department}/bad.yaml:13:38: error[formula-name]: “hh” is not a parameter")
    assert run("new", "atlas/slotter", "--atlas", department, "-o", tmp_path / "mine.yaml", "--lang", "en")[0] == 0
    assert run("check", tmp_path / "mine.yaml", "--atlas", department) == (0, "", "")
    assert run("check", department / "slotter.yaml") == (0, "", "")
    assert run("check", department / "bad.yaml", "--lang", "en") == (1, "", faults)
    assert run("check", tmp_path / "mine.yaml")[0] == 1


def test_a_changed_machine_makes_its_reports_anew(department: Path) -> None:
    before = templates_hash()
    (department / "slotter.yaml").write_text(SLOTTER.replace("50 mm", "51 mm"), "utf-8")
    changed = templates_hash()
    assert changed != before
    (department / "folder.yaml").mkdir()
    os.mkfifo(department / "pipe.yaml")
    assert templates_hash() != changed


def test_bounds_and_links_of_a_machine_are_checked(department: Path, tmp_path: Path) -> None:
    """A bound at which the machine fails is a warning; an empty range and a link that is missing are errors."""
    for old, new, expected in (
        ("most: 90 mm", "most: 150 mm", "bound-fails"),
        ("most: 90 mm", "most: 10 mm", "range-order"),
        ("least: 100 mm}", "most: 100 mm}", "out-of-range"),
        ("links: {3:", "links: {9:", "no-such-link"),
    ):
        assert old in SLOTTER
        (department / "slotter.yaml").write_text(SLOTTER.replace(old, new), "utf-8")
        (problem, *_) = catalogue.examine(department / "slotter.yaml", "en")
        assert (problem.level == "warning") == (expected == "bound-fails")
        assert problem.code == expected
        assert "inf" not in problem.message
    (department / "slotter.yaml").write_text(SLOTTER, "utf-8")
    assert catalogue.examine(department / "slotter.yaml", "en") == []


def test_a_machine_without_names_or_with_a_wrong_name_is_told(department: Path) -> None:
    """Both are warnings: the machine is right, but the form shows keys, and no kind has this name."""
    file = department / "Slotter_2.yaml"
    file.write_text(SLOTTER.replace(", h: distance of the axes", ""), "utf-8")
    found = catalogue.examine(file, "en")
    assert [(one.code, one.level) for one in found] == [
        ("machine-file-name", "warning"),
        ("parameters-unnamed", "warning"),
    ]
    assert found[1].message.endswith(": h")


@pytest.mark.parametrize("text", ["180 mm/2", "20 mm + 30 mm", "20 mm + a", "h - 2*3 mm"])
def test_a_formula_may_begin_with_a_quantity(department: Path, text: str) -> None:
    file = department / "slotter.yaml"
    file.write_text(SLOTTER.replace("h + a + 20 mm", text), "utf-8")
    assert catalogue.examine(file, "en") == []


@pytest.mark.parametrize(
    ("text", "hint"), [("0.4h", "write “0.4*h”"), ("2a + h", "write “2*a + h”"), ("h 2", "a formula has parameters")]
)
def test_a_missing_sign_of_a_product_is_named(department: Path, text: str, hint: str) -> None:
    file = department / "slotter.yaml"
    file.write_text(SLOTTER.replace("h + a + 20 mm", text), "utf-8")
    (problem,) = catalogue.examine(file, "en")
    assert problem.code == "formula-syntax"
    assert str(problem.hint).startswith(hint)


def test_a_machine_that_is_not_there_asks_for_its_folder(department: Path, tmp_path: Path) -> None:
    (found,) = examined("atlas/sloter", "{}", tmp_path)
    assert "unknown-machine" in found
    assert "--atlas" in found


def test_a_spec_is_told_from_an_assignment() -> None:
    """Each choice of a spec would be a fault of an assignment; it has one, which says what to do."""
    spec = Path(__file__).parents[2] / "assignments" / "class-demo" / "spec.yaml"
    (problem,) = catalogue.examine(spec, "en")
    assert problem.code == "is-a-spec"
    assert "reportgen variants" in str(problem.hint)


def test_a_misspelt_key_is_named_before_the_parameters_that_it_leaves_unused(department: Path) -> None:
    for change, code in (
        (("length: a", "lenght: a"), "unknown-key"),
        (("{type: crank, centre: A, pin: B, length: a, n: w}", "x"), "wrong-type"),
    ):
        assert SLOTTER.count(change[0]) == 1
        (department / "slotter.yaml").write_text(SLOTTER.replace(*change), "utf-8")
        codes = [one.code for one in catalogue.examine(department / "slotter.yaml", "en")]
        assert code in codes
        assert "parameter-unused" not in codes


@pytest.mark.parametrize("text", ["h/2", "180 mm/2", "h", "sqrt(h*h)"])
def test_a_default_or_a_bound_is_not_a_formula(department: Path, text: str) -> None:
    """So parameters cannot depend on each other; a number without its unit is a fault of its own."""
    for key in ("default: 50 mm", "least: 20 mm"):
        (department / "slotter.yaml").write_text(SLOTTER.replace(key, f"{key.split()[0]} {text}"), "utf-8")
        (problem,) = catalogue.examine(department / "slotter.yaml", "en")
        assert problem.code == "formula-here"
        assert f"“{text}”" in problem.message
    (department / "slotter.yaml").write_text(SLOTTER.replace("least: 20 mm", "least: 20"), "utf-8")
    assert catalogue.examine(department / "slotter.yaml", "en")[0].code == "missing-unit"


@pytest.mark.parametrize("missing", ["words", "linkage"])
def test_a_file_without_words_or_linkage_is_still_a_machine(department: Path, missing: str) -> None:
    """Its one fault is the missing section, not the missing `kind` of an assignment."""
    parts = re.split(r"(?m)^(?=\w)", SLOTTER)
    (department / "slotter.yaml").write_text("".join(p for p in parts if not p.startswith(missing)), "utf-8")
    (problem,) = catalogue.examine(department / "slotter.yaml", "en")
    assert problem.code == "missing-key"
    assert f"“{missing}”" in problem.message


def test_files_of_a_folder_that_are_not_read_are_named(department: Path, tmp_path: Path) -> None:
    """Wrong names and the machines past the limit give warnings; links out of the folder and hidden files do not."""
    for name in ("Shears.yaml", "press 2.yaml", "saw.yml", ".hidden.yaml", "notes.txt"):
        (department / name).write_text(SLOTTER, "utf-8")
    (tmp_path / "outside.yaml").write_text(SLOTTER, "utf-8")
    (department / "Stray.yaml").symlink_to(tmp_path / "outside.yaml")
    found = catalogue.ignored_machines("en")
    assert [Path(one.location.file).name for one in found] == ["Shears.yaml", "press 2.yaml", "saw.yml"]
    assert {(one.code, one.level) for one in found} == {("machine-file-name", "warning")}
    for number in range(MOST_MACHINES):
        (department / f"m-{number:03}.yaml").touch()
    last = catalogue.ignored_machines("en")[-1]
    assert (last.code, Path(last.location.file).name) == ("machines-too-many", "slotter.yaml")
    assert "atlas/slotter" not in atlas_files()


def test_a_formula_that_cancels_is_zero(department: Path) -> None:
    """Floats leave 6e-17 of cos(90 deg), and 1 + 2e-16 of a ratio: neither is a fault of the machine."""
    length = (("meter", 1.0),)
    given = {"a": Amount(0.1, length), "h": Amount(0.3, length), "b": Amount(math.radians(90), ANGLE)}
    for text, value in (
        ("h*cos(b)", 0.0),
        ("h*sin(2*b)", 0.0),
        ("h*cos(3*b)", 0.0),
        ("h*tan(2*b)", 0.0),
        ("h - 3*a", 0.0),
        ("h - a - a - a", 0.0),
        ("h*cos(asin(3*a/h))", 0.0),
        ("h*cos(acos(3*a/h))", 0.3),
        ("h*cos(b - 1 deg)", 0.3 * math.sin(math.radians(1.0))),
        ("h - 299.99999 mm", 1e-8),
    ):
        found = formula(text, frozenset(given)).value(given)
        assert found.si == pytest.approx(value, rel=1e-6, abs=0.0), text
    with pytest.raises(FormulaError, match="formula-value"):
        formula("h*tan(b)", frozenset(given)).value(given)
    turned = SLOTTER.replace("h + a + 20 mm, 0 mm", "h + a + 20 mm, h*cos(90 deg)")
    (department / "slotter.yaml").write_text(turned, "utf-8")
    assert catalogue.examine(department / "slotter.yaml", "en") == []
