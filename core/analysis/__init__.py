"""What can be computed about a design beyond its solution."""
