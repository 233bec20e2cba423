"""Segments to click in the report: a 3-D view of each part without network, and the lines of assembly.yaml that keep fingers off."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from .._core import KeepOff
from ..grippers.part_size import UNITS
from ..grippers.planning import GripperPlan
from ..scan.objects import pose_to_dict
from .style import segment_colour

SCRIPT = Path(__file__).with_suffix(".js")
STYLE = """
.picker{display:flex;flex-wrap:wrap;gap:1rem;align-items:flex-start}
.picker canvas{width:100%;max-width:560px;aspect-ratio:1;touch-action:none;cursor:crosshair;border:1px solid #8886}
.picker-side{flex:1;min-width:260px}.picker-list{max-height:280px;overflow:auto;margin:.6rem 0}.picker-list label{display:block}
.picker-list i{display:inline-block;width:.9em;height:.9em;margin:0 .3em}.picker pre{border:1px solid #8886;padding:.6rem;overflow:auto}
"""


def picker_html(plan: GripperPlan) -> str:
    """A section of the page: turn a part by dragging, click a segment to keep fingers off it, copy the lines. '' without segments."""
    if not plan.segmentations:
        return ""
    data = json.dumps(picker_data(plan)).replace("<", "\\u003c")
    return (
        f"<h2>Not to be touched</h2><style>{STYLE}</style><p>Drag to turn, scroll to come nearer, click a segment (or its box) "
        "that no finger may touch; the lines go to the parts of the assembly's file. <span class='picker-note'></span></p>"
        '<div class="picker"><canvas width="1120" height="1120" aria-label="segments of a part"></canvas><div class="picker-side">'
        '<select aria-label="part"></select><div class="picker-list"></div><pre></pre></div></div>'
        f'<script type="application/json" id="picker-data">{data}</script>'
        f"<script>{SCRIPT.read_text(encoding='utf-8')}</script>"
    )


def picker_data(plan: GripperPlan) -> list[dict[str, Any]]:
    """Each moved part: arrays as base64 of little-endian float32 (3 n, in its own frame [m]) and uint32; per segment a colour, a name and a text.

    Boxes that no finger may reach into are lines as the assembly's file has them.
    """
    out = []
    for name, segmentation in plan.segmentations.items():
        part = plan.assembly.parts[name]
        names = plan.segment_names[name]
        out.append(
            {
                "name": name,
                "vertices": _packed(np.asarray(part.mesh.vertices), "<f4"),
                "triangles": _packed(np.asarray(part.mesh.triangles), "<u4"),
                "labels": _packed(np.asarray(segmentation.labels), "<u4"),
                "colours": [segment_colour(i) for i in range(len(segmentation.segments))],
                "segments": [", a screw thread" if segment.threaded else "" for segment in segmentation.segments],
                "names": names,
                "keep_off": [
                    *(number for k in part.keep_off for number in k.segments),
                    *(names.index(chosen.removeprefix(f"{name}/")) for k in part.keep_off for chosen in k.names),
                ],
                "boxes": [line for k in part.keep_off for line in _box_lines(k, UNITS[plan.assembly.unit])],
            }
        )
    return out


def _box_lines(keep_off: KeepOff, unit: float) -> list[str]:
    """The boxes in the words and the unit of an assembly's file."""
    lines = []
    for T, size in keep_off.boxes:
        scaled = np.array(T)
        scaled[:3, 3] /= unit
        pose = ", ".join(f"{key}: {_list_text(values)}" for key, values in pose_to_dict(scaled).items())
        lines.append(f"{{box: {_list_text(size / unit)}, pose: {{{pose}}}}}")
    return lines


def _list_text(values: Iterable[float]) -> str:
    """Numbers without exponents, which YAML takes for words."""
    return f"[{', '.join(np.format_float_positional(float(f'{x:.12g}'), trim='-') for x in values)}]"


def _packed(values: np.ndarray, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()
