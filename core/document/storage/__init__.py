"""Project files, backups and recovery."""
