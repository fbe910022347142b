"""The program around the method."""
