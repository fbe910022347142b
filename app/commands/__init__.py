"""Commands: what the command line does, one room a command."""
