"""Specs: a finite choice of values, faults at their places, and the text of an edited file."""

from __future__ import annotations

import re
import unicodedata
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from reportgen.base.errors import AssignmentError, Location
from reportgen.base.units import Language
from reportgen.base.yaml_source import MappingNode, Scalar, SequenceNode, plain, read_text
from reportgen.base.yaml_values import quoted, text_of
from reportgen.classes.variant_spec import Spec, read_spec
from reportgen.cli import app
from reportgen.workbook import Book, WorksheetData, write_xlsx
from tests.classes.specs import BARS, ROOT, Put, located


def choices(spec: Spec) -> dict[str, list[str]]:
    return {axis.name: [choice.text for choice in axis.choices] for axis in spec.axes}


def faults_of(path: Path) -> list[str]:
    with pytest.raises(AssignmentError) as caught:
        read_spec(path, "en")
    return located(caught.value, path)


def test_lists_and_ranges_become_choices_as_typed(put_file: Put) -> None:
    spec = read_spec(put_file(BARS))
    assert choices(spec) == {
        "parameters.AB": ["100 mm", "105 mm", "110 mm", "115 mm", "120 mm", "125 mm", "130 mm"],
        "parameters.BC": ["340 mm", "350 mm"],
        "parameters.E.along": ["0.1 mm", "0.2 mm", "0.3 mm", "0.4 mm"],
        "parameters.torque.sense": ["opposing", "clockwise"],
    }
    assert spec.size == 7 * 2 * 4 * 2
    assert len({spec.combination(number) for number in range(spec.size)}) == spec.size
    assert all(spec.number(spec.combination(number)) == number for number in range(spec.size))


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("{from: 0.9 m, to: 930 mm, step: 1 cm}", ["0.9 m", "0.91 m", "0.92 m", "0.93 m"]),
        ("{from: 1e3 mm, to: 1002 mm, step: 1 mm}", ["1000 mm", "1001 mm", "1002 mm"]),
        ("{from: 100 mm, to: 100 mm, step: 5 mm}", ["100 mm"]),
        ("{from: 100 mm, to: 109 mm, step: 5 mm}", ["100 mm", "105 mm"]),
        ("{from: 100.50mm, to: 101 mm, step: 0.25 mm}", ["100.5 mm", "100.75 mm", "101 mm"]),
    ],
)
def test_a_range_steps_in_decimal_numbers(put_file: Put, text: str, values: list[str]) -> None:
    spec = read_spec(put_file(BARS.replace("CD: 280 mm", f"CD: {text}")))
    assert choices(spec)["parameters.CD"] == values


def test_three_steps_of_a_tenth_are_three_tenths(put_file: Put) -> None:
    """In binary numbers 0.1 + 0.1 + 0.1 is 0.30000000000000004 and the last step of 1.1 … 1.4 is lost."""
    for text, values in {
        "{from: 0.1, to: 0.3, step: 0.1}": ["0.1", "0.2", "0.3"],
        "{from: 0.7, to: 1, step: 0.1}": ["0.7", "0.8", "0.9", "1"],
    }.items():
        spec = read_spec(put_file(BARS.replace("  CD:", f"  s2: {text}\n  G2: 20 N\n  CD:")))
        assert choices(spec)["parameters.s2"] == values


def test_what_a_machine_wants_as_a_list_stays_one(put_file: Put) -> None:
    text = (ROOT / "assignments" / "linkage-8.yaml").read_text(encoding="utf-8")
    assert read_spec(put_file(text)).axes == ()
    changed = re.sub(r"length: ([0-9.]+) mm", r"length: [\1 mm, 1\1 mm]", text, count=1)
    ((name, values),) = choices(read_spec(put_file(changed))).items()
    assert name.startswith("parameters.")
    assert len(values) == 2
    engine = (ROOT / "assignments" / "engine-twin-05.yaml").read_text(encoding="utf-8")
    assert read_spec(put_file(engine)).axes == ()
    assert choices(read_spec(put_file(engine.replace("lambda: 1/3.6", "lambda: [1/3.6, 1/4]")))) == {
        "parameters.lambda": ["1/3.6", "1/4"]
    }


@pytest.mark.parametrize(
    ("old", "new", "faults"),
    [
        ("[340 mm, 350 mm]", "[]", ["FILE:6:7 too-few"]),
        ("[340 mm, 350 mm]", "[340 mm, 340 mm]", ["FILE:6:16 choice-repeated"]),
        ("[340 mm, 350 mm]", "[340 mm, [350 mm]]", ["FILE:6:16 wrong-type"]),
        ("[340 mm, 350 mm]", "[340 mm, 35 kg, 350]", ["FILE:6:16 wrong-unit", "FILE:6:23 missing-unit"]),
        ("step: 5 mm", "step: -5 mm", ["FILE:5:40 range-step"]),
        ("step: 5 mm", "step: 0 mm", ["FILE:5:40 range-step"]),
        ("step: 5 mm", "step: 5", ["FILE:5:40 missing-unit"]),
        ("step: 5 mm", "step: 5 kg", ["FILE:5:40 wrong-unit"]),
        ("step: 5 mm", "step: 0,5 mm", ["FILE:5:40 decimal-comma"]),
        ("step: 5 mm", "stop: 5 mm", ["FILE:5:7 missing-key", "FILE:5:34 unknown-key"]),
        ("step: 5 mm", "step: 0.0001 mm", ["FILE:5:7 too-many"]),
        ("from: 100 mm", "from: 140 mm", ["FILE:5:14 range-order"]),
        ("from: 100 mm", "from: [1 mm]", ["FILE:5:14 wrong-type"]),
        ("from: 100 mm", "from: 100 furlongz", ["FILE:5:14 unknown-unit"]),
        ("CD: 280 mm", "CDD: [1 mm, 2 mm]", ["FILE:4:1 missing-key", "FILE:7:3 unknown-key"]),
        ("[opposing, clockwise]", "[opposing, sideways]", ["FILE:13:41 choice"]),
        ("salt:", "sallt:", ["FILE:2:1 unknown-key"]),
        ('salt: "2011"', "salt: [1]", ["FILE:2:7 wrong-type"]),
        ("kind: four-bar", "kind: five-bar", ["FILE:1:7 unknown-kind"]),
    ],
)
def test_faults_of_a_spec_stand_where_they_are(put_file: Put, old: str, new: str, faults: list[str]) -> None:
    assert old in BARS
    got = faults_of(put_file(BARS.replace(old, new)))
    # The keys a spec alone has are unknown to an assignment of an unknown kind too: its kind is told first.
    assert got[: len(faults)] == faults
    assert len(got) == len(faults) or "unknown-kind" in faults[0]


def test_a_table_of_variants(put_file: Put) -> None:
    """Names, units in the headings, other sections, an empty cell: the parameter is left out."""
    base = BARS.replace("  BC: [340 mm, 350 mm]\n", "")
    base = base.replace("{from: 100 mm, to: 130 mm, step: 5 mm}   # the crank", "120 mm")
    base += "variants: table.csv\n"
    put_file("Phương án;BC (mm);BF;positions.start\nI;340;220 mm;0 deg\nII;350;;\n", "table.csv")
    spec = read_spec(put_file(base))
    rows = {axis.name: axis for axis in spec.axes}["variants"]
    assert [choice.text for choice in rows.choices] == ["I", "II"]
    assert [{where: one.text for where, one in choice.settings.items()} for choice in rows.choices] == [
        {("parameters", "BC"): "340 mm", ("parameters", "BF"): "220 mm", ("positions", "start"): "0 deg"},
        {("parameters", "BC"): "350 mm"},
    ]


def test_faults_of_a_table_of_variants_stand_in_its_cells(put_file: Put) -> None:
    base = BARS.replace("  BC: [340 mm, 350 mm]\n", "") + "variants: table.xlsx\n"
    rows = (("variant", "BC", "CD", "Cd"), ("I", 340, "1 mm", None), ("I", "350 mm", None, None))
    table = put_file(write_xlsx(Book((WorksheetData("T", rows),))), "table.xlsx")
    spec = put_file(base)
    with pytest.raises(AssignmentError) as caught:
        read_spec(spec, "en")
    assert [line.replace(str(table), "TABLE") for line in located(caught.value, spec)] == [
        "FILE:6:7 not-in-table",
        "TABLE:T!D1 unknown-column",
        "TABLE:T!B2 missing-unit",
        "TABLE:T!A3 choice-repeated",
    ]
    table.unlink()
    with pytest.raises(AssignmentError, match="unreadable"):
        read_spec(spec)


# --- the text of nodes ----------------------------------------------------------------------------------

PRINTABLE = st.text(st.characters(exclude_categories=("Cc", "Cs", "Co", "Zl", "Zp")), max_size=30)


@given(PRINTABLE)
def test_any_text_is_read_as_it_was_quoted(text: str) -> None:
    source = read_text(f"key: {quoted(text)}\n")
    assert source.faults == ()
    assert isinstance(source.top, MappingNode)
    assert plain(source.top) == {"key": text}


@settings(max_examples=40)
@example({"k" * 120: []})
@example({"k" * 120: {}})
@given(
    st.recursive(
        PRINTABLE,
        lambda inner: st.lists(inner, max_size=4) | st.dictionaries(PRINTABLE, inner, max_size=4),
        max_leaves=12,
    )
)
def test_any_nodes_are_read_as_they_were_written(content: object) -> None:
    def node(value: object) -> Scalar | SequenceNode | MappingNode:
        if isinstance(value, str):
            return Scalar(value, Location(""))
        if isinstance(value, list):
            return SequenceNode(tuple(map(node, value)), Location(""))
        assert isinstance(value, dict)
        return MappingNode(tuple((Scalar(key, Location("")), node(item)) for key, item in value.items()), Location(""))

    top = node({"a": content})
    assert isinstance(top, MappingNode)

    def composed(value: object) -> object:
        if isinstance(value, dict):
            return {unicodedata.normalize("NFC", key): composed(item) for key, item in value.items()}
        return [composed(item) for item in value] if isinstance(value, list) else value

    got = plain(read_text(text_of(top, "", MappingNode((), Location("")))).top)
    assert got == composed(plain(top))


OUTSIDE = ("../secret.csv", "../../../../../../../../etc/passwd", "/etc/passwd", "link.csv", "there/secret.csv", "\\0")


@pytest.mark.parametrize(("language", "told"), [("en", "points outside the folder"), ("vi", "dẫn ra ngoài thư mục")])
@pytest.mark.parametrize("name", OUTSIDE)
def test_a_table_of_variants_lies_below_the_spec(tmp_path: Path, name: str, language: Language, told: str) -> None:
    """By `..`, from the root, by a link to a file or a folder: nothing of it is opened or quoted."""
    folder, secret = tmp_path / "class", tmp_path / "secret.csv"
    folder.mkdir()
    secret.write_text("nobody,may,see\n1,2,3\n", encoding="utf-8")
    (folder / "link.csv").symlink_to(secret)
    (folder / "there").symlink_to(tmp_path)
    spec = folder / "spec.yaml"
    spec.write_text(f'{BARS}variants: "{name}"\n', encoding="utf-8")
    with pytest.raises(AssignmentError) as caught:
        read_spec(spec, language)
    (problem,) = caught.value.problems
    assert (problem.code, problem.location.line, problem.location.column) == (
        "path-outside",
        len(BARS.splitlines()) + 1,
        11,
    )
    assert told in str(problem)
    assert not re.search("nobody|root:", str(caught.value))


def test_a_table_of_variants_may_lie_in_a_folder_below(tmp_path: Path) -> None:
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "v.csv").write_text("CD (mm)\n281\n282\n", encoding="utf-8")
    spec = tmp_path / "spec.yaml"
    spec.write_text(BARS.replace("  CD: 280 mm\n", "") + "variants: tables/../tables/v.csv\n", encoding="utf-8")
    assert choices(read_spec(spec))["variants"] == ["1", "2"]


def shared_tables(folder: Path, name: str = "../tables/v.csv") -> Path:
    """A spec in a folder of its own, with its table in another one beside that."""
    for one in ("course", "tables", "other"):
        (folder / one).mkdir()
    (folder / "tables" / "v.csv").write_text("CD (mm)\n281\n282\n", encoding="utf-8")
    spec = folder / "course" / "spec.yaml"
    spec.write_text(BARS.replace("  CD: 280 mm\n", "") + f"variants: {name}\n", encoding="utf-8")
    return spec


@pytest.mark.parametrize("name", ["../tables/v.csv", "{root}/tables/v.csv", "link.csv"])
def test_a_table_of_variants_may_lie_below_a_folder_that_is_shared(tmp_path: Path, name: str) -> None:
    spec = shared_tables(tmp_path, name.format(root=tmp_path))
    (spec.parent / "link.csv").symlink_to(tmp_path / "tables" / "v.csv")
    assert choices(read_spec(spec, shared=(tmp_path / "other", tmp_path / "tables")))["variants"] == ["1", "2"]
    with pytest.raises(AssignmentError, match=r"path-outside.*\n.*--shared"):
        read_spec(spec, shared=(tmp_path / "other",))


def test_a_shared_folder_shares_what_is_below_it_alone(tmp_path: Path) -> None:
    """Neither what lies beside it, nor what a link in it leads to."""
    spec = shared_tables(tmp_path)
    tables = tmp_path / "tables"
    (tables / "v.csv").rename(tmp_path / "v.csv")
    (tables / "v.csv").symlink_to(tmp_path / "v.csv")
    with pytest.raises(AssignmentError, match="path-outside"):
        read_spec(spec, shared=(tables,))
    spec.write_text(spec.read_text(encoding="utf-8").replace("tables/v", "tables-2/v"), encoding="utf-8")
    with pytest.raises(AssignmentError, match="path-outside"):
        read_spec(spec, shared=(tables,))


@pytest.mark.parametrize("command", ["variants SPEC ROSTER", "batch ROSTER --spec SPEC --make task"])
def test_commands_take_shared_folders(tmp_path: Path, command: str) -> None:
    spec, roster = shared_tables(tmp_path), tmp_path / "class.csv"
    roster.write_text("id,name\nK1,An\n", encoding="utf-8")
    words = [{"SPEC": str(spec), "ROSTER": str(roster)}.get(one, one) for one in command.split()]
    words += ["--out", str(tmp_path / "out"), "--lang", "en"]
    refused = CliRunner().invoke(app, words)
    assert (refused.exit_code, "error[path-outside]" in refused.stderr) == (1, True)
    done = CliRunner().invoke(app, [*words, "--shared", str(tmp_path / "other"), "--shared", str(tmp_path / "tables")])
    assert done.exit_code == 0, done.stderr
    assert CliRunner().invoke(app, [*words, "--shared", str(tmp_path / "nowhere")]).exit_code == 2
