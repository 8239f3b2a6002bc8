"""The one place that joins assignment, machine, mechanism and cycle: Assignment → Analysis."""

from __future__ import annotations
