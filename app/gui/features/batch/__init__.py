"""A batch run from the window: setup, progress, table of results and distributions."""
