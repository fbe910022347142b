"""The parts of a run: turns, gains and the exact answer."""
