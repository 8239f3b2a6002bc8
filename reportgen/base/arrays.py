"""Types of the arrays that computations pass to one another.

Only modules that compute import this one, since it loads NumPy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
"""Real numbers."""
Complexes = NDArray[np.complex128]
"""Vectors in the plane, as complex numbers."""
Flags = NDArray[np.bool_]
"""Flags that are True where a condition is met."""
