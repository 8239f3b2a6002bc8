"""Names and titles stay text, whatever is typed."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api
from reportgen.cases import opened
from reportgen.page import page
from tests.lanes import proof
from tests.page.browser import Browser
from tests.report import built

pytestmark = proof
NAMES = (
    "<script>window.pwned = 1</script>",
    "<img src=x onerror='window.pwned = 2'>",
    "</style></script><svg onload=window.pwned=3>",
    'A" onmouseover="window.pwned=4',
    "{{ 7 * 7 }} {% raw %} ${7*7} `x`",
    "&lt;b&gt; &amp; ]]> <!-- --> \\u003c",
    "javascript:window.pwned=5",
)


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a machine with hostile names in every free text."""
    import yaml

    given = yaml.safe_load((built.ROOT / "assignments" / "slider-crank-01.yaml").read_text(encoding="utf-8"))
    one, two, three, four, five, six, seven = NAMES
    given["variant"] = five
    given["report"] |= {"university": one, "faculty": two, "department": three, "course": four, "supervisor": six}
    given["report"]["student"] = {"name": three, "id": one, "class": two, "section": seven, "email": four}
    folder = tmp_path_factory.mktemp("hostile")
    file = folder / "given.yaml"
    file.write_text(yaml.safe_dump(given, allow_unicode=True), encoding="utf-8")
    target = folder / "page.html"
    target.write_text(page(opened(api.load(file))), encoding="utf-8")
    return target


def test_hostile_names_are_shown_as_typed(hostile: Path, browser: Browser) -> None:
    browser.show(hostile)
    shown = browser.run("return document.querySelector('.cover').textContent")
    for name in NAMES:
        assert name in shown, name
    assert browser.run("return window.pwned") is None
    assert browser.run("return document.querySelectorAll('img, iframe, object, embed').length") == 0
    assert browser.run("return document.querySelectorAll('script').length") == 2
    assert browser.messages() == []


def test_nothing_but_the_frame_s_own_script_would_run(hostile: Path, browser: Browser) -> None:
    """Were a script to get into the page, its policy would not let it run, nor load anything."""
    browser.show(hostile)
    browser.run(
        "const s = document.createElement('script'); s.textContent = 'window.pwned = 6'; document.body.append(s);"
        "const i = document.createElement('img'); i.src = 'http://127.0.0.1:9/x.png'; document.body.append(i);"
        "document.body.insertAdjacentHTML('beforeend', '<button id=bad onclick=\"window.pwned = 7\">x</button>');"
        "document.getElementById('bad').click();"
    )
    assert browser.run("return window.pwned") is None
    # A request that the policy stops is noted as one, and fails before it leaves.
    assert browser.run("return document.querySelector('body > img').naturalWidth") == 0
    assert sum("Content Security Policy" in message for message in browser.messages()) >= 3
