"""The program that tests itself: what is tried, part by part, by `busk self-test`."""
