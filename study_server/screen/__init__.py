"""The screen check: size, contrast, colour."""
