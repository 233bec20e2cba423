"""`python -m mmgrasp` is the command `mmgrasp`."""

import sys

from mmgrasp_command import main

sys.exit(main())
