"""Reading an assignment: quantities, what is typed stays as typed, defaults, the firing order, the schema."""

from __future__ import annotations

import contextlib
import copy
import datetime
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reportgen import catalogue
from reportgen.assignment import Assignment
from reportgen.base.units import PLAIN, QuantityFault, read_quantity, read_ratio, scale_by_pint
from reportgen.catalogue import check, engine_twin, load, sample

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
SAMPLE_TEXT = SAMPLE.read_text(encoding="utf-8")


def read(text: str, folder: Path) -> Assignment:
    file = folder / "a.yaml"
    file.write_text(text, encoding="utf-8")
    return load(file)


@pytest.mark.parametrize("unit", PLAIN)
def test_plain_units_are_those_of_pint(unit: str) -> None:
    factor, dimension = scale_by_pint(unit)
    # Two roundings of the same number may differ in the last bit.
    assert PLAIN[unit][0] == pytest.approx(factor, rel=1e-15)
    assert PLAIN[unit][1] == dimension


@pytest.mark.proof
def test_no_file_of_the_repository_waits_for_pint() -> None:
    """Nor would one like it: loading pint takes as long as all the rest of a check."""
    code = "import sys; from reportgen import api; [api.load(f) for f in sys.argv[1:]]; sys.exit('pint' in sys.modules)"
    files = [str(file) for file in sorted((ROOT / "assignments").rglob("*.yaml")) if "class-demo" not in file.parts]
    assert len(files) > 40
    subprocess.run((sys.executable, "-c", code, *files), check=True, cwd=ROOT)


@pytest.mark.parametrize(
    ("text", "unit", "si"),
    [
        ("95 mm", "m", 0.095),
        ("9.5cm", "m", 0.095),
        ("3.5 inch", "m", 0.0889),
        ("2200 rpm", "rad/s", 2200 * math.pi / 30),
        ("36.5 turn/s", "rad/s", 73 * math.pi),
        ("2.5 N/cm²", "Pa", 25000.0),
        ("0.25 bar", "Pa", 25000.0),
        ("1 kgf/cm2", "Pa", 98066.5),
        ("6.0e-3 kg m2", "kg m2", 0.006),
        ("6 g.m2", "kg m2", 0.006),
        ("60 kg·cm^2", "kg m2", 0.006),
        ("−60°", "rad", -math.pi / 3),
        ("0.5 turn", "deg", math.pi),
    ],
)
def test_any_compatible_unit_is_understood(text: str, unit: str, si: float) -> None:
    given = read_quantity(text, unit)
    # A few roundings in the conversion.
    assert given.si == pytest.approx(si, rel=1e-14)
    assert given.text == text


@pytest.mark.parametrize("unit", ["mm**9", "m/", "/s", "m**m", "3 mm", "(((", "e", "degC", "x" * 50, "kG/cm2"])
def test_nonsense_is_no_length(unit: str) -> None:
    with pytest.raises(QuantityFault):
        read_quantity(f"1 {unit}", "m")


def test_ratio_keeps_its_spelling() -> None:
    assert (read_ratio("1/3.6").si, read_ratio("1/3.6").text) == (1 / 3.6, "1/3.6")


def test_sample_holds_the_published_data() -> None:
    engine = load(SAMPLE)
    p = engine.parameters
    assert check(SAMPLE) == []
    assert (engine.id, engine.kind, engine.variant) == ("engine-twin-05", "engine-twin", "5")
    assert engine.report.date == datetime.date(2011, 3, 24)
    assert (engine.worked_positions, engine.cycle_positions) == ((4,), 16)
    # Printed: L = 0.171 m, ω1 = 230.38 rad/s; half of the last printed digit.
    sheet = engine_twin.machine(engine).calculation
    assert sheet.si("L") == pytest.approx(0.171, abs=0.0005)
    assert p.speed == pytest.approx(230.38, abs=0.005)
    assert sheet.si("m.4") == sheet.si("m.2") == 20 / 9.81
    assert sheet.si("J.4") == pytest.approx(20 / 9.81 * 0.171**2 / 12, rel=1e-12)
    assert engine.report.student.name is None
    assert engine.report.supervisor is None


def test_names_are_kept_as_typed(tmp_path: Path) -> None:
    hostile = r"A_B & 100% #1 $x$ \input{x} *y* {{ z }} <b> ~^ “” --- Nguyễn"
    decomposed = "Nguyê\u0303n"
    text = SAMPLE_TEXT.replace("student: {name: ,", f"student: {{name: '{hostile}',")
    text = text.replace("  supervisor:", f"  supervisor: {decomposed}").replace("variant: 5", "variant: 05")
    engine = read(text, tmp_path)
    assert engine.report.student.name == hostile
    assert engine.report.supervisor == decomposed
    assert engine.variant == "05"


def test_words_of_yaml_are_text_here(tmp_path: Path) -> None:
    engine = read(SAMPLE_TEXT.replace("place: Thái Nguyên", "place: no"), tmp_path)
    assert engine.report.place == "no"


def test_only_kind_and_its_own_sections_are_required(tmp_path: Path) -> None:
    content = yaml.load(SAMPLE_TEXT, yaml.BaseLoader)
    least = {name: content[name] for name in ("kind", "parameters", "indicator")}
    engine = read(yaml.safe_dump(least, allow_unicode=True), tmp_path)
    assert (engine.variant, engine.language, engine.worked_positions) == ("", "vi", (2,))
    assert (engine.positions.count, engine.positions.sign, engine.drawing.crank) == (8, 1, None)


def test_worked_positions_may_be_all(tmp_path: Path) -> None:
    engine = read(SAMPLE_TEXT.replace("worked_positions: [4]", "worked_positions: all"), tmp_path)
    assert engine.worked_positions == tuple(range(1, 17))
    assert engine.with_positions(4).worked_positions == tuple(range(1, 9))


def test_absolute_pressures_lose_the_ambient(tmp_path: Path) -> None:
    gauge = load(SAMPLE).indicator.table.intake
    engine = read(SAMPLE_TEXT.replace("reference: gauge", "reference: absolute\n  ambient: 1 bar"), tmp_path)
    assert engine.indicator.table.intake == pytest.approx([pressure - 1e5 for pressure in gauge], rel=1e-15)


@pytest.mark.parametrize(
    ("firing", "expected"),
    [
        ("[intake, compression]", (0, 180)),
        ("[intake, exhaust]", (0, 540)),
        ("[expansion, exhaust]", (360, 540)),
        ("[expansion, compression]", (360, 180)),
    ],
)
def test_firing_tells_where_the_pistons_are_in_their_cycles(
    tmp_path: Path, firing: str, expected: tuple[float, float]
) -> None:
    engine = read(SAMPLE_TEXT.replace("[intake, compression]", firing), tmp_path)
    phases = [piston.phase for piston in engine_twin.machine(engine).pistons]
    assert phases == pytest.approx([math.radians(angle) for angle in expected])


def test_start_angle_moves_both_pistons(tmp_path: Path) -> None:
    """A clockwise crank that starts at 0° is 90° past the top of piston 3."""
    text = SAMPLE_TEXT.replace("direction: anticlockwise", "direction: clockwise, start: 0 deg")
    engine = read(text, tmp_path)
    phases = [piston.phase for piston in engine_twin.machine(engine).pistons]
    assert phases == pytest.approx((math.pi / 2, 3 * math.pi / 2))


@pytest.mark.parametrize("language", ["vi", "en"])
def test_new_file_is_in_order(tmp_path: Path, language: str) -> None:
    file = tmp_path / "new.yaml"
    file.write_text(sample("engine-twin", "en" if language == "en" else "vi"), encoding="utf-8")
    assert check(file) == []
    assert load(file).language == language


def _as_an_editor_sees(text: str) -> object:
    """YAML with its usual types, dates as text."""
    content = yaml.safe_load(text)
    if isinstance(content["report"].get("date"), datetime.date):
        content["report"]["date"] = content["report"]["date"].isoformat()
    return content


def _words(schema: Any) -> set[str]:
    """All keys of a schema, at any depth."""
    inner = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    return set().union(schema if isinstance(schema, dict) else (), *map(_words, inner))


def test_schema_accepts_what_the_reader_accepts() -> None:
    """In draft-07, the latest that the usual YAML extension of editors knows: it has no $defs and no prefixItems."""
    schema = catalogue.schema()
    validator = jsonschema.Draft7Validator
    assert jsonschema.validators.validator_for(schema) is validator
    validator.check_schema(schema)
    assert not {"$defs", "prefixItems", "unevaluatedProperties", "dependentRequired"} & _words(schema)
    for text in (SAMPLE_TEXT, sample("engine-twin", "en")):
        validator(schema).validate(_as_an_editor_sees(text))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("95 mm", "95"),
        ("1/3.6", "3.6"),
        ("  D: 98 mm", "  E: 98 mm"),
        ("by: stroke", "by: x"),
        ("language: vi", "language: fr"),
        ("count: 8", "count: 3"),
    ],
)
def test_schema_refuses_what_the_reader_refuses(tmp_path: Path, old: str, new: str) -> None:
    text = SAMPLE_TEXT.replace(old, new)
    file = tmp_path / "a.yaml"
    file.write_text(text, encoding="utf-8")
    assert check(file) != []
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(_as_an_editor_sees(text), catalogue.schema())


PIECES = st.sampled_from(
    [*"\t\n:[]{},#'\"|>?%@~\0-\\", "", ": ", "- ", "&a ", "*a", "!x ", "\x85", "\u2028", "\ud7ff", "1e300", "nan"]
)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.tuples(st.integers(0, len(SAMPLE_TEXT)), st.integers(0, 30), PIECES | st.text(max_size=4)),
        min_size=1,
        max_size=4,
    )
)
def test_no_text_makes_a_traceback(edits: list[tuple[int, int, str]]) -> None:
    text = SAMPLE_TEXT
    for place, length, piece in edits:
        text = text[:place] + piece + text[place + length :]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.yaml"
        file.write_bytes(text.encode("utf-8", "replace"))
        problems = check(file)
        lines = text.count("\n") + text.count("\x85") + text.count("\u2028") + text.count("\r") + 2
        assert all(1 <= problem.location.line <= lines and problem.location.column >= 1 for problem in problems)
        if not problems:
            assert load(file).kind == "engine-twin"


CONTENT = yaml.load(SAMPLE_TEXT, yaml.BaseLoader)
ANYTHING = st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=5) | st.sampled_from(["all", "1 mm", "0,5", "1/3"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(
        [(one,) for one in CONTENT]
        + [(one, two) for one in CONTENT for two in CONTENT[one] if isinstance(CONTENT[one], dict)]
    ),
    ANYTHING,
)
def test_no_content_makes_a_traceback(where: tuple[str, ...], value: object) -> None:
    content = copy.deepcopy(CONTENT)
    inner = content if len(where) == 1 else content[where[0]]
    inner[where[-1]] = value
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.yaml"
        file.write_bytes(yaml.safe_dump(content, allow_unicode=True).encode("utf-8", "replace"))
        assert check(file) == [] or str(check(file)[0]).startswith(str(file))


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_make_a_traceback(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.yaml"
        file.write_bytes(data)
        assert check(file) != []


@settings(max_examples=200, deadline=None)
@given(st.text(max_size=20) | st.from_regex(r"[0-9]{1,3} ?[a-zA-Z/*^()0-9 .]{1,12}", fullmatch=True))
def test_no_quantity_makes_a_traceback(text: str) -> None:
    with contextlib.suppress(QuantityFault):
        assert math.isfinite(read_quantity(text, "mm").si)
