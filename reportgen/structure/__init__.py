"""The kind `structure`: mobility, Assur groups and class of a mechanism from a table of its links and pairs."""
