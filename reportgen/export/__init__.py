"""Figures and numbers to take along: figures as files, quantities as curves, whatever kind of work they are of."""
