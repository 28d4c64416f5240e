"""Property tests: no deadline, since a busy machine is no failure; `make test-long` draws many more examples."""

from hypothesis import settings

settings.register_profile("usual", deadline=None)
settings.register_profile("long", deadline=None, max_examples=2000)
settings.load_profile("usual")
