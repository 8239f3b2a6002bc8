"""`reportgen watch`: the page of an assignment file, renewed while the file is written.

`edition` makes what is shown of the file as it stands, `server` serves it to this machine alone, `session` joins
both to the watching of files.
"""
