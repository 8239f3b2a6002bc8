"""A coursework of several parts: the case of a machine and the cases of its parts as one `Case`."""
