"""Raters that are programs: over HTTP against a served study, or by the thousand in memory."""
