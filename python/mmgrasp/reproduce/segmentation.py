"""P1 5.1, 5.2 on the motor of thirteen parts: shape diameters (figure 5.2), segments (5.4), primitives and openings (5.7, 5.13).

P1's models are not published. Ours have the openings of its figure 5.13, so that what is found can be compared with what was printed.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Mesh, fit_primitives, segment_mesh, shape_diameters
from ..grippers.motor import PARTS, ROTOR, SLEEVE, Composed
from ..viz.primitive_bodies import primitive_body
from ..viz.segment_pictures import coloured, diameter_bodies
from ..viz.style import segment_colour
from ..viz.two_sides import two_sides
from .drawing import figure
from .entry import Context, Entry, Result
from .gripper_sets import SEGMENTS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SETUP = {"meshes": "ours, a product of thirteen parts; round sections of 64 sides"}
WITHIN = 0.1  # [mm], of an opening
SHOWN = {"carrier": PARTS["3"], "rotor": ROTOR}


def _areas(mesh: Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)


def _places(part: Composed, mesh: Mesh) -> dict[str, tuple[float, np.ndarray]]:
    """Where the thickness is known: round walls by their diameter, of a bored disc its two sides by the disc's height [mm]; the faces there (m,)."""
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    normals, middle, bodies = np.cross(b - a, c - a), (a + b + c) / 3, part.body_of_faces(mesh)
    level = np.abs(normals[:, 2]) > (1 - 1e-9) * np.linalg.norm(normals, axis=1)
    if part.bore > 0:
        return {"sides": (float(part.heights()[-1]), level)}
    outside = ~level & ((normals[:, :2] * middle[:, :2]).sum(axis=1) > 0)
    return {
        f"wall of body {k + 1}": (2 * section, outside & (bodies == k))
        for k, (section, _) in enumerate(part.bodies)
        if not isinstance(section, tuple)
    }


def _packed(values: np.ndarray) -> list[list[int]]:
    """Runs of equal values: [value, how many]."""
    return [[int(value), len(list(run))] for value, run in itertools.groupby(values)]


def _unpacked(runs: list[list[int]]) -> np.ndarray:
    return np.repeat([value for value, _ in runs], [count for _, count in runs])


# --- figure 5.2 -------------------------------------------------------------------------------------------------------
def figure_5_2(context: Context) -> Result:
    result = Result(setup={**SETUP, "rays": 30, "cone [deg]": 120})
    result.drawing = {"parts": {}}
    for name, part in SHOWN.items():
        mesh = part.mesh()
        ours = shape_diameters(mesh)
        lengths = shape_diameters(mesh, ray_lengths=True)
        result.drawing["parts"][name] = {
            "diameters [mm]": [round(1e3 * float(d), 3) for d in ours],
            "ray lengths [mm]": [round(1e3 * float(d), 3) for d in lengths],
            "areas [mm^2]": [round(1e6 * float(a), 3) for a in _areas(mesh)],
        }
        worst = 0.0
        for place, (true, faces) in _places(part, mesh).items():
            median = 1e3 * float(np.median(ours[faces]))
            values = result.row({"part": name, "place": place})
            values["true [mm]"] = (None, true)
            values["median [mm]"] = (None, round(median, 2))
            values["by lengths of rays, as P1 [mm]"] = (None, round(1e3 * float(np.median(lengths[faces])), 2))
            worst = max(worst, abs(median / true - 1))
        result.exact(f"{name}: the median of each place is its thickness within 5 %", worst < 0.05)
    result.notes.append(
        "P1 takes the mean length of the rays; here it is the width between the two surfaces that a ray meets, which is exact on round walls and flat ones "
        "(docs/methods/geometry.md)."
    )
    return result


def draw_figure_5_2(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 5.6, columns=2, rows=2)
    for column, (name, data) in enumerate(result["drawing"]["parts"].items()):
        diameters = np.array(data["diameters [mm]"])
        mesh = SHOWN[name].mesh()
        picture = two_sides(diameter_bodies(mesh.vertices, mesh.triangles, diameters))
        axes[column].imshow(picture)
        axes[column].axis("off")
        axes[column].set_title(f"{name}: thin (blue) to thick (red)")
        axis = axes[2 + column]
        top = 1.05 * max(max(data["diameters [mm]"]), max(data["ray lengths [mm]"]))
        for key, label in (("diameters [mm]", "width between surfaces"), ("ray lengths [mm]", "length of rays, as P1")):
            axis.hist(
                data[key], bins=[top * k / 60 for k in range(61)], weights=data["areas [mm^2]"], alpha=0.6, label=label
            )
        axis.set(xlabel="shape diameter [mm]", ylabel="area [mm²]")
        axis.legend(frameon=False)
    return fig


# --- figures 5.4 and 5.7 ----------------------------------------------------------------------------------------------
def taken_apart(part: Composed) -> dict[str, Any]:
    """A part's segments and what is offered for grasping, beside the bodies that it is made of."""
    mesh = part.mesh()
    found = segment_mesh(mesh)
    bodies, areas = part.body_of_faces(mesh), _areas(mesh)
    right = 0.0
    offered, bodies_found = [], []
    for k, fit in enumerate(fit_primitives(mesh, found.labels, threads=found.threads)):
        own = found.labels == k
        right += max(float(areas[own & (bodies == body)].sum()) for body in np.unique(bodies))
        offered.append({"kind": fit.kind, "widths": [round(1e3 * w.width, 3) for w in fit.widths]})
        bodies_found.append({"kind": fit.kind, "size": fit.size.tolist(), "T": fit.T_mesh_primitive.tolist()})
    packed = _packed(found.labels)
    return {"labels": packed, "right": right / float(areas.sum()), "offered": offered, "primitives": bodies_found}


KIND = {2: "box", 3: "cylinder"}  # by the number of fingers (P1 5.2.1)


def opening_found(printed: float, fingers: int, offered: list[dict[str, Any]]) -> float | None:
    """The opening offered nearest to a printed one: round walls for three fingers, opposite sides for two."""
    widths = [w for fit in offered if fit["kind"] == KIND[fingers] for w in fit["widths"]]
    return min(widths, key=lambda w: abs(w - printed), default=None)


def figure_5_4(context: Context) -> Result:
    result = Result(setup=SETUP)
    result.drawing = {"parts": {}}
    worst, least = 0.0, 1.0
    parts = {name: PARTS[name] for name in (("5", "12") if context.quick else PARTS)}
    for i, (name, part) in enumerate(parts.items()):
        if context.progress is not None:
            context.progress(f"part {name}", i / len(parts))
        seen = taken_apart(part)
        result.drawing["parts"][name] = seen["labels"]
        for fingers, printed, _ in SEGMENTS[name]:
            ours = opening_found(printed, fingers, seen["offered"])
            values = result.row({"part": name, "fingers": fingers, "opening printed [mm]": printed})
            values["opening [mm]"] = (printed, ours)
            values["segments"] = (None, len(seen["offered"]))
            values["area in the right segment [%]"] = (None, round(100 * seen["right"], 1))
            worst = max(worst, abs(ours - printed) if ours is not None else np.inf)
        least = min(least, seen["right"])
    result.exact(f"every opening of figure 5.13 is offered within {WITHIN} mm", worst <= WITHIN)
    result.trend("at least 90 % of each part's surface lies in the segment of its body", least >= 0.9)
    result.notes.append(
        "The necks between the blades of part 7 join the blades beside them; nobody is to grasp there. More openings than P1's are offered, the other sides of boxes."
    )
    return result


def _draw_parts(parts: dict[str, Composed], labels: dict[str, list[list[int]]], columns: int) -> Figure:
    rows = -(-len(parts) // columns)
    fig, axes = figure(2.5 * columns, 1.5 * rows, columns=columns, rows=rows)
    for axis in axes:
        axis.axis("off")
    for axis, (name, part) in zip(axes, parts.items(), strict=False):
        mesh = part.mesh()
        axis.imshow(
            two_sides(coloured(mesh.vertices, mesh.triangles, _unpacked(labels[name]), segment_colour), side=320)
        )
        axis.set_title(name, fontsize=9)
    return fig


def draw_figure_5_4(result: dict[str, Any]) -> Figure:
    seen = result["drawing"]["parts"]
    return _draw_parts({name: PARTS[name] for name in seen}, seen, 4)


EXAMPLES = {"inner sleeve shaft": SLEEVE, "rotor": ROTOR}


def figure_5_7(context: Context) -> Result:
    result = Result(setup=SETUP)
    result.drawing = {"parts": {}, "primitives": {}}
    kinds: dict[str, list[str]] = {}
    for name, part in EXAMPLES.items():
        seen = taken_apart(part)
        result.drawing["parts"][name] = seen["labels"]
        result.drawing["primitives"][name] = seen["primitives"]
        kinds[name] = sorted(fit["kind"] for fit in seen["offered"])
        for k, (section, _) in enumerate(part.bodies):
            true = min(section) if isinstance(section, tuple) else 2 * section
            fingers = 2 if isinstance(section, tuple) else 3
            ours = opening_found(true, fingers, seen["offered"])
            values = result.row({"part": name, "body": k + 1, "primitive": KIND[fingers]})
            values["true opening [mm]"] = (None, true)
            values["opening [mm]"] = (None, ours)
            result.exact(
                f"{name}, body {k + 1}: {true:g} mm within {WITHIN} mm", ours is not None and abs(ours - true) <= WITHIN
            )
    result.exact("the sleeve is two cylinders", kinds["inner sleeve shaft"] == ["cylinder"] * 2)
    result.exact("the rotor is five cylinders and a box", kinds["rotor"] == ["box", *["cylinder"] * 5])
    return result


def draw_figure_5_7(result: dict[str, Any]) -> Figure:
    """Segments above, what stands for them below."""
    fig, axes = figure(5.0, 3.0, columns=2, rows=2)
    for axis in axes:
        axis.axis("off")
    for column, (name, part) in enumerate(EXAMPLES.items()):
        mesh = part.mesh()
        labels = _unpacked(result["drawing"]["parts"][name])
        found = result["drawing"]["primitives"][name]
        bodies = [primitive_body(p["kind"], p["size"], p["T"], segment_colour(i)) for i, p in enumerate(found)]
        axes[column].imshow(two_sides(coloured(mesh.vertices, mesh.triangles, labels, segment_colour), side=320))
        axes[column].set_title(name, fontsize=9)
        axes[2 + column].imshow(two_sides(bodies, side=320))
    return fig


ENTRIES = [
    Entry("p1-figure-5.2", "Shape diameters of a carrier and a rotor", figure_5_2, draw_figure_5_2),
    Entry("p1-figure-5.4", "Segments of thirteen parts and the openings they offer", figure_5_4, draw_figure_5_4),
    Entry("p1-figure-5.7", "Primitives of a sleeve and a rotor", figure_5_7, draw_figure_5_7),
]
