"""Analysis → Ledger: every number of the report, its key and its marking, with where it comes from."""

from reportgen.ledger.core import Builder, Family, Ledger, Quantity

__all__ = ["Builder", "Family", "Ledger", "Quantity"]
