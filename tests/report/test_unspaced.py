"""Marks between letters of Chinese: what a reader of it expects, written by hand."""

from __future__ import annotations

import pytest

from reportgen.document import Emph, InlineMath, Reference, Strong, Text, Value, plain
from reportgen.document.cjk_punctuation import unspaced
from reportgen.formula import Chain, Number, Symbol

B, V = InlineMath(Symbol("B")), InlineMath(Symbol("v", "B"))
SIZE = Value(Number(3.5, 1, "m/s"))
EQUATION = InlineMath(Chain((Symbol("v"), Number(2))))


@pytest.mark.parametrize(
    ("inlines", "expected"),
    [
        ((Text("点 "), B, Text(" 的速度.")), "点 B 的速度。"),
        ((Text("在位置 1, 2, 3 达到最大值"),), "在位置1、2、3达到最大值"),
        ((V, Text(", "), B, Text(" 的大小为 "), SIZE, Text(".")), "v_B、B 的大小为 3.5 m/s。"),
        ((Text("其中"), EQUATION, Text(", "), EQUATION), "其中 v = 2，v = 2"),
        ((Text("电动机 ("), SIZE, Text(", "), SIZE, Text("); 见下")), "电动机（3.5 m/s，3.5 m/s）；见下"),
        ((Text("各点的速度 (2/3)"),), "各点的速度（2/3）"),
        ((Text("依次作 "), SIZE, Text(" ("), V, Text("), "), SIZE, Text(".")), "依次作 3.5 m/s（v_B），3.5 m/s。"),
        (
            (Text("由 tan "), B, Text(" = "), V, Text("/("), B, Text(" + "), V, Text(") 确定")),
            "由tan B = v_B/(B + v_B)确定",
        ),
        ((Text("为 r (cos 2"), B, Text(" + …) , 见图")), "为r (cos 2B + …)，见图"),
        ((Text("平衡力矩: "), V), "平衡力矩：v_B"),
        ((Text("如图 "), Reference("fig", "1.2"), Text(" 所示;")), "如图1.2所示；"),
        ((Text("距离 "), V, Text(" = "), SIZE), "距离 v_B = 3.5 m/s"),
        ((Text("机构为 "), Strong((Text("Ⅱ级机构"),)), Text(" .")), "机构为Ⅱ级机构。"),
        ((Emph((Text("例 1: "), V)), Text(" 如图")), "例1：v_B如图"),
        ((Text("见 feedback.pdf, 共 3.5 页"),), "见feedback.pdf，共3.5页"),
        ((Text("f(x) 为奇函数"),), "f(x)为奇函数"),
        ((Text("由 tan α = (s − e)/(s₀ + s) 求得"),), "由tan α = (s − e)/(s₀ + s)求得"),
        ((Text("其力矩为 "), V, Text(" ("), B, Text(" − 1) , 依次")), "其力矩为 v_B (B − 1)，依次"),
    ],
)
def test_marks_are_full_width_and_blanks_fall(inlines: tuple, expected: str) -> None:
    assert plain(unspaced(inlines), "en") == expected


@pytest.mark.parametrize("text", ["1, 2", "R. Smith, ABC (2nd)", "", "4 – 5"])
def test_a_line_without_a_letter_of_it_stays(text: str) -> None:
    assert unspaced((Text(text),)) == (Text(text),)


def test_a_line_that_is_set_out_stays() -> None:
    line = (Text("在位置 1, 2 ("), V, Text(") 为 "), SIZE, Text("."))
    assert unspaced(unspaced(line)) == unspaced(line)


def test_what_is_no_text_comes_through_as_it_is() -> None:
    line = (Text("点 "), B, Text(", "), SIZE, Text(" 和 "), Reference("eq", "(1.2)"))
    assert [one for one in unspaced(line) if not isinstance(one, Text)] == [B, SIZE, line[-1]]
