"""Where answers are kept: SQLite or PostgreSQL, their upgrades, copies and deletions."""
