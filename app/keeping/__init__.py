"""Keeping: nothing is lost: recent files, recovery, backups, history, variants."""
