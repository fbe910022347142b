"""The open document, its solver, background jobs, settings."""
