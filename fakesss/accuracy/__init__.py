"""What accuracy costs in time: knobs, exact references, errors, and the settings that are worth it."""
