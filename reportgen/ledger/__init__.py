"""Analysis → Ledger: every number of the report, its key and its marking, with where it comes from."""
