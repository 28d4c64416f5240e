"""The survey: shows each picture exactly as rendered and records Likert ratings. Runs without OpenGL."""
