"""All assignments on all sizes, checked, with the least share that is filled: `python -m tests.sheets [A1 …]`."""

from __future__ import annotations

import sys

from reportgen.figures.frame import SIZES
from tests.sheets.handed_in import FULL, check
from tests.sheets.laid import EVERY

for size in sys.argv[1:] or SIZES:
    shares = {name: check(name, size) for name in EVERY}
    every = [share for some in shares.values() for share in some]
    name = min(shares, key=lambda name: min(shares[name]))
    below = sum(share < FULL for share in every)
    print(f"{size}: {len(every)} sheets, {below} below {FULL:.0%}, least {min(every):.0%} ({name})")
