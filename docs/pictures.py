"""Draw the pictures of README and docs: a page with a plan, a sheet, a machine in motion, the scheme of each kind.

`make pictures` runs this in the project's folder; the pictures go to `docs/pictures/`.  The machine in motion is drawn
by chromium, and left as it is where there is none.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import pymupdf
from PIL import Image
from screens import Screen, first_report

from reportgen import api, catalogue
from reportgen.base.kinds import kinds
from reportgen.base.records import replace
from reportgen.base.template_folders import is_of_atlas
from reportgen.document import Document, Figure

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "pictures"
SAMPLE = ROOT / "assignments" / "engine-twin-05.yaml"
CAPTION = ". Velocity plan at"
"""A part of the text of the page that the README shows, the number of the figure before it."""
SHOWN_IN_WORD = ". Steps in drawing the velocity plan"
"""A part of the text of the page of the Word file."""
TUTORIALS: Mapping[str, tuple[str, str, str, str]] = {
    "en": ("", "", CAPTION, SHOWN_IN_WORD),
    "vi": ("-vi", ".vi", ". Họa đồ vận tốc tại", ". Các b"),
}
"""By language: endings of the names of pictures and pages, the texts of the two pages of the reports.

The PDF of LibreOffice has no text of letters such as ư.
"""

SHOWN = {
    "plane-motion": ROOT / "assignments" / "plane-motion" / "17.yaml",
    "cam": ROOT / "assignments" / "cam" / "roller-01.yaml",
    "gear-pair": ROOT / "assignments" / "gears" / "pair-centre-distance.yaml",
    "planetary-train": ROOT / "assignments" / "gears" / "train-double.yaml",
    "friction": ROOT / "assignments" / "friction" / "incline.yaml",
    "rotor": ROOT / "assignments" / "rotor" / "rotor-two-planes.yaml",
    "engine-balance": ROOT / "assignments" / "engine-balance" / "v-six.yaml",
    "turning-moment": ROOT / "assignments" / "turning-moment" / "curve.yaml",
    "structure": ROOT / "assignments" / "structure" / "class-three.yaml",
    "synthesis": ROOT / "assignments" / "synthesis" / "slider-crank-by-offset.yaml",
    "linkage-press": ROOT / "assignments" / "linkage" / "press-class-iii.yaml",
}
"""What the README shows of kinds with a folder of their own."""
LAID_OUT = ROOT / "assignments" / "four-bar-01.yaml"
MOVING = ROOT / "assignments" / "shaper-01.yaml"
"""The machine that the README shows in motion."""
WINDOW, FRAME_WIDTH, STEP, FRAME_MS, FRAME_COLOURS = (1180, 900), 760, 8, 100, 48
"""Of that picture: the window and the width of a frame (pixels), degrees and time (ms) from one to the next."""
PAGE_DPI, WORD_DPI, SHEET_DPI, SCHEME_DPI, CURVES_DPI, TUTORIAL_DPI = 100, 80, 38, 60, 100, 75
COLOURS = 96
"""Few enough that a picture is small, and enough that thin lines stay smooth."""

MARGIN = 72.0
"""Height of the empty header and footer of a page (pt)."""

AROUND = (-15.0, -12.0, 15.0, 4.0)
"""Room for labels around the lines of a scheme: left, top, right, bottom (pt)."""
BELOW = {"cam": 8.0, "rotor": 8.0, "friction": 8.0}
"""More room below what has labels there (pt)."""

DRAW = """
const bar = document.getElementById(arguments[0]).closest(".field").querySelector("[type=range]");
bar.value = arguments[1];
bar.dispatchEvent(new Event("input", { bubbles: true }));
"""
"""Draws the slider of a field to a value."""
SETTLED, FORM_MS = 0.6, 160
"""What a frame of the form waits for (s), and how long it is shown (ms)."""


def document(file: Path) -> Document:
    """The report of an assignment file in English."""
    return api.document(api.load(file, "en"))


def typeset(report: Document) -> pymupdf.Document:
    """The pages of a report."""
    return pymupdf.open(stream=api.typeset(report, "typst")[1])


def page_with(text: str, pages: pymupdf.Document) -> pymupdf.Page:
    """The first page with `text` on it."""
    return next(page for page in pages if page.search_for(text))


SCHEMES = ("fig.scheme", "fig.velocity", "fig.inversion", "fig.mesh", "fig.diagram", "fig.construction")
"""The figure that shows a machine, the system of an exercise, a cam, or gears in mesh."""


def scheme_alone(report: Document) -> Document:
    """A document that shows the machine's scheme and nothing else."""
    figure = next(block for block in report.blocks if isinstance(block, Figure) and block.key in SCHEMES)
    alone = replace(figure, caption=(), key="", number="")
    return replace(report, header=("", ""), footer=("", ""), blocks=(alone,))


def drawn(page: pymupdf.Page) -> pymupdf.Rect:
    """The smallest rectangle around all lines between header and footer, with room for labels."""
    body = pymupdf.Rect(0, MARGIN, page.rect.width, page.rect.height - MARGIN)
    lines = pymupdf.Rect()
    for path in page.get_drawings():
        if path["rect"] in body:
            lines |= path["rect"]
    return lines + AROUND


def save(page: pymupdf.Page, name: str, dpi: int, clip: pymupdf.Rect | None = None) -> None:
    """Save a page, or the part of it within `clip`, as `docs/pictures/NAME.png`."""
    pixels = page.get_pixmap(dpi=dpi, clip=clip)
    picture = Image.frombytes("RGB", (pixels.width, pixels.height), pixels.samples)
    few_colours = picture.quantize(COLOURS, Image.Quantize.FASTOCTREE)
    few_colours.save(PICTURES / f"{name}.png", optimize=True)


@contextmanager
def browser() -> Iterator[Any]:
    """A browser without a window; None where there is none, which is said."""
    chromium, chromedriver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or chromedriver is None:
        print("what moves is left as it is: chromium and chromedriver are not installed", file=sys.stderr)
        yield None
        return
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in (
        "headless=new",
        "no-sandbox",
        "disable-gpu",
        "hide-scrollbars",
        "force-prefers-reduced-motion",
        "window-size={},{}".format(*WINDOW),
    ):
        options.add_argument(f"--{argument}")
    driver = webdriver.Chrome(options=options, service=Service(chromedriver))
    try:
        yield driver
    finally:
        driver.quit()


def frame(png: bytes) -> Image.Image:
    """A screenshot as a frame of what moves."""
    picture = Image.open(BytesIO(png)).convert("RGB")
    smaller = picture.resize((FRAME_WIDTH, picture.height * FRAME_WIDTH // picture.width))
    return smaller.quantize(FRAME_COLOURS, Image.Quantize.FASTOCTREE)


def save_moving(frames: list[Image.Image], name: str, duration: int) -> None:
    first, *others = frames
    first.save(PICTURES / name, save_all=True, append_images=others, duration=duration, loop=0)


def moving() -> None:
    """Save what a page shows of a machine over one turn as `docs/pictures/moving.gif`."""
    with browser() as driver, tempfile.TemporaryDirectory() as folder:
        if driver is None:
            return
        frames = []
        driver.get(api.build(MOVING, folder, language="en", formats=["html"]).as_uri())
        driver.execute_script("moving.pause(); document.querySelector('[data-layer=velocities]').click();")
        shown = driver.find_element("css selector", "#moving .theatre")
        for angle in range(0, 360, STEP):
            driver.execute_script("moving.seek(arguments[0])", angle)
            frames.append(frame(shown.screenshot_as_png))
        save_moving(frames, "moving.gif", FRAME_MS)


def form() -> None:
    """Save the form of a machine, a slider of which is drawn, as `docs/pictures/edit.gif`."""
    with browser() as driver, tempfile.TemporaryDirectory() as folder:
        if driver is None:
            return
        file = Path(folder) / "shaper.yaml"
        file.write_text(catalogue.sample("shaper", "en"), encoding="utf-8")
        command = [sys.executable, "-m", "reportgen.cli", "edit", str(file), "--no-open"]
        served = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert served.stdout is not None
        frames = []
        try:
            driver.get(served.stdout.readline().strip())
            driver.execute_script("moving.pause(); document.getElementById('f:parameters.l4').focus();")
            lengths = [*range(100, 150, 10), *range(150, 50, -10), *range(50, 110, 10)]
            for length in lengths:
                driver.execute_script(DRAW, "f:parameters.l4", length)
                time.sleep(SETTLED)
                frames.append(frame(driver.get_screenshot_as_png()))
        finally:
            served.terminate()
            served.wait()
        save_moving(frames, "edit.gif", FORM_MS)


def save_screen(name: str, png: bytes) -> None:
    """Save a screenshot as `docs/pictures/NAME.png`."""
    picture = Image.open(BytesIO(png)).convert("RGB")
    picture.quantize(COLOURS, Image.Quantize.FASTOCTREE).save(PICTURES / f"{name}.png", optimize=True)


def tutorials() -> None:
    """Save the screens that the tutorials show, and a page of the report that their reader makes."""
    for language, (ending, _, caption, _) in TUTORIALS.items():
        with browser() as driver, tempfile.TemporaryDirectory() as folder:
            if driver is None:
                return

            def save_shown(name: str, png: bytes, ending: str = ending) -> None:
                save_screen(f"{name}{ending}", png)

            report = pymupdf.open(first_report(Screen(driver), Path(folder), save_shown, language))
            save(page_with(caption, report), f"first-report-page{ending}", TUTORIAL_DPI)


def followed(tutorial: str, place: str) -> Path:
    """Do in an empty folder what a tutorial says, with the commands that it shows; return the folder."""
    sys.path.insert(0, str(ROOT))
    from tests.documents import play

    play(f"docs/tutorials/{tutorial}.md", Path(place), whole=True)
    return Path(place)


def hand_in(language: str) -> None:
    """Save the papers that the tutorial of the hand-in shows."""
    ending, page, _, caption = TUTORIALS[language]
    with tempfile.TemporaryDirectory() as place:
        own = followed(f"hand-in{page}", place) / "tasks" / "S01"
        task = pymupdf.open(own / "task.pdf")
        save(task[0], f"hand-in-task{ending}", TUTORIAL_DPI)
        save(task[-1], f"hand-in-sheet{ending}", TUTORIAL_DPI, task[-1].rect - (0, 0, 0, task[-1].rect.height / 2))
        save(pymupdf.open(own / "hand-in" / "sheet-1.pdf")[0], f"hand-in-drawing{ending}", SHEET_DPI)
        if (pages := in_word(own / "hand-in" / "report.docx")) is not None:
            save(page_with(caption, pages), f"hand-in-word{ending}", TUTORIAL_DPI)


def class_of_60(language: str) -> None:
    """Save the marks of the class and the feedback for a student that the tutorial of the class shows."""
    ending, page, _, _ = TUTORIALS[language]
    with tempfile.TemporaryDirectory() as place:
        marked = followed(f"class-of-60{page}", place) / "marked"
        save(pymupdf.open(marked / "class.pdf")[1], f"class-of-60-marks{ending}", TUTORIAL_DPI)
        feedback = pymupdf.open(marked / "S05" / "feedback.pdf")[0]
        save(
            feedback, f"class-of-60-feedback{ending}", TUTORIAL_DPI, feedback.rect - (0, 0, 0, feedback.rect.height / 3)
        )


def notebook_study() -> None:
    """Save what the cells of the tutorial of the notebook show: a plan and two charts."""
    import matplotlib

    matplotlib.use("agg")
    with tempfile.TemporaryDirectory() as place:
        folder = followed("notebook-study", place)
        from tests.documents import cells

        done = cells("docs/tutorials/notebook-study.md", folder)
        plan = next(cell.value for cell in done if "m.figure" in cell.code)
        plan.save(folder / "plan.pdf")
        save(pymupdf.open(folder / "plan.pdf")[0], "notebook-study-plan", PAGE_DPI)
        rods, curves = done[-1].names["fig"], next(cell.names["fig"] for cell in done if "fig" in cell.names)
        save_chart(curves, "notebook-study-curves")
        save_chart(rods, "notebook-study-rods")


def save_chart(figure: Any, name: str) -> None:
    """Save a figure of matplotlib as `docs/pictures/NAME.png`."""
    stream = BytesIO()
    figure.savefig(stream, dpi=CURVES_DPI)
    save_screen(name, stream.getvalue())


def in_word(file: Path) -> pymupdf.Document | None:
    """Return the pages of a Word file as LibreOffice lays them out; None, with a message, where it is missing."""
    office = shutil.which("soffice")
    if office is None:
        print("pages of Word files are left as they are: LibreOffice Writer is not installed", file=sys.stderr)
        return None
    with tempfile.TemporaryDirectory() as folder:
        convert = [office, f"-env:UserInstallation=file://{folder}/office", "--headless", "--convert-to", "pdf"]
        subprocess.run([*convert, "--outdir", folder, str(file)], check=True, capture_output=True)
        return pymupdf.open(stream=(Path(folder) / file.with_suffix(".pdf").name).read_bytes())


def word_page() -> None:
    """Save a page of the sample's Word file, as LibreOffice lays it out, as `docs/pictures/word.png`."""
    with tempfile.TemporaryDirectory() as folder:
        pages = in_word(api.build(SAMPLE, folder, language="en", formats=["docx"]))
        if pages is not None:
            save(page_with(SHOWN_IN_WORD, pages), "word", WORD_DPI)


def curves() -> None:
    """Save the chart of the notebook beside this file as `docs/pictures/curves.png`."""
    import matplotlib

    matplotlib.use("agg")
    names: dict[str, Any] = {}
    for cell in json.loads((ROOT / "docs" / "variants.ipynb").read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code" and "ax2" not in (code := "".join(cell["source"])):
            exec(code, names)
    save_chart(names["fig"], "curves")


def main() -> None:
    """Draw a page of the sample, one of its Word file and a sheet, what moves, curves, and the scheme of each kind."""
    save(page_with(CAPTION, typeset(document(SAMPLE))), "page", PAGE_DPI)
    word_page()
    sheets = api.sheet_files(LAID_OUT, language="en", size="A1", sets=("kinematics",), formats=("pdf",))
    save(pymupdf.open(stream=sheets["sheet-1.pdf"])[0], "sheet", SHEET_DPI)
    moving()
    form()
    tutorials()
    for language in TUTORIALS:
        hand_in(language)
        class_of_60(language)
    notebook_study()
    curves()
    for kind in (*kinds(), "linkage-press"):
        save_scheme(kind)


def save_scheme(kind: str) -> None:
    """Save the scheme of an example of a kind as `docs/pictures/KIND.png`; of `atlas/NAME` as `atlas-NAME.png`."""
    files = catalogue.examples(kind).values() if is_of_atlas(kind) else SAMPLE.parent.glob(f"{kind}-*.yaml")
    page = typeset(scheme_alone(document(SHOWN.get(kind) or min(files))))[0]
    clip = drawn(page) + pymupdf.Rect(0, 0, 0, BELOW.get(kind, 0.0))
    save(page, kind.replace("/", "-"), SCHEME_DPI, clip)


if __name__ == "__main__":
    main()
