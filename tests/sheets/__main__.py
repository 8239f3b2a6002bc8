"""All assignments on all sizes, checked, with the least share that is filled and the sheets that are emptier.

python -m tests.sheets [--set kinematics|forces] [A1 …]
"""

from __future__ import annotations

import argparse

from reportgen.sheets.frame import SIZES
from reportgen.sheets.plates import SETS
from tests.sheets.handed_in import FULL, check_but_filling
from tests.sheets.laid import EVERY, drawn

parser = argparse.ArgumentParser(prog="python -m tests.sheets")
parser.add_argument("sizes", nargs="*", default=list(SIZES))
parser.add_argument("--set", choices=SETS, default="")
options = parser.parse_args()
names = [name for name in EVERY if drawn(name).of_sets([options.set] if options.set else [])]
for size in options.sizes:
    shares = {name: check_but_filling(name, size, options.set) for name in names}
    every = [share for some in shares.values() for share in some]
    below = {name: [n for n, share in enumerate(some, start=1) if share < FULL] for name, some in shares.items()}
    print(f"{size}: {len(every)} sheets, least {min(every):.0%}", {name: some for name, some in below.items() if some})
