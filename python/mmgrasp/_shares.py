"""How sure a share is that was counted in draws."""

from __future__ import annotations

import math


def share_interval(good: int, count: int) -> tuple[float, float]:
    """95 % interval of a rate of which `good` of `count` draws are an estimate (E. B. Wilson, 1927)."""
    if count == 0:
        return 0.0, 1.0
    z, share = 1.959964, good / count
    middle = share + z * z / (2 * count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return max((middle - half) / (1 + z * z / count), 0.0), min((middle + half) / (1 + z * z / count), 1.0)
