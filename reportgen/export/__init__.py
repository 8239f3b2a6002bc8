"""Export figures and numbers of any kind of work: figures as files, quantities as arrays, curves and studies."""
