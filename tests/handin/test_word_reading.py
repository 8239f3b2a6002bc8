"""What is read of a Word report: everything that a person finds in it, and nothing else."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from reportgen.base.languages import languages, setting_of
from reportgen.case.answer_key import Key
from reportgen.handin import FileReading, word_report
from reportgen.handin.word_file import open_word
from reportgen.handin.word_reader import read_report
from tests.handin import figures, made_reports, reports, wml
from tests.lanes import matrix

CASES = [(manner, machine, seed) for manner, machine, seed in reports.each(range(1))]
TELLING = [(manner, "slotted-lever-01", 0) for manner in reports.MANNERS]
WELL, CARELESS = 0.97, 0.85
"""The shares of the values in a report that are to be read."""


@pytest.mark.parametrize(("manner", "machine", "seed"), matrix(CASES, TELLING))
def test_a_made_up_report_is_read_and_no_number_goes_to_a_wrong_place(manner: str, machine: str, seed: int) -> None:
    made = reports.report(manner, machine, seed)
    result = figures.judged(made, figures.read(made))
    assert not result.wrong
    # What a colon says is left for a person, and a report of few values has more of it by chance.
    least = 0.7 if manner == "mixed" else CARELESS if reports.MANNERS[manner] in reports.CARELESS else WELL
    assert result.read >= least * result.stand


# --- single rules -----------------------------------------------------------------------------------


@cache
def key() -> Key:
    return made_reports.key_for("slotted-lever-01", "vi")


def read(*blocks: str, language: str = "vi") -> FileReading:
    content = wml.package("".join(blocks))
    return read_report(
        open_word(Path("r.docx"), content).blocks, made_reports.key_for("slotted-lever-01", language), "r.docx"
    )


def line(text: str) -> str:
    """A paragraph of plain text."""
    return wml.paragraph(wml.run(text))


HERE = wml.paragraph(wml.run("2.1 Vị trí 2"), "u2")
PLACE = ("v.D", 2)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("v_D = 0,25 m/s", 0.25),
        ("vD = 0,25 m/s", 0.25),
        ("V_D = 0,25 m/s", 0.25),
        ("v_D = 25 cm/s", 0.25),
        ("v_D (mm/s) = 250", 0.25),
        ("v_D = 2,5·10⁻¹ m/s", 0.25),
        ("v_D = 2,5.10^-1 m/s", 0.25),
        ("Suy ra v_D = ω_3·l_CD = 2·0,125 = 0,25 m/s.", 0.25),
        ("v_D = 0,25 m/s, hướng sang trái", 0.25),
        ("v_D = 0,25 m/s (hướng sang trái).", 0.25),
        ("v_D = 0,25 m/s\t(2.15)", 0.25),
        ("v_D = x ⇒ v_D = 0,25 m/s", 0.25),
        ("v_D(2) = 0,25 m/s", 0.25),
        ("- v_D = 0,25 m/s; a_D = 3 m/s²", 0.25),
        ("𝑣_𝐷 = 0,25 m/s", 0.25),
        ("v\u200b_D = 0,2\u200b5 m/s", 0.25),
        ("v_D = 2,5∙10^{−1} m/s", 0.25),
        ("v_D = 2,5e−1 m/s", 0.25),
        ("v_D = 2,5 e-1 m/s", 0.25),
        ("v_D = 250 мм/с", 0.25),
        ("v_D = 250 毫米/秒", 0.25),
        *((f"v_D = {minus}0,25 m/s", -0.25) for minus in "\u2010\u2011\u2012\u2212\ufe63\u207b"),
    ],
)
def test_a_statement_has_its_number(text: str, value: float) -> None:
    reading = read(HERE, line(text))
    assert reading.values[PLACE].value == pytest.approx(value)
    assert str(reading.values[PLACE].location) == "r.docx:¶2"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("Giả sử v_D = 0,25 m/s", "unread-supposed"),
        ("Giá trị lớn nhất v_D = 0,25 m/s", "unread-supposed"),
        ("v_D = 0,25 m/s hoặc 0,3 m/s", "unread-number"),
        ("v_D = 2·3,1", "unread-number"),
        ("v_D: 0,25 m/s", "unread-number"),
        ("2 v_D = 0,5 m/s", "unread-number"),
        ("v_D = 5.122,95 m/s", "unread-product"),
        ("v_D = 0,25 kg", "unread-unit"),
        ("Tại vị trí 2 và 5: v_D = 0,25 m/s", "unread-positions"),
        ("Tại vị trí thứ ba v_D = 0,25 m/s", "unread-positions"),
        ("v_D = 0,25 m/s. Lại có v_D = 0,35 m/s", "unread-two-values"),
    ],
)
def test_what_leaves_a_doubt_is_not_read(text: str, code: str) -> None:
    reading = read(HERE, line("a_D = 1,25 m/s²"), line(text))
    assert PLACE not in reading.values
    assert reading.unread[PLACE].code == code


@pytest.mark.parametrize(
    ("heading", "text"),
    [
        ("2.1 Скорости в положении 2", "Тогда v_D = 0,25 м/с, вправо."),
        ("2.1 2-е положение", "v_D = 25 см/с"),
        ("2.1 位置2的速度分析", "则v_D=0.25 m/s，方向向左。"),
        ("2.1 位置2的速度分析", "v_D＝０．２５ m/s"),
        ("2.1 第2个位置", "（1）v_D＝μ_v·pd＝0.25 m/s；"),
        ("2.1 Position 2", "v_D = 0,25 m/s (compared with nothing)"),
    ],
)
def test_a_report_may_be_written_in_any_language(heading: str, text: str) -> None:
    reading = read(wml.paragraph(wml.run(heading), "u2"), line(text))
    assert reading.values[PLACE].value == 0.25


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("Допустим, v_D = 0,25 м/с", "unread-supposed"),
        ("В положениях 2 и 5: v_D = 0,25 м/с", "unread-positions"),
        ("v_D = 0,25 м/с или 0,3 м/с", "unread-number"),
        ("v_D равна 0,25 м/с", "unread-number"),
        ("假设v_D=0.25 m/s", "unread-supposed"),
        ("最大值v_D=0.25 m/s", "unread-supposed"),
        ("位置2和5：v_D=0.25 m/s", "unread-positions"),
        ("v_D为0.25 m/s", "unread-number"),
    ],
)
def test_a_doubt_is_one_in_any_language(text: str, code: str) -> None:
    for heading in ("Положение 2", "位置2"):
        reading = read(wml.paragraph(wml.run(heading), "u2"), line("a_D = 1,25 m/s²"), line(text))
        assert PLACE not in reading.values
        assert reading.unread[PLACE].code == code


@pytest.mark.parametrize(
    ("text", "sign"),
    [
        ("theo chiều kim đồng hồ", -1),
        ("по часовой стрелке", -1),
        ("против часовой стрелки", 1),
        ("顺时针", -1),
        ("沿逆时针方向", 1),
        ("counter-clockwise", 1),
    ],
)
def test_a_sense_is_understood_in_any_language(text: str, sign: int) -> None:
    reading = read(HERE, line(f"ω_3 = 0,4 rad/s, {text}"))
    assert reading.values["turn.omega.3", 2].value == 0.4 * sign


def test_each_language_says_by_which_words_a_report_is_read() -> None:
    """A report is read by the words of all languages together."""
    for language in languages():
        reading = setting_of(language).reading
        assert all((reading.position, reading.clockwise, reading.anticlockwise, reading.supposed)), language


def test_a_number_without_a_unit_yields_to_one_with_it() -> None:
    """It may be of another quantity with the same letter, as the mobility F beside the area F."""
    reading = read(HERE, line("v_D = 3·2 - 5 = 1"), line("v_D = 0,25 m/s"), line("v_D = 2·4 = 8"))
    assert reading.values[PLACE].value == 0.25


@pytest.mark.parametrize(
    "text",
    ["sin v_D = 0,25", "F = x + v_D = 0,25 m/s", "v_D^2 = 0,25", "Δv_D = 0,25 m/s", "v_D = ω_3·l_CD", "v_E = 0,25 m/s"],
)
def test_what_is_no_value_of_it_is_nothing(text: str) -> None:
    reading = read(HERE, line(text))
    assert PLACE not in reading.values.keys() | reading.unread.keys()


@pytest.mark.parametrize("text", ["12°30′", "12° 30'", "12,5°", "12°30′0″"])
def test_an_angle_may_have_minutes(text: str) -> None:
    row = next(row for row in key().asked if row.unit == "°" and not row.single)
    symbol = row.symbol.base + (f"_{row.symbol.sub}" if row.symbol.sub else "")
    reading = read(HERE, line(f"{symbol} = {text}"))
    assert reading.values[row.id, 2].value == pytest.approx(12.5)


def test_a_position_ends_with_its_heading() -> None:
    """Under the next chapter nobody says which it is; a sentence that only compares changes nothing."""
    compared = read(HERE, line("Nhỏ hơn so với vị trí 5."), line("v_D = 0,25 m/s"))
    assert compared.values[PLACE].value == 0.25
    ended = read(HERE, wml.paragraph(wml.run("3 Nhận xét"), "u1"), line("v_D = 0,25 m/s"))
    assert {fault.code for fault in ended.unread.values()} == {"unread-no-position"}
    assert not ended.values


def test_a_rotation_has_the_sense_that_is_said_or_counts_by_its_size() -> None:
    row = key().row("turn.omega.3")
    sign = 1 if row.values[1] > 0 else -1
    words = ("ngược chiều kim đồng hồ", "cùng chiều kim đồng hồ")
    for text, value in (("", 0.4 * sign), (f", {words[0]}", 0.4), (f", {words[1]}", -0.4)):
        reading = read(HERE, line(f"ω_3 = 0,4 rad/s{text}"))
        assert reading.values["turn.omega.3", 2].value == value


def test_what_is_struck_out_deleted_or_hidden_is_not_there() -> None:
    deleted = '<w:del w:id="1" w:author="x"><w:r><w:delText>9</w:delText></w:r></w:del>'
    parts = wml.run("v_D = ") + wml.run("7 ", wml.STRUCK) + wml.run("8 ", wml.HIDDEN) + deleted
    reading = read(HERE, wml.paragraph(parts + wml.run("0,25 m/s")))
    assert reading.values[PLACE].value == 0.25


WHITE = '<w:color w:val="FFFFFF"/>'
SHADE = '<w:shd w:val="clear" w:color="auto" w:fill="{fill}"/>'


@pytest.mark.parametrize(
    ("look", "seen"),
    [
        (WHITE, False),
        ('<w:color w:val="FAFAFA"/>', False),
        ('<w:color w:val="FFFFFF" w:themeColor="background1"/>', False),
        ('<w:sz w:val="2"/>', False),
        ('<w:w w:val="1"/>', False),
        (wml.HIDDEN, False),
        ('<w:color w:val="1F4E79"/>' + SHADE.format(fill="1F4E79"), False),
        ('<w:rStyle w:val="away"/>', False),
        # Honest: heads in white on blue, marked text, small print, grey.
        (WHITE + SHADE.format(fill="1F4E79"), True),
        (WHITE + '<w:highlight w:val="blue"/>', True),
        ('<w:sz w:val="14"/>', True),
        ('<w:color w:val="BFBFBF"/>', True),
        ('<w:color w:val="auto"/>', True),
    ],
)
def test_text_that_nobody_sees_is_not_read_and_told(look: str, seen: bool) -> None:
    style = f'<w:style w:type="character" w:styleId="away"><w:name w:val="away"/><w:rPr>{WHITE}</w:rPr></w:style>'
    parts = {"word/styles.xml": wml.STYLES.replace("</w:styles>", f"{style}</w:styles>")}
    body = HERE + wml.paragraph(wml.run("v_D = 0,25 m/s", look)) + line("a_D = 3 m/s²")
    reading = word_report.read(Path("r.docx"), wml.package(body, parts), key())
    assert (PLACE in reading.values) == seen
    assert reading.unseen == (frozenset() if seen else {PLACE})
    assert [note.code for note in reading.notes] == ([] if seen else ["word-unseen"])


def test_white_text_on_a_coloured_cell_or_table_style_is_seen() -> None:
    """So look the heads of Word's own tables."""
    white = wml.paragraph(wml.run("v_D = 0,25 m/s", WHITE))
    for properties, style, seen in (
        (SHADE.format(fill="1F4E79"), "", True),
        ("", '<w:tblStyle w:val="blue"/>', True),
        ("", '<w:tblStyle w:val="plain"/>', False),
    ):
        shading = f'<w:tblStylePr w:type="firstRow"><w:tcPr>{SHADE.format(fill="1F4E79")}</w:tcPr></w:tblStylePr>'
        styles = f'<w:style w:type="table" w:styleId="blue"><w:name w:val="blue"/>{shading}</w:style>'
        styles += '<w:style w:type="table" w:styleId="plain"><w:name w:val="plain"/></w:style>'
        parts = {"word/styles.xml": wml.STYLES.replace("</w:styles>", f"{styles}</w:styles>")}
        cell = f"<w:tc><w:tcPr>{properties}</w:tcPr>{white}</w:tc>"
        table = f"<w:tbl><w:tblPr>{style}</w:tblPr><w:tr>{cell}</w:tr></w:tbl>{line('')}"
        reading = word_report.read(Path("r.docx"), wml.package(HERE + table, parts), key())
        assert (PLACE in reading.values) == seen


def test_the_number_of_a_row_stands_under_its_unit() -> None:
    """Of several numbers in a row, it is the one whose column has the unit of the quantity."""
    heads = [wml.cell(wml.run(text)) for text in ("Điểm", "l, mm", "v (m/s)", "N·m")]
    row = [wml.cell(wml.run(text)) for text in ("v_D", "12,5", "0,25", "3,5")]
    assert read(HERE, wml.table([heads, row], 4)).values[PLACE].value == 0.25
    two = [wml.cell(wml.run(text)) for text in ("Điểm", "v (m/s)", "v (m/s)", "N·m")]
    doubt = read(HERE, wml.table([two, row], 4))
    assert (PLACE in doubt.values, doubt.unread[PLACE].code) == (False, "unread-table")


@pytest.mark.parametrize(
    "rows",
    [
        [("Điểm", "v, m/s", "a, m/s²"), ("B3", "0,5", "2"), ("D", "0,25", "1,5")],
        [("k", "v_{k}", "a_{k}"), ("", "m/s", "m/s²"), ("D", "0,25", "1,5")],
        [("Điểm", "B3", "D"), ("Vận tốc v, m/s", "0,5", "0,25"), ("Gia tốc a, m/s²", "2", "1,5")],
    ],
)
def test_a_symbol_may_have_its_index_in_the_other_head_of_a_table(rows: list[tuple[str, ...]]) -> None:
    """As A over the orders 2 and 4, V_{1,i} over the nodes i, l over the links AB and BC."""
    reading = read(HERE, wml.table([[wml.cell(wml.run(text)) for text in row] for row in rows], 3))
    assert (reading.values[PLACE].value, reading.values["a.D", 2].value) == (0.25, 1.5)


def test_a_position_before_a_symbol_is_no_factor_of_it() -> None:
    reading = read(line("a_D = 1 m/s². At position 2 v_D = 0,25 m/s"))
    assert reading.values[PLACE].value == 0.25


@pytest.mark.parametrize("text", ["v_D = 0 m/s (since v_A or v_B is zero)", "v_D = 0 m/s (do v_A hay v_B bằng không)"])
def test_a_reason_takes_no_number_back(text: str) -> None:
    assert read(HERE, line(text)).values[PLACE].value == 0


def test_a_link_or_a_figure_in_bold_is_of_the_same_position() -> None:
    reading = read(HERE, wml.paragraph(wml.run("Link 2", wml.BOLD)), line("v_D = 0,25 m/s"))
    assert reading.values[PLACE].value == 0.25


def test_a_position_that_is_compared_stays_in_hand() -> None:
    reading = read(
        HERE, line("Position 2 is position 8 of the next turn: the crank stands there."), line("v_D = 1 m/s")
    )
    assert reading.values[PLACE].value == 1
    several = read(HERE, line("Positions 2 and 8 are alike."), line("v_D = 1 m/s"))
    assert several.unread[PLACE].code == "unread-no-position"


def test_the_plan_of_positions_is_none() -> None:
    reading = read(HERE, line("Measured on the position plan."), line("Đo trên hoạ đồ vị trí."), line("v_D = 0,25 m/s"))
    assert reading.values[PLACE].value == 0.25


@pytest.mark.parametrize("space", "\u00a0\u2005\u2007\u2009\u202f")
def test_thousands_in_a_table_may_be_set_off_by_any_blank(space: str) -> None:
    """The unit stands in the cell or in the head, also behind a comma in brackets; heads are bold."""
    labels = key().labels[:3]
    heads = [wml.cell(wml.run(text, wml.BOLD)) for text in ("Vị trí", *labels)]
    for head, number in (("v_D, [mm/s]", f"1{space}230,5"), ("v_D", f"1{space}230,5 mm/s")):
        row = [wml.cell(wml.run(head, wml.BOLD)), *(wml.cell(wml.run(number)) for _ in labels)]
        reading = read(wml.table([heads, row], 4))
        assert reading.values[PLACE].value == pytest.approx(1.2305)


def test_a_letter_of_the_font_symbol_is_greek() -> None:
    omega = '<w:r><w:sym w:font="Symbol" w:char="F077"/></w:r>'
    reading = read(HERE, wml.paragraph(omega + wml.run("3", wml.LOW) + wml.run(" = 0,4 rad/s")))
    assert abs(reading.values["turn.omega.3", 2].value) == 0.4


def test_equations_of_another_program_are_counted_and_what_is_blank_there_is_unread() -> None:
    """A blank under the heading may stand in one of them; elsewhere it is a blank."""
    equation = '<w:r><w:object><o:OLEObject Type="Embed" ProgID="Equation.DSMT4" r:id="rId9"/></w:object></w:r>'
    elsewhere = wml.paragraph(wml.run("2.2 Vị trí 5"), "u2")
    reading = read(HERE, line("v_D = 0,25 m/s"), wml.paragraph(equation), elsewhere, line("v_D = 0,3 m/s"))
    assert [note.arguments["count"] for note in reading.notes] == ["1"]
    assert reading.unread["a.D", 2].code == "unread-object"
    assert ("a.D", 5) not in reading.unread
    assert reading.values["v.D", 5].value == 0.3


def test_a_box_of_text_is_read_once() -> None:
    """Word writes it twice, for old programs too."""
    box = f"<w:txbxContent>{line('v_D = 0,25 m/s')}</w:txbxContent>"
    twice = (
        '<w:r><mc:AlternateContent xmlns:mc="http://schemas.openxmlformats.org/markup-compatibility/2006">'
        f'<mc:Choice Requires="wps"><w:drawing>{box}</w:drawing></mc:Choice>'
        f"<mc:Fallback><w:pict>{box.replace('0,25', '0,99')}</w:pict></mc:Fallback></mc:AlternateContent></w:r>"
    )
    assert read(HERE, wml.paragraph(twice)).values[PLACE].value == 0.25


def test_every_reason_has_its_words() -> None:
    """Each code that the readers give is a message in both languages."""
    from reportgen.base.words import messages

    folder = Path(reports.__file__).parents[2] / "reportgen" / "handin"
    codes = {
        code
        for file in folder.glob("*.py")
        for code in re.findall(r'"((?:unread|word|own)-[a-z-]+)"', file.read_text())
    }
    for language in ("vi", "en"):
        assert codes <= set(messages(language)["faults"])  # type: ignore[arg-type]
