"""Meshes of parts from files, with what is wrong with them and what was mended: one rule for assemblies and for `mmgrasp segment`."""

from __future__ import annotations

import os

from .. import _core
from .._core import Mesh


def load_part_mesh(path: str | os.PathLike[str], scale: float) -> tuple[Mesh, list[str]]:
    """The mesh of a file [m], and a note for each fault of it but that it is open (`Mesh.closed`)."""
    mesh, inside_out, turned, repeated, enclosed, bodies = _core._mesh_with_faults(path, scale)
    notes = []
    if repeated:
        notes.append(f"the mesh has {_faces(repeated)} twice: one of each was left out")
    if inside_out:
        notes.append("the mesh was inside out: its faces were turned")
    elif turned:
        notes.append(
            f"{_faces(turned)} of {len(mesh.triangles):,} looked another way than the rest of the mesh: "
            "they were turned"
        )
    if enclosed:
        notes.append(
            f"{enclosed:,} bod{'y lies' if enclosed == 1 else 'ies lie'} wholly within the material of another and "
            "would be weighed twice: left out; the walls of a void must look into it"
        )
    if bodies > 1:
        notes.append(
            f"the mesh is of {bodies:,} bodies that do not touch: they are taken to be joined rigidly; give each a "
            "mesh of its own if they are not"
        )
    return mesh, notes


def _faces(count: int) -> str:
    return f"{count:,} face" + "s" * (count != 1)
