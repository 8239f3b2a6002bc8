"""Words that depend on the machine: nothing is said of springs, weights, joints or engines that are not there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.cases import open_case
from reportgen.document import text_of
from tests.lanes import matrix
from tests.report import built

BANNED = (
    *(
        "mở từ trạng thái đứng yên",
        "không mở được từ",
        "giảm bậc nhất khi",
        "giá trị lớn nhất nhỏ nhất",
        "Nhìn từ tay quay",
    ),
    *(
        "được sách cho bằng chuỗi",
        "ốc đồ của lực",
        "cái giá phải trả",
        "khoảng cách nói trên",
        "kỳ nạp",
        "Môđun",
        "môđun",
    ),
    *("Cho thay bằng", "số lỗi đầu tiên", "Ghim khi đọc", "Máy nào?", "cột thứ nhất", "Nếu đánh số từ 1"),
    *("wherever their mass centres lie", "(first column)", "Seen from the crank", "(первый столбец)", "（第一列）"),
)
"""Phrases at which a reader of the language stops, or that are not so."""
LANGUAGES: tuple[Language, ...] = ("vi", "en", "ru", "zh")
WEIGHT = {"vi": "trọng lượng của đối trọng", "en": "and its weight", "ru": "и силу тяжести, а", "zh": "离心力和重力"}
LINEAR = {"vi": "Lò xo nối", "en": "A spring between", "ru": "Пружина, соединяющая", "zh": "连接两点的弹簧"}
TORSION = {"vi": "Lò xo xoắn kéo", "en": "A torsion spring turns", "ru": "Пружина кручения", "zh": "扭簧对构件"}
CIRCLE = {
    "vi": "vòng tròn ma sát bán kính",
    "en": "friction circle of radius",
    "ru": "круга трения радиуса",
    "zh": "的摩擦圆相切",
}
GUIDE = {
    "vi": "Phản lực của rãnh trượt",
    "en": "The reaction of a guide",
    "ru": "Реакция направляющей",
    "zh": "移动副的总反力",
}
EXERCISE = {"vi": "Bài tập: ", "en": "Exercise: ", "ru": "Задача: ", "zh": "题目"}
WORKS = (
    "friction",
    "rotor",
    "plane-motion",
    "engine-balance",
    "cam",
    "gear-pair",
    "planetary-train",
    "turning-moment",
    "structure",
    "synthesis",
)
LEVER = "assignments/lever-six-bar-02.yaml"
"""A machine with a spring between two points and a torsion spring."""


def written(folder: Path, text: str) -> str:
    (file := folder / "mine.yaml").write_text(text, encoding="utf-8")
    return text_of(open_case(file).document())


def slider_crank(language: Language, **more: str) -> str:
    """The file of a slider-crank in a language, with further keys of its parameters."""
    text = re.sub(r"(?m)^  language: \w+", f"  language: {language}", catalogue.sample("slider-crank", "en"))
    return text + "".join(f"  {key}: {value}\n" for key, value in more.items())


def test_no_language_has_a_phrase_that_readers_stop_at() -> None:
    """A colleague's list: the phrases stay out of all words."""
    files = [file for file in templates().rglob("*") if file.suffix in (".md", ".yaml")]
    found = [(file.name, phrase) for file in files for phrase in BANNED if phrase in file.read_text(encoding="utf-8")]
    assert found == []


@pytest.mark.parametrize("language", matrix(LANGUAGES, ["vi"]))
def test_a_counterweight_has_no_weight_in_a_horizontal_plane(tmp_path: Path, language: Language) -> None:
    balanced = slider_crank(language, balancing="{counterweight: {rules: [rotating], radius: 60 mm}}")
    balanced = re.sub(r"(?m)^  G([23]): \S+ N", r"  m\1: 5 kg", balanced)
    assert WEIGHT[language] in written(tmp_path, balanced)
    assert WEIGHT[language] not in written(tmp_path, balanced + "  plane: horizontal\n")


@pytest.mark.parametrize("language", matrix(LANGUAGES, ["vi"]))
def test_only_springs_that_are_there_are_explained(tmp_path: Path, language: Language) -> None:
    text = (built.ROOT / LEVER).read_text(encoding="utf-8")
    text = re.sub(r"language: \w+", f"language: {language}", text)
    springs = re.findall(r"(?m)^    - \{link.*\n", text)
    assert len(springs) == 2
    for left_out, explained in (("", (True, True)), (springs[0], (False, True)), (springs[1], (True, False))):
        told = written(tmp_path, text.replace(left_out, ""))
        assert (LINEAR[language] in told, TORSION[language] in told) == explained


@pytest.mark.parametrize("language", matrix(LANGUAGES, ["vi"]))
def test_friction_is_explained_of_the_joints_that_have_it(tmp_path: Path, language: Language) -> None:
    for friction, explained in (
        ("{pins: {B: {f: 0.1, r: 20 mm}}}", (True, False)),
        ("{sliders: {3: 0.1}}", (False, True)),
        ("{pins: {B: {f: 0.1, r: 20 mm}}, sliders: {3: 0.1}}", (True, True)),
    ):
        text = written(tmp_path, slider_crank(language, friction=friction))
        assert (CIRCLE[language] in text, GUIDE[language] in text) == explained


@pytest.mark.parametrize("language", matrix(LANGUAGES, ["vi"]))
def test_the_cover_of_an_exercise_names_no_machine(tmp_path: Path, language: Language) -> None:
    """A rotor, a cam, gears and friction are exercises; a shaper is a machine."""
    for kind in (*WORKS, "shaper"):
        text = re.sub(r"(?m)^(\s+)language: \w+", rf"\1language: {language}", catalogue.sample(kind, "en"))
        (file := tmp_path / f"{kind}.yaml").write_text(text, encoding="utf-8")
        subtitle = open_case(file).cover.subtitle[-1]
        assert (EXERCISE[language] in subtitle) == (kind != "shaper" or language == "zh"), subtitle


def test_an_engine_at_single_instants_counts_no_positions_of_a_cycle(tmp_path: Path) -> None:
    (text, count) = re.subn(
        r"(?ms)^positions:.*?(?=^\w)", "positions: {at: [30 deg, 100 deg]}\n\n", catalogue.sample("engine-single", "vi")
    )
    assert count == 1
    text = re.sub(r"worked_positions: \S+", "worked_positions: [1]", text)
    of_instants = written(tmp_path, text)
    assert "tức là 2 vị trí" not in of_instants
    assert "Ngoài các vị trí chia đều" not in of_instants
