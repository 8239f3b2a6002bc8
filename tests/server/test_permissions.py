"""What names students and has their work is for the owner of the class alone."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import SQLAlchemyError
from typer.testing import CliRunner

from reportgen.cli import app
from reportgen.server.database import Database
from tests.server.served import ROSTER, SPEC


def test_a_new_class_and_its_copies_are_for_their_owner(tmp_path: Path) -> None:
    for name, content in {"spec.yaml": SPEC, "roster.csv": ROSTER}.items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    folder, copies = tmp_path / "class", tmp_path / "copies"
    before = os.umask(0o022)
    try:
        init = [str(folder), str(tmp_path / "roster.csv"), "--init", "--spec", str(tmp_path / "spec.yaml")]
        for arguments in (init, [str(folder), "--backup", str(copies)]):
            answer = CliRunner().invoke(app, ["serve", *arguments])
            assert answer.exit_code == 0, answer.output
        assert os.umask(0o022) == 0o022, "it is as before for whatever comes next"
    finally:
        os.umask(before)
    made = [folder, copies, *folder.rglob("*"), *copies.rglob("*")]
    assert [path for path in made if path.stat().st_mode & 0o077] == []


def test_an_older_folder_of_the_server_is_closed_to_others(tmp_path: Path) -> None:
    (tmp_path / "server").mkdir(mode=0o755)
    (tmp_path / "server").chmod(0o755)
    database = Database(tmp_path / "server")
    database.close()
    assert (tmp_path / "server").stat().st_mode & 0o777 == 0o700


def test_what_somebody_typed_is_in_no_message(tmp_path: Path) -> None:
    database = Database(tmp_path)
    with pytest.raises(SQLAlchemyError) as error, database.reading() as connection:
        connection.execute(text("select :typed from nowhere"), {"typed": "An Nguyen"})
    database.close()
    assert "An Nguyen" not in str(error.value)
