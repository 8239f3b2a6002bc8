"""A machine's report: its words, equations, figures and tables become a `Document`.

`outline.compose` is the way in.  The tree of blocks and what turns words into it is `reportgen.document`, the data
that a report is made of is `reportgen.case`.
"""
