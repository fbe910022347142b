"""Readers of scan files, one module a format."""
