"""What leaves the survey: tables, codebook, Psych-DS."""
