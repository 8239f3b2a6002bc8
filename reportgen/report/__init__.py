"""Build the report of a machine: names for its templates, equations, figures and tables.

`composing.compose(case)` makes the document.  `reportgen.document` has the tree that it returns and renders the
templates; `reportgen.case` has the data that the report shows.
"""
