"""What one would write without the package: pyplot figures with mathtext, one LaTeX file, latexmk.

`python plain.py FOLDER SIZE` makes FOLDER/plain.pdf, as large as the JSON object SIZE says (see `size.py`):
as many pages, figures with as many strokes and labels, displayed formulas, tables and words.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

MOST_PASSES = 5
GOLDEN = math.pi * (3 - math.sqrt(5))

PREAMBLE = r"""\documentclass[12pt,a4paper]{article}
\usepackage[utf8]{inputenc}
\usepackage[T5]{fontenc}
\usepackage[vietnamese]{babel}
\usepackage{lmodern}
\usepackage[margin=20mm]{geometry}
\usepackage{amsmath,amssymb,array,longtable,booktabs,graphicx,float,caption,fancyhdr}
\usepackage[hidelinks]{hyperref}
\pagestyle{fancy}
\raggedbottom
\begin{document}
\tableofcontents
\newpage
"""
SENTENCE = "Vận tốc và gia tốc của các điểm được xác định bằng phương pháp vẽ hoạ đồ theo tỉ lệ xích đã chọn."
FORMULA = (
    r"v_{BA} = \mu_v\,\overline{ab} = \frac{\omega_1 l_{OA}}{\overline{pa}}\,\overline{ab}"
    r" = %.3f\cdot %.2f = %.2f\ \mathrm{m/s}"
)


def share(total: int, parts: int, index: int) -> range:
    """Which of `total` things fall to part `index` of `parts` even ones."""
    return range(total * index // parts, total * (index + 1) // parts)


def draw(folder: Path, size: Mapping[str, int]) -> None:
    """The figures: strokes of every third an arrow, the rest lines; labels in mathtext; tight boxes."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    for n in range(size["figures"]):
        figure, axes = plt.subplots(figsize=(3.0, 2.2))
        axes.set_aspect("equal")
        axes.axis("off")
        for i in share(size["strokes"], size["figures"], n):
            end = _around(i, 40.0)
            if i % 3:
                axes.plot([0.2 * end[0], end[0]], [0.1 * end[1], end[1]], "k-", linewidth=0.7)
            else:
                axes.annotate("", xy=end, xytext=(0, 0), arrowprops={"arrowstyle": "-|>", "linewidth": 0.8})
        for i in share(size["labels"], size["figures"], n):
            axes.text(*_around(i, 46.0), rf"$\overrightarrow{{v}}_{{B{i % 7}A}}$", fontsize=8)
        figure.savefig(folder / f"figure{n}.pdf", bbox_inches="tight")
        plt.close(figure)


def _around(i: int, radius: float) -> tuple[float, float]:
    """The place of item i among places spread evenly over a disc."""
    angle, out = GOLDEN * i, radius * math.sqrt(0.15 + 0.85 * ((0.618 * i) % 1.0))
    return out * math.cos(angle), 0.75 * out * math.sin(angle)


def source(size: Mapping[str, int]) -> str:
    """The LaTeX file: every page after the contents carries its share of everything."""
    pages = max(size["pages"] - 1, 1)
    return PREAMBLE + "\n\\newpage\n".join(_page(size, pages, n) for n in range(pages)) + "\n\\end{document}\n"


def _page(size: Mapping[str, int], pages: int, n: int) -> str:
    parts = [rf"\section{{Vị trí {n + 1}}}"] if n % 2 == 0 else []
    words = SENTENCE.split()
    parts.append(" ".join(words[i % len(words)] for i in share(size["words"], pages, n)))
    parts += [_formula(i) for i in share(size["formulas"], pages, n)]
    for table in share(size["tables"], pages, n):
        parts.append(_table(table, len(share(size["rows"], size["tables"], table))))
    figures = share(size["figures"], pages, n)
    if figures:
        options = f"width={min(0.48, 0.96 / len(figures)):.3f}\\textwidth,height=48mm,keepaspectratio"
        parts.append(r"\begin{figure}[H]\centering")
        parts += [rf"\includegraphics[{options}]{{figure{i}}}" for i in figures]
        parts.append(rf"\caption{{Hoạ đồ vận tốc}}\label{{figure:{n}}}\end{{figure}}")
    return "\n\n".join(parts)


def _formula(i: int) -> str:
    values = (0.2 + 0.001 * i, 10 + 0.37 * i, (0.2 + 0.001 * i) * (10 + 0.37 * i))
    return rf"\begin{{equation}}\label{{formula:{i}}}{FORMULA % values}\end{{equation}}"


def _table(table: int, rows: int) -> str:
    body = "\n".join(" & ".join(f"${row + 0.13 * k:.2f}$" for k in range(9)) + r" \\" for row in range(rows))
    return (
        rf"{{\footnotesize\begin{{longtable}}{{*{{9}}{{r}}}}\caption{{Kết quả {table}}}\\\toprule"
        + " & ".join(f"$v_{{{k}}}$" for k in range(9))
        + rf"\\\midrule\endhead {body} \bottomrule\end{{longtable}}}}"
    )


def typeset(folder: Path) -> None:
    """latexmk, or where it is missing as many passes of pdflatex as it would make."""
    latexmk = shutil.which("latexmk")
    if latexmk:
        _call((latexmk, "-pdf", "-interaction=nonstopmode", "-halt-on-error", "plain.tex"), folder)
        return
    before = b""
    for _ in range(MOST_PASSES):
        _call(("pdflatex", "-interaction=nonstopmode", "-halt-on-error", "plain.tex"), folder)
        files = (folder / f"plain.{suffix}" for suffix in ("aux", "toc", "out"))
        after = b"".join(file.read_bytes() for file in files if file.exists())
        if after == before:
            return
        before = after


def _call(command: Sequence[str], folder: Path) -> None:
    subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True)


def main(folder: Path, size: Mapping[str, int]) -> None:
    """Figures, source and PDF in a folder that exists."""
    draw(folder, size)
    (folder / "plain.tex").write_text(source(size), encoding="utf-8")
    typeset(folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]), json.loads(sys.argv[2]))
