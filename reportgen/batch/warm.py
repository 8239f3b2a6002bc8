"""Entry point of the process that workers are forked from: it loads everything, so that each finds it loaded."""

from __future__ import annotations

import os
from importlib import import_module

# A library's threads would not survive the fork, and every core has its worker.
for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[variable] = "1"
for name in ("batch.pool", "analysis", "ledger.report", "document.outline", "figures.charts", "writers.typst"):
    import_module(f"reportgen.{name}")
for name in ("jinja2", "markdown_it", "matplotlib.figure", "pint", "typst"):
    import_module(name)
