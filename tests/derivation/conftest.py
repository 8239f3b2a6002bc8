"""Made linkages are shared with the tests of the physics."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parent.parent / "physics"))
