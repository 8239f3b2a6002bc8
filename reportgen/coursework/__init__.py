"""One coursework of several parts: a machine's case and the parts' cases as one `Case`."""
