"""Bring the tables of a class to the present version; called by `reportgen.server.store` with an open connection."""

from alembic import context

from reportgen.server.tables import metadata

context.configure(connection=context.config.attributes["connection"], target_metadata=metadata, render_as_batch=True)
context.run_migrations()
