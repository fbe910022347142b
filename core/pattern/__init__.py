"""Pattern pieces: seams on the body, panels of its skin, and the flat pieces that they are cut from."""
