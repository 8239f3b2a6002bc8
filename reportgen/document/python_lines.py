"""Python lines of a program that computes formulas and draws their curves."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Collection
from keyword import iskeyword

import numpy as np

from reportgen.machine.load_laws import FULL_TURN

KINDS_SI = {
    "angle": "rad",
    "trial angle": "rad",
    "trial length": "m",
    "diameter": "m",
    "area": "m2",
    "speed of rotation": "rpm",
    "length": "m",
    "velocity": "m/s",
    "acceleration": "m/s2",
    "angular velocity": "rad/s",
    "angular acceleration": "rad/s2",
    "weight": "N",
    "force": "N",
    "mass": "kg",
    "moment of inertia": "kg m2",
    "torque": "N m",
    "gravity": "m/s2",
}
"""SI units in letters that every keyboard has."""
LONGEST = 100
"""Characters that a line of the program has room for."""
TABULATED = """names = list(table)
for first in range(0, len(names), 4):
    shown = names[first:first + 4]
    print("position " + " ".join(f"{name:>23}" for name in shown))
    for k in range(N):
        print(f"{k + 1:8d} " + " ".join(f"{table[name][k]:23.15e}" for name in shown))"""

DRAWN = """import sys
import matplotlib
if "--show" not in sys.argv:
    matplotlib.use("agg")
from matplotlib import pyplot as plt
figure, axes = plt.subplots(len(curves), sharex=True, figsize=(7, 2.4 * len(curves)), squeeze=False,
    layout="constrained")
for ax, (unit, names) in zip(axes.flat, curves.items()):
    for name in names:
        ax.plot(driver, table[name], ".-", label=name)
    ax.set_ylabel(unit)
    ax.grid()
    ax.legend()
axes[-1, 0].set_xlabel(DRIVER)
figure.savefig("curves.png", dpi=150)
if "--show" in sys.argv:
    plt.show()"""


def comment(text: str) -> str:
    """Return foreign text as a comment, which ends with its line, so that nothing in it can be run."""
    return f"# {' '.join(text.splitlines())}"


def python_name(id: str, taken: Collection[str]) -> str:
    """Return the Python name of a quantity from its id: f.omega.3 is omega_3."""
    plain = re.sub(r"[^0-9A-Za-z]+", "_", id.removeprefix("f.")).strip("_")
    name = f"{plain}_" if iskeyword(plain) or plain in ("N", "np") else plain
    return name if name not in taken else python_name(f"{id}.f", taken)


def given_values(values: np.ndarray, count: int) -> str:
    """Return values [N] or [1] as a Python literal; evenly spaced angles (rad) of whole turns become a formula.

    `count` is the number of positions per turn.
    """
    if len(values) == 1:
        return repr(float(values[0].real))
    for turn in (1, -1):
        even = values[0] + turn * np.arange(len(values)) * (FULL_TURN / count)
        if np.allclose(np.exp(1j * even), np.exp(1j * values), rtol=0, atol=1e-12):
            sign = "+" if turn > 0 else "-"
            return f"np.mod({float(values[0])!r} {sign} 2 * np.pi / {count} * np.arange(N), 2 * np.pi)"
    return f"np.array([{', '.join(repr(float(value)) for value in values.real)}])"


def assigned(name: str, formula: str, note: str) -> list[str]:
    """Return a line `name = formula  # note`, broken if it is too long."""
    line = f"{name} = {formula}"
    if len(line) <= LONGEST:
        return [line + note if len(line + note) <= LONGEST else line]
    parts = textwrap.wrap(formula, LONGEST - 4, break_long_words=False, break_on_hyphens=False)
    return [f"{name} = ({note}", *(f"    {part}" for part in parts), ")"]
