"""Where the base stops and how it drives: reachability, base regions, stops, routes, part supply, and the control that follows.

The way of P1 chapter 3: a `ReachDatabase` of the arm gives base regions of trays, their intersections give the fewest stops, routes join
them, and `plan_part_supply` does all of it with the picks. `mmgrasp.part_supply` plans, writes and verifies it for scenarios.
"""

# What the arm reaches
from ._core import (
    ReachDatabase as ReachDatabase,
    CapabilityMap as CapabilityMap,
    BasePlacement as BasePlacement,
    cache_folder as cache_folder,
)

# Two base poses for two tool poses (P3 3.6)
from ._core import (
    plan_platform_locations as plan_platform_locations,
    PlatformLocations as PlatformLocations,
    IkSeedDatabase as IkSeedDatabase,
)

# Base regions and their intersections
from ._core import (
    make_base_grid as make_base_grid,
    BaseGrid as BaseGrid,
    compute_base_regions as compute_base_regions,
    share_headings as share_headings,
    BaseRegion as BaseRegion,
    PartExplanation as PartExplanation,
    ObjectRegions as ObjectRegions,
    robust_intersections as robust_intersections,
    maximal_intersections as maximal_intersections,
    Intersection as Intersection,
    Intersections as Intersections,
    inscribed_circle as inscribed_circle,
)

# Stops and routes
from ._core import (
    cover_from_intersections as cover_from_intersections,
    plan_stops_exact as plan_stops_exact,
    Stop as Stop,
    StopSet as StopSet,
    plan_base_route as plan_base_route,
    route_lengths as route_lengths,
    BasePath as BasePath,
)

# Orders and policies for many rounds
from ._core import (
    paired_order as paired_order,
    optimised_order as optimised_order,
    OptimisedOrder as OptimisedOrder,
    run_policy as run_policy,
    PolicyResult as PolicyResult,
    PolicyRound as PolicyRound,
)

# Part supply: the whole round as objects
from ._core import (
    Part as Part,
    Tray as Tray,
    tray_shapes as tray_shapes,
    PlaceRegion as PlaceRegion,
    UnloadRegion as UnloadRegion,
    PartSupplyProblem as PartSupplyProblem,
    PartSupplyPlan as PartSupplyPlan,
    Unloading as Unloading,
    PickMotion as PickMotion,
    Pick as Pick,
    plan_pick as plan_pick,
    plan_stop_picks as plan_stop_picks,
    write_plan as write_plan,
    plan_object_pick as plan_object_pick,
    Obstruction as Obstruction,
)

# The base on its plan (P1 4.4.2)
from ._core import (
    BaseTracker as BaseTracker,
    track_base as track_base,
    BaseTrackingResult as BaseTrackingResult,
    drive_arc as drive_arc,
    joint_velocity as joint_velocity,
    platform_velocity as platform_velocity,
    wheel_speeds as wheel_speeds,
)
from .part_supply import plan_part_supply as plan_part_supply
