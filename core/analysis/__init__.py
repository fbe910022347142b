"""Analyses of a design beyond its solution."""
