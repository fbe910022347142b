"""Pattern pieces: seams on the body, the pieces beside it, and what leaves for the cutting table."""
