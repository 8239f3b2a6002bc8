"""The report of a machine: what its templates can name, its equations, figures and tables.

`outline.compose` makes the document.  `reportgen.document` has the tree that it returns and the rendering of templates,
`reportgen.case` the data that it shows.
"""
