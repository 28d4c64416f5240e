"""`python -m fakesss`: the same as the `fakesss` command."""

from fakesss.cli import main

main()
