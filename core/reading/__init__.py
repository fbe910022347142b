"""Readers of scan files, one a format, none of which a hostile file can hang; and a skin through points."""
