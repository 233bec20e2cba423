"""`python -m mmgrasp` is the command `mmgrasp`."""

import sys

from .cli import main

sys.exit(main())
