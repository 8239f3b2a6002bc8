"""The kinds that tests take one by one: those of the program, and one machine of the atlas.

The machines of the atlas have the code and the words of a `linkage` and differ in their data alone.  So one of them
stands for all where a test takes each kind.  `tests/catalogue/test_atlas.py` takes every machine through what depends
on its data, in memory.
"""

from __future__ import annotations

from reportgen.base.kinds import program_kinds
from reportgen.base.template_folders import ATLAS

ATLAS_MACHINE = f"{ATLAS}/jaw-crusher"
KINDS = (*program_kinds(), ATLAS_MACHINE)
