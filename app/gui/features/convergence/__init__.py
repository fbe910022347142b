"""The run of the solver: its plots and verdict."""
