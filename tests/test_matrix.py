"""Every kind and every sample coursework works with every command; see `tests/matrix.py`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import get_args

import pytest

from reportgen import api
from reportgen.assignment.common import Extent
from reportgen.base.languages import setting_of
from reportgen.base.template_folders import languages
from reportgen.base.units import Language
from tests import kinds, matrix
from tests.lanes import matrix as lanes
from tests.report.built import MARKS

ALL = list(matrix.cases())
BRIEF = [case for case in ALL if case[2] == matrix.OWN]
COMMANDS = {command.__name__ for command in matrix.COMMANDS}
WITH_ALL = ("shaper", "cam")
"""A machine and a kind that is not a machine: tested with all commands in the first lane."""
SOON = {"build", "compare", "edit"}
"""Commands that each kind runs there: together they make the report, the key, a sheet, its marks and the form."""
WHOLE = {("whole-shaper-whole", command) for command in ("check", "solve_json", "compare")}
"""Commands that a coursework with a part of each kind runs there."""
KINDS = {Path(kind).name for kind in kinds.KINDS}
TELLING = [case for case in BRIEF if case[0] in WITH_ALL or case[:2] in WHOLE or (case[0] in KINDS and case[1] in SOON)]
CASES = [case for case in ALL if case[2] != matrix.OWN or case in TELLING]
"""Those that the first lane runs, and every one that names its language: with all formats, it proves the brief one."""


def named(case: tuple[str, ...]) -> str:
    """Return the file of a case, so that the cases of one file are run by one process."""
    subject, *others = filter(None, case)
    return "-".join(((matrix.subjects() | matrix.machines())[subject].stem, *others))


@pytest.fixture(scope="module", autouse=True)
def one_case() -> Iterator[None]:
    with matrix.shared():
        yield


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Return the folder of each subject in the first lane, because cases are cached by path."""
    return cache(lambda subject: tmp_path_factory.mktemp(subject))


@pytest.mark.parametrize(
    ("subject", "command", "language", "engine", "extent"),
    lanes([pytest.param(*case, marks=MARKS[case[3]], id=named(case)) for case in CASES], TELLING),
)
def test_every_command_answers(
    folders: Callable[[str], Path],
    capsys: pytest.CaptureFixture[str],
    subject: str,
    command: str,
    language: Language,
    engine: api.Engine,
    extent: Extent,
) -> None:
    at = matrix.desk(subject, folders(subject), capsys, language=language, engine=engine, extent=extent)
    matrix.do(command, at)


@pytest.mark.parametrize(
    ("subject", "command", "language", "engine", "extent"),
    lanes([pytest.param(*case, marks=MARKS[case[3]], id=named(case)) for case in matrix.spread()], []),
)
def test_every_machine_of_the_atlas_answers_some_commands(
    folders: Callable[[str], Path],
    capsys: pytest.CaptureFixture[str],
    subject: str,
    command: str,
    language: Language,
    engine: api.Engine,
    extent: Extent,
) -> None:
    at = matrix.desk(subject, folders(subject), capsys, language=language, engine=engine, extent=extent)
    matrix.do(command, at)


def test_the_machines_of_the_atlas_share_all_commands_and_languages() -> None:
    cases = list(matrix.spread())
    assert {case[0] for case in cases} == matrix.machines().keys()
    assert {case[1] for case in cases} == COMMANDS
    assert {case[2] for case in cases} == set(languages())
    # No two machines have the same commands in the same language.
    shares = [tuple(case[1:3] for case in cases if case[0] == machine) for machine in matrix.machines()]
    assert len(set(shares)) == len(shares)


def test_the_settings_have_every_pair_of_their_product() -> None:
    """So has the report of each subject with the engines in their extents; each command has two languages there."""
    used = [case for case in ALL if case[0] != matrix.ATLAS and case[2] != matrix.OWN and case[1] != "check"]
    product = {
        (subject, command.__name__, language, engine, extent)
        for subject in {case[0] for case in used}
        for command in matrix.COMMANDS
        if command.__name__ != "check"
        for language in languages()
        for engine in (get_args(api.Engine) if command in matrix.BY_ENGINE else ("typst",))
        for extent in (("short", "full") if command in matrix.BY_EXTENT else ("short",))
        if not setting_of(language).is_draft() or (engine, extent) == ("typst", "short")
    }
    assert set(used) < product
    for columns in combinations(range(5), 2):
        pairs = {tuple(case[column] for column in columns) for case in product}
        assert {tuple(case[column] for column in columns) for case in used} == pairs, columns
    whole = {command.__name__ for command in matrix.BY_EXTENT}
    assert {(case[0], *case[3:]) for case in ALL if case[1] in whole and case[0] != matrix.ATLAS} == {
        (case[0], *case[3:]) for case in product if case[1] in whole
    }
    spoken = {case[:3] for case in used}
    assert all(len([case for case in spoken if case[:2] == both]) >= 2 for both in {case[:2] for case in product})


def test_a_kind_enters_by_being_there() -> None:
    """Each kind has some commands in the first lane and each command a kind; the second lane has all of both."""
    told = {case[:2] for case in TELLING}
    assert told >= {(kind, command) for kind in KINDS for command in SOON}
    assert told >= {(kind, command) for kind in WITH_ALL for command in COMMANDS}
    assert {case[:2] for case in CASES} == {(subject, command) for subject in matrix.subjects() for command in COMMANDS}
    assert {path.stem for name, path in matrix.subjects().items() if name not in KINDS} >= {"shaper", "engine-twin"}
