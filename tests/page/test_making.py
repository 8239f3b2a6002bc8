"""What is made of a file on its page: products with their steps, their files and what keeps them from being made."""

from __future__ import annotations

import re
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.template_folders import languages, search_path
from reportgen.base.words import load_words
from reportgen.page.background_builds import Maker


def maker(folder: Path, script: str) -> tuple[Maker, list[Any]]:
    heard: list[Any] = []
    command = (sys.executable, "-c", script, str(folder / "report.pdf"))
    return Maker({"pdf": command}, heard.append), heard


def made(maker: Maker, heard: list[Any]) -> Any:
    assert maker.make("pdf")
    assert not maker.make("pdf"), "one at a time"
    end = time.monotonic() + 20
    while (not heard or heard[-1]["state"] == "running") and time.monotonic() < end:
        time.sleep(0.01)
    assert heard[0] == {"product": "pdf", "state": "running"}
    return heard[-1]


def test_what_is_made_is_told_with_its_files(tmp_path: Path) -> None:
    script = "import sys; open(sys.argv[1], 'w').write('%PDF-'); print(sys.argv[1]); sys.stdout.flush()"
    writer, heard = maker(tmp_path, script + "; import time; time.sleep(0.2)")
    assert made(writer, heard)["files"] == [["report.pdf", str(tmp_path / "report.pdf")]]
    assert writer.files == {"report.pdf": tmp_path / "report.pdf"}


def test_the_steps_of_what_is_made_are_told_with_words(tmp_path: Path) -> None:
    """As `step` tells them, in their order, and nothing of them is a complaint."""
    script = "from reportgen.base.progress import step; step('solve'); step('typeset'); import sys; sys.exit('no room')"
    writer, heard = maker(tmp_path, script)
    assert made(writer, heard)["complaint"] == "no room"
    assert [said["step"] for said in heard if "step" in said] == ["solve", "typeset"]
    sources = "".join(file.read_text(encoding="utf-8") for file in Path(api.__file__).parent.glob("*.py"))
    named = set(re.findall(r'\bstep\("(\w+)"\)', sources))
    assert all(load_words(search_path(language))["edit"]["steps"].keys() == named for language in languages())


def test_what_cannot_be_made_is_told(tmp_path: Path) -> None:
    said = made(*maker(tmp_path, "import sys; print('given.yaml:1:1: error', file=sys.stderr); sys.exit(1)"))
    assert (said["state"], said["complaint"], said["files"]) == ("failed", "given.yaml:1:1: error", [])


def test_what_is_being_made_can_be_cancelled(tmp_path: Path) -> None:
    slow, heard = maker(tmp_path, "import time; time.sleep(60)")
    threading.Timer(0.2, slow.end).start()
    assert made(slow, heard)["state"] == "ended"
    slow.close()
    assert not slow.make("pdf")
    with pytest.raises(KeyError):
        slow.make("other")
