"""One thread of linear algebra a worker, as workers fill the cores; property tests without deadline, since a busy
machine is no failure (`make test-long` draws many more examples)."""

import os
import sys

from hypothesis import settings

assert "numpy" not in sys.modules, "numpy reads the number of threads when it is imported, and was imported before"
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile("usual", deadline=None)
settings.register_profile("long", deadline=None, max_examples=2000)
settings.load_profile("usual")
