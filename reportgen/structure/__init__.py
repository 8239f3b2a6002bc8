"""The kind `structure`: mobility, Assur groups and class of a mechanism from a table of its links and pairs.

Also the synthesis of linkages from their extreme positions.
"""
