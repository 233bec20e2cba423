"""Shapes, the world around the robot, and collision checks of configurations and edges.

A `World` holds named bodies made of shapes, and what the robot holds; a `CollisionChecker` answers for one group in a snapshot of it.
"""

# Shapes [m]
from ._core import (
    Box as Box,
    Capsule as Capsule,
    Cylinder as Cylinder,
    Mesh as Mesh,
    Plane as Plane,
    Sphere as Sphere,
    Voxels as Voxels,
    LinkShape as LinkShape,
    simplify_mesh as simplify_mesh,
)

# Signed distances as obstacles
from ._core import (
    DistanceField as DistanceField,
    GridDistanceField as GridDistanceField,
    MeshDistanceField as MeshDistanceField,
)

# The world and its checker
from ._core import (
    World as World,
    CollisionChecker as CollisionChecker,
    Contact as Contact,
    DistanceResult as DistanceResult,
    EdgeResult as EdgeResult,
)
