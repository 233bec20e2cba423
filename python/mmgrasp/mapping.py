"""What a camera sees: depth images, height maps, maps of surfaces, point clouds, objects and box-shaped parts in them, parts that lie at random."""

# Cameras and their images
from ._core import (
    PinholeCamera as PinholeCamera,
    look_down as look_down,
    render_depth as render_depth,
    DepthImage as DepthImage,
    make_height_map as make_height_map,
    HeightMap as HeightMap,
)

# Depth cameras and the map that their frames make
from ._core import (
    DepthCamera as DepthCamera,
    DepthNoise as DepthNoise,
    ProbabilisticSdf as ProbabilisticSdf,
    IntegrationReport as IntegrationReport,
    SdfHits as SdfHits,
    register_frame as register_frame,
    FrameRegistration as FrameRegistration,
    OccupancyMap as OccupancyMap,
    OccupancyReport as OccupancyReport,
)

# Point clouds
from ._core import (
    PointCloud as PointCloud,
    read_pcd as read_pcd,
    fit_cuboids as fit_cuboids,
    CuboidFit as CuboidFit,
    FittedCuboid as FittedCuboid,
)

# A plane and the objects that stand on it
from ._core import (
    segment_objects as segment_objects,
    segment_depth_image as segment_depth_image,
    ObjectSegmentation as ObjectSegmentation,
    SegmentedObject as SegmentedObject,
    SupportingPlane as SupportingPlane,
)

# How parts lie
from ._core import (
    resting_poses as resting_poses,
    RestingPose as RestingPose,
    random_placement as random_placement,
    RandomPlacement as RandomPlacement,
    PlacedPart as PlacedPart,
)
