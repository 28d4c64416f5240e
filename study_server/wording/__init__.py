"""What participants read, and in which language."""
