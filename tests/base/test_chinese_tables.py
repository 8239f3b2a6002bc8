"""Files as they come from China, and files from elsewhere that must not be taken for such ones."""

from __future__ import annotations

import unicodedata

import pytest

from reportgen.base.chinese import full_name, is_gbk, joined, narrow
from reportgen.base.yaml_source import decoded, encoding_of

ROSTER = "学号,姓名,班级\n2021010234,王小明,机械2101\n2021010235,李喆,机械2101\n"
SHEET = (
    "答题表 – 2021010234\n代号,符号,名称,单位,数值\nomega.1,?,曲柄的角速度,rad/s,9.32\nmu.l,μl,长度比例尺,m/mm,0.004\n"
)
ELSEWHERE = {
    "cp1258": "id,họ tên,lớp\n1,Nguyễn Văn Ánh,46\n2,Trần Đức Thắng,47\n",
    "latin-1": "id,name\n1,José Müller\n2,Zoë Ångström\nÀÉÎ\n",
    "cp1251": "номер,имя\n1,Иванов Иван\n2,ПЕТРОВ ПЁТР\n",
    "koi8-r": "номер,имя\n1,Иванов Иван\n2,ПЕТРОВ\n",
    "shift_jis": "学籍番号,氏名\n12,山田太郎\n",
    "euc_kr": "학번,이름\n1,김철수\n2,이영희\n",
    "big5": "學號,姓名\n1,陳大文\n2,林志明\n",
}


@pytest.mark.parametrize("text", [ROSTER, SHEET, "report: {course: 机械原理, student: {name: 欧阳修}}\n"])
@pytest.mark.parametrize("codec", ["gbk", "gb18030"])
def test_what_excel_saves_there_is_read(text: str, codec: str) -> None:
    data = text.encode(codec)
    assert encoding_of(data) == (b"", "gb18030")
    assert decoded(data, "a.csv") == text


@pytest.mark.parametrize("codec", ELSEWHERE)
def test_other_old_encodings_are_not_taken_for_it(codec: str) -> None:
    data = unicodedata.normalize("NFD", ELSEWHERE[codec]).encode(codec, "ignore")
    composed = ELSEWHERE[codec].encode(codec, "ignore")
    assert not is_gbk(data)
    assert not is_gbk(composed)


@pytest.mark.parametrize("text", [ROSTER, "họ tên\nNguyễn Văn Ánh", "plain", ""])
def test_utf_8_stays_utf_8(text: str) -> None:
    assert encoding_of(text.encode()) == (b"", "utf-8")


def test_blanks_fall_between_letters_of_chinese_alone() -> None:
    assert joined("王\u3000明") == joined("王  明") == "王明"
    assert joined("Nguyễn Văn An") == "Nguyễn Văn An"
    assert full_name("王", "小明") == "王小明"
    assert full_name("Nguyễn", "An") == "Nguyễn An"
    assert full_name("") == ""


def test_wide_digits_are_those_of_a_keyboard() -> None:
    assert narrow("－１２．５\u3000ｍ／ｓ") == "-12.5 m/s"
