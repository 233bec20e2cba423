"""Which name has which colour, as a strip of a picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

LINE, SWATCH, GAP, SIZE = 26, 14, 8, 15  # [pixels]


def legend(entries: Sequence[tuple[str, str]], width: int) -> NDArray[np.uint8]:
    """Rows of swatches with their names, as many as the names need in the width: (height, width, 3)."""
    from matplotlib.font_manager import findfont
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.truetype(findfont("DejaVu Sans"), SIZE)
    places, x, y = [], GAP, 0
    for name, _ in entries:
        wide = round(font.getlength(name)) + SWATCH + 3 * GAP
        if x > GAP and x + wide > width:
            x, y = GAP, y + LINE
        places.append((x, y))
        x += wide
    image = Image.new("RGB", (width, y + LINE), "white")
    draw = ImageDraw.Draw(image)
    for (name, colour), (left, top) in zip(entries, places, strict=True):
        box = top + (LINE - SWATCH) // 2
        draw.rectangle((left, box, left + SWATCH, box + SWATCH), fill=colour)
        draw.text((left + SWATCH + GAP, top + LINE / 2), name, fill="black", font=font, anchor="lm")
    return np.asarray(image)
