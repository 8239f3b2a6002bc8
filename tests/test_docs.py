"""The documentation states what is so: names exist, links lead somewhere, no command or key is missing."""

from __future__ import annotations

import importlib.util
import os
import re
from inspect import cleandoc
from pathlib import Path

import pytest
import typer
import yaml

from reportgen import api, catalogue
from reportgen.base import documentation
from reportgen.base.kinds import program_kinds
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.cli import app
from reportgen.marking.marking_policy import read_policy
from reportgen.writers import pdflatex
from tests.documents import DOCUMENTS, FILE, PAGES, ROOT, fences, section, text_of
from tests.lanes import proof

PICTURES = ROOT / "docs" / "pictures"
LARGEST_PICTURE = 150_000
"""Largest size (bytes) of a picture, so that a page loads quickly over a slow connection."""
LARGEST_MOVING = 1_000_000
"""Largest size (bytes) of a moving picture."""

_LINK = re.compile(r"\]\(([^)\s]+)\)")


def test_the_readme_begins_with_the_two_commands_and_a_page() -> None:
    text = text_of("README.md")
    places = [text.index(part) for part in ("$ make report", "$ make test", "![", "## ")]
    assert places == sorted(places)


def test_the_readme_is_short_and_leads_to_the_form_first() -> None:
    text = text_of("README.md")
    assert len(text.splitlines()) <= 120
    assert text.count("![") == 1
    assert text.index("reportgen edit") < text.index("reportgen new")
    for reader in ("Students", "Instructors", "Engineers", "Developers"):
        assert f"- **{reader}:** " in section(text, "## Where to go from here")


def test_the_vietnamese_readme_is_short_and_leads_to_the_form_first() -> None:
    text = text_of("README.vi.md")
    assert len(text.splitlines()) <= 120
    assert text.index("reportgen edit") < text.index("reportgen new")


def test_a_release_has_at_most_eight_lines_about_what_users_can_do() -> None:
    releases = re.split(r"^## \[.+$", text_of("CHANGELOG.md"), flags=re.MULTILINE)[1:]
    assert releases
    for release in releases:
        lines = [line for line in release.splitlines() if line.strip()]
        assert len(lines) <= 8
        assert all(re.match(r"- \*\*[A-Z][^*]+:\*\* ", line) for line in lines)


@pytest.mark.parametrize("suffix", [".md", ".vi.md"])
def test_every_command_is_explained_and_leads_to_its_options(suffix: str) -> None:
    rows = text_of(f"docs/reference/commands{suffix}").splitlines()
    for name in vars(typer.main.get_command(app))["commands"]:
        (row,) = [row for row in rows if re.match(rf"\| \[`reportgen {name}\b", row)]
        assert f"](options{suffix}#{name})" in row


def test_every_machine_is_shown_and_all_its_keys_are_explained() -> None:
    text, keys = text_of("docs/reference/machines.md"), text_of("docs/reference/keys.md")
    for kind in program_kinds():
        row = rf"^\| \[`{kind}`\]\(#{kind}\) \| !\[[^\]]+\]\(\.\./pictures/{kind}\.png\) \| "
        assert re.search(row, text, re.MULTILINE)
        assert f"keys.md#{kind})" in section(text, f"## `{kind}`")
        explained = section(keys, "## Keys of several kinds") + section(keys, f"## `{kind}`")
        for name, field in catalogue.kind(kind).parameters.model_fields.items():
            assert f"`{field.alias or name}`" in explained, (kind, name)
    (row,) = [line for line in text.splitlines() if line.startswith("| `flywheel` |")]
    with_flywheel = {kind for kind in program_kinds() if "flywheel" in catalogue.kind(kind).parameters.model_fields}
    assert set(re.findall(r"`([a-z-]+)`", row)) - {"flywheel"} == with_flywheel


@pytest.mark.parametrize("script", ["keys", "options", "error_codes", "atlas", pytest.param("quantities", marks=proof)])
def test_a_generated_page_is_as_its_script_writes_it(script: str) -> None:
    """`make pictures` writes it from the words of the program, so that no fact has to be written twice."""
    spec = importlib.util.spec_from_file_location(script, ROOT / "docs" / f"{script}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for file, text in module.pages().items():
        assert file.read_text(encoding="utf-8") == text, f"{file}: run python docs/{script}.py"


def test_every_key_of_the_results_is_explained() -> None:
    text = text_of("docs/reference/results.md")
    results = api.solve(api.load(ROOT / "assignments" / "engine-twin-05.yaml"))
    for key in (*results, *results["positions"][0]):
        assert f"`{key}`" in text, key


def test_every_column_of_the_grades_is_explained() -> None:
    text = section(text_of("docs/reference/grading.md"), "### Columns of `grades.csv`")
    for heading in load_words(search_path("en"))["grades"].values():
        assert f"`{heading}`" in text, heading


def test_every_key_of_the_policy_is_explained() -> None:
    text = text_of("docs/reference/policy.md")
    shown = cleandoc(read_policy.__doc__ or "").partition("\n\n")[2]
    for name in yaml.safe_load(shown):
        assert re.search(rf"`{name}[`.]", text), name


def links_of(document: str) -> set[str]:
    """Return the documents that a document links to, by their paths from the top of the repository."""
    home = (ROOT / document).parent
    files = (home / link.partition("#")[0] for link in _LINK.findall(text_of(document)) if ":" not in link)
    return {os.path.relpath(file, ROOT) for file in files if file.suffix == ".md"}


def test_every_page_is_two_clicks_from_the_readme() -> None:
    first = links_of("README.md")
    reached = first.union(*map(links_of, first))
    # The pages of the site lead to their translations.
    assert {page.replace(".vi.md", ".md") for page in DOCUMENTS} - {"README.md"} <= reached


def test_every_page_is_in_the_index_once_and_its_name_is_unique() -> None:
    pages = [page for page in PAGES if page.startswith("docs/") and not page.endswith(".vi.md")]
    listed = [f"docs/{entry.link}" for entry in documentation.entries("en")]
    assert sorted(listed) == sorted({*pages} - {"docs/index.md"})
    assert len({Path(page).stem for page in pages}) == len(pages)


def test_the_vietnamese_index_leads_to_every_vietnamese_page() -> None:
    pages = [page for page in PAGES if page.startswith("docs/") and page.endswith(".vi.md")]
    assert {*pages} - {"docs/index.vi.md"} <= links_of("docs/index.vi.md")


@pytest.mark.parametrize("page", sorted((ROOT / "docs" / "how-to").glob("*.md")), ids=lambda path: path.stem)
def test_a_task_has_numbered_steps_and_fits_a_screen(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 60
    assert re.search(r"^1\. .*^2\. ", text, re.MULTILINE | re.DOTALL)


def test_the_one_command_that_installs_tex_is_given() -> None:
    assert fences("docs/how-to/typeset-with-latex.md", "sh") == [f"{pdflatex.INSTALL}\n"]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_links_lead_somewhere(document: str) -> None:
    for link in _LINK.findall(text_of(document)):
        if re.match(r"https?:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (ROOT / document).parent / name if name else ROOT / document
        assert target.is_file(), link
        if document.endswith(".vi.md") and (own := target.with_suffix(".vi.md")).is_file():
            # The site leads from a Vietnamese page to Vietnamese pages where there are any.
            target = own
        if anchor:
            titles = re.findall(r"^#+ (.+)$", target.read_text(encoding="utf-8"), re.MULTILINE)
            anchors = [re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles]
            assert anchor in anchors, link


@pytest.mark.parametrize("picture", sorted(PICTURES.iterdir()), ids=lambda path: path.name)
def test_pictures_are_small_and_used(picture: Path) -> None:
    assert picture.stat().st_size <= (LARGEST_MOVING if picture.suffix == ".gif" else LARGEST_PICTURE)
    assert any(f"pictures/{picture.name})" in text_of(page) for page in PAGES)


@pytest.mark.parametrize("document", DOCUMENTS)
def test_files_that_are_named_exist(document: str) -> None:
    text = text_of(document)
    printed = {name for other in DOCUMENTS for name, _ in FILE.findall(text_of(other))}
    for name in set(re.findall(r"`((?:reportgen|templates|tests|assignments|docs)/[\w./-]+)`", text)) - printed:
        assert (ROOT / name).exists(), name


@pytest.mark.parametrize("document", DOCUMENTS)
def test_targets_of_make_that_are_named_exist(document: str) -> None:
    targets = set(re.findall(r"^(\w+):", text_of("Makefile"), re.MULTILINE))
    named = set(re.findall(r"(?:`|^\$ )make (\w+)", text_of(document), re.MULTILINE))
    assert named <= targets


def test_types_that_are_named_exist() -> None:
    code = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "reportgen").rglob("*.py"))
    for name in set(re.findall(r"`([A-Z][a-z][A-Za-z]*)s?`", text_of("ARCHITECTURE.md"))):
        assert re.search(rf"^class {name}\b", code, re.MULTILINE), name


def test_the_architecture_places_every_part() -> None:
    text = text_of("ARCHITECTURE.md")
    parts = [path for path in (ROOT / "reportgen").iterdir() if not path.name.startswith("_")]
    for part in parts:
        # A package that was renamed leaves a folder with what was compiled of it.
        if (part / "__init__.py").is_file() or part.suffix == ".py":
            assert f"`reportgen/{part.name}" in text, part.name
