"""Marking: a student's own values against the ledger of his or her assignment, followed through."""
