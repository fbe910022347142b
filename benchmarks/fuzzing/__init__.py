"""Fuzzing of Busk: cases of several kinds, made from a seed, run in a worker with limits."""
