"""Ask for the result: figures that can be asked for, and the lengths that lead there."""
