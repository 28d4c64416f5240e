"""A study turned into scenes, pictures and a manifest. It has never heard of a participant."""
