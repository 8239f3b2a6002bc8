"""Exercises of plane motion: one instant of a system of rigid bodies, from the file to its worked solution."""
