"""The task names every topic of a machine of which its sheet asks something, and no other."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen.base.template_folders import languages
from reportgen.cases import open_case
from reportgen.marking.task_paper import task_of
from reportgen.marking.toleranced_key import key_of
from tests.lanes import matrix
from tests.report import built
from tests.told import told

SAID = {
    "friction": ("friction.M", "with the friction of the joints, and the efficiency"),
    "springs": ("spring.l.1", "the loads of the springs"),
    "wide sliders": ("face.", "slider whose face is given"),
    "true motion": ("run.", "Find the true motion"),
    "balancing": ("balance.", "that the inertia of the links exerts on the frame"),
}
"""Of each topic the beginning of ids that only its sheet has, and what the task says."""
FILES = sorted((built.ROOT / "assignments").glob("*.yaml"))
TELLING = [path for path in FILES if path.stem in {"shaper-friction", "shaper-03", "lever-six-bar-02", "four-bar-04"}]


@pytest.mark.parametrize("path", matrix(FILES, TELLING), ids=lambda path: path.stem)
def test_the_task_asks_for_each_topic_of_the_sheet(path: Path) -> None:
    case = open_case(path, language="en")
    key = key_of(case)
    text = told(task_of(case, key))
    for topic, (ids, said) in SAID.items():
        has = any(row.id.startswith(ids) for row in key.rows if row.role == "asked")
        assert (said in text) is has, topic


def test_every_language_names_the_topics() -> None:
    """As often as English: a task of friction is longer than one without by the same number of lines."""
    (path,) = (path for path in FILES if path.stem == "slider-crank-friction")
    words = {"vi": "khi kể đến ma sát", "en": "with the friction", "ru": "с учётом трения", "zh": "考虑运动副的摩擦"}
    assert set(words) == set(languages())
    for language, said in words.items():
        case = open_case(path, language=language)
        assert said in told(task_of(case, key_of(case)))


def test_the_task_of_an_engine_asks_for_the_counterweights_of_its_couple() -> None:
    """Where the sheet does: an engine in one plane has no couple."""
    for name in ("inline-four", "v-six", "v-twin"):
        case = open_case(built.ROOT / "assignments" / "engine-balance" / f"{name}.yaml", language="en")
        key = key_of(case)
        asked = any(row.id == "orders.U.M" for row in key.rows)
        assert ("the two counterweights that take the couples" in told(task_of(case, key))) is asked
