"""Versions of the tables of a class, applied in their order when the server starts."""
