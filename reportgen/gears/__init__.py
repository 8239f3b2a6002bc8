"""Gears: the involute pair and the planetary train."""
