"""What is sewn: elastics, what they pull with, and how long they are cut."""
