"""Who sees what when: a pure function of the study and its seed."""
