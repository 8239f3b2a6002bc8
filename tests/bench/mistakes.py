"""The rate at which marking tells the first error by its name: `python -m tests.bench.mistakes [VARIANTS]`.

Every mistake is injected at every place where it can occur in random variants of several machines, by
students who draw by hand; the aim is 95 %.
"""

from __future__ import annotations

import sys

import numpy as np

from tests.marking.test_mistakes import MACHINES, Rates, possible_mistakes, variant


def main(variants: int) -> None:
    rng = np.random.default_rng(1)
    for name in MACHINES:
        rates = Rates()
        for _ in range(variants):
            scheme = variant(name, rng)
            for mistake in possible_mistakes(scheme):
                rates.inject(scheme, mistake, rng)
        print(f"{name}, {variants} random variants\n{rates}\n", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1)
