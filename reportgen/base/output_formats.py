"""Registry of output formats: one row for each kind of file that a command writes on request.

The functions of `reportgen.api`, the commands with their help and messages, and the search for files of an earlier
run read this table. To add a format, write a function and add a row that names it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any

from reportgen.base.records import Record

ENGINE, TYPST, MATPLOTLIB, PILLOW = "the typesetter of `--engine`: Typst or LaTeX", "Typst", "matplotlib", "Pillow"
OPENPYXL, EZDXF, FFMPEG = "openpyxl", "ezdxf", "ffmpeg"


class Format(Record):
    """One format of one product.

    `name` is its name in `--format`, and the ending of its files unless `ending` is given. `writer` is
    `module:function`, imported only when the format is written. `needs` names its requirements besides numpy: LaTeX
    and ffmpeg are programs that a user installs, everything else comes with the package. `usual` formats are
    written if none is named. `stem` is a pattern of the file's name before its ending.
    """

    product: str
    name: str
    writer: str
    needs: tuple[str, ...] = ()
    usual: bool = False
    stem: str = ""
    ending: str = ""
    per_part: bool = False
    """True if a file contains one table, so that each part of a coursework has a further file, results-cam.csv."""
    moves: bool = False
    """True if it shows a motion, not a single drawing."""

    @property
    def suffix(self) -> str:
        """The ending of its files, without the dot."""
        return self.ending or self.name

    @property
    def files(self) -> str:
        """A pattern of the names of its files."""
        part = r"(-\w+)?" if self.per_part else ""
        return rf"{self.stem or self.product}{part}\.{self.suffix}"

    def load(self) -> Callable[..., Any]:
        """Import the writer; raises `ImportError` or `AttributeError` if it does not exist."""
        return _imported(self.writer)


class BatchProduct(Record):
    """A product that `batch --make` knows by `name`: the function that makes its files, and how a batch treats them."""

    name: str
    maker: str
    """`module:function` from path, engine and language to files by name."""
    files: str = ""
    """Key of its files in `file_names`, if that is not its own name."""
    asks: bool = False
    """True if it depends on the questions of the answer sheet: its maker takes `ask`."""
    typeset: bool = False
    """True if it includes a PDF that follows the standards: its maker takes `standards`."""
    bound: str = ""
    """The name of the one PDF of a whole class."""
    usual: bool = False

    def load(self) -> Callable[..., Any]:
        """Import the maker."""
        return _imported(self.maker)


def _imported(name: str) -> Callable[..., Any]:
    module, _, function = name.partition(":")
    imported: Callable[..., Any] = getattr(import_module(module), function)
    return imported


FORMATS = (
    # Writers of a report: ReportJob → bytes by ending; a writer may add a source for `--keep-source`.
    Format("report", "pdf", "reportgen.api.format_writers:report_pdf", needs=(ENGINE,), usual=True),
    Format("report", "html", "reportgen.api.format_writers:report_page"),
    Format("report", "docx", "reportgen.api.format_writers:report_word", needs=(TYPST,)),
    # Writers of a key: KeyJob → bytes.
    Format("key", "pdf", "reportgen.api.format_writers:key_pdf", needs=(ENGINE,), usual=True),
    Format("key", "xlsx", "reportgen.api.format_writers:key_workbook", needs=(OPENPYXL,), usual=True),
    Format("key", "csv", "reportgen.api.format_writers:key_table"),
    Format("key", "json", "reportgen.api.format_writers:key_json"),
    # Of drawing sheets: SheetJob → bytes.
    Format("sheet", "pdf", "reportgen.api.format_writers:sheet_pdf", needs=(TYPST,), usual=True, stem=r"sheet-\d+"),
    Format("sheet", "dxf", "reportgen.api.format_writers:sheet_dxf", needs=(EZDXF,), usual=True, stem=r"sheet-\d+"),
    # Of figures: scenes, language, dots an inch (0: the usual) → bytes for each scene, or of all in one that moves.
    Format("figures", "svg", "reportgen.writers.picture_files:svgs", needs=(TYPST,), usual=True, stem=".+"),
    Format("figures", "png", "reportgen.writers.picture_files:pngs", needs=(TYPST,), stem=".+"),
    Format("figures", "pdf", "reportgen.writers.picture_files:pdfs", needs=(TYPST,), stem=".+"),
    Format("figures", "eps", "reportgen.writers.matplotlib_figures:eps_files", needs=(MATPLOTLIB,), stem=".+"),
    Format("figures", "gif", "reportgen.writers.video:gif", needs=(TYPST, PILLOW), stem=".+", moves=True),
    Format("figures", "mp4", "reportgen.writers.video:mp4", needs=(TYPST, PILLOW, FFMPEG), stem=".+", moves=True),
    # Writers of plots: a figure of matplotlib, the name of the format, dots an inch → bytes.
    Format("plots", "svg", "reportgen.writers.matplotlib_figures:saved", needs=(MATPLOTLIB,), usual=True, stem=".+"),
    Format("plots", "png", "reportgen.writers.matplotlib_figures:saved", needs=(MATPLOTLIB,), stem=".+"),
    Format("plots", "pdf", "reportgen.writers.matplotlib_figures:saved", needs=(MATPLOTLIB,), stem=".+"),
    Format("plots", "eps", "reportgen.writers.matplotlib_figures:saved", needs=(MATPLOTLIB,), stem=".+"),
    # Of results: the JSON object of `solve` → bytes.
    Format("results", "csv", "reportgen.results.result_files:table", per_part=True),
    Format("results", "xlsx", "reportgen.results.result_files:workbook", needs=(OPENPYXL,)),
    Format("results", "json", "reportgen.results.result_files:text"),
    # Of variants: one with a stem is one file for the class: assignment files, policy, title, language → bytes.
    Format("variants", "yaml", "reportgen.classes.variants:make_variants", usual=True),
    Format(
        *("variants", "moodle-xml", "reportgen.classes.moodle_quiz:question_bank"),
        needs=(TYPST,),
        stem="questions",
        ending="xml",
    ),
)

PRODUCTS = (
    BatchProduct("task", "reportgen.api:task_files", asks=True, typeset=True, bound="tasks.pdf", usual=True),
    BatchProduct("frame", "reportgen.api:frame_files", asks=True),
    BatchProduct("report", "reportgen.api:report_files", typeset=True, bound="reports.pdf", usual=True),
    BatchProduct("page", "reportgen.api:page_files", files="report"),
    BatchProduct("docx", "reportgen.api:word_files", files="report"),
    BatchProduct("key", "reportgen.api:key_files", asks=True, typeset=True, bound="keys.pdf", usual=True),
    BatchProduct("sheet", "reportgen.api:sheet_files", typeset=True, bound="sheets.pdf"),
)

_FIXED = {
    "task": r"task\.pdf|answers\.xlsx|assignment\.yaml",
    "report": r"report\.py",
    "frame": r"frame\.docx",
    "feedback": r"feedback\.(pdf|xlsx|txt)|marked\.docx",
    "class": r"(grades|questions|by-variant)\.csv|class\.pdf|feedback\.(zip|pdf)",
}
"""Files that have one format each, as patterns."""
_FIXED_ENDINGS = ("pdf", "docx", "xlsx", "csv", "yaml", "py", "txt", "zip")


def rows(product: str) -> tuple[Format, ...]:
    """Return the formats of a product, in the order of the table."""
    return tuple(row for row in FORMATS if row.product == product)


def names(product: str) -> tuple[str, ...]:
    """Return the names of the formats of a product, as in `--format`."""
    return tuple(row.name for row in rows(product))


def usual(product: str) -> tuple[str, ...]:
    """Return the formats of a product that are written if none is named."""
    return tuple(row.name for row in rows(product) if row.usual)


def chosen(product: str, wanted: Iterable[str]) -> tuple[Format, ...]:
    """Return the rows of some formats of a product, in the requested order; raises `KeyError` for an unknown one."""
    known = {row.name: row for row in rows(product)}
    return tuple(known[name] for name in wanted)


def file_names(product: str) -> str:
    """Return a pattern of the names of all files of a product, those with one format among them."""
    fixed = (_FIXED[product],) if product in _FIXED else ()
    return "|".join((*(row.files for row in rows(product)), *fixed))


def endings() -> tuple[str, ...]:
    """Return the endings of all files that are written, without the dot."""
    return tuple(dict.fromkeys((*(row.suffix for row in FORMATS), *_FIXED_ENDINGS)))
