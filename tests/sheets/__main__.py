"""All assignments on all sizes, checked, one size after the other.

python -m tests.sheets [--all] [A1 …]
"""

from __future__ import annotations

import argparse

from reportgen.sheets.title_block import SIZES
from tests.sheets.handed_in import check
from tests.sheets.laid import EVERY

parser = argparse.ArgumentParser(prog="python -m tests.sheets")
parser.add_argument("sizes", nargs="*", default=list(SIZES))
parser.add_argument("--all", action="store_true")
options = parser.parse_args()
for size in options.sizes:
    for name in EVERY:
        check(name, size, options.all)
    print(size, "in order")
