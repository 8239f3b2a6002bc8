"""Export of figures and numbers for any kind of work: figures as files, quantities as curves."""
