"""Grading: sizes, increments and grade rules from measures of many bodies."""
