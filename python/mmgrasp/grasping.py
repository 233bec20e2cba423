"""Hands and grasps: sampled on shapes and pipes, found in depth images, and taken in passing."""

# The hand
from ._core import (
    Hand as Hand,
    HandJoint as HandJoint,
    HandBody as HandBody,
    Suction as Suction,
    SuctionCup as SuctionCup,
    eigengrasp_hand as eigengrasp_hand,
)

# Grasps, and where they come from
from ._core import (
    Grasp as Grasp,
    ContactPairProvenance as ContactPairProvenance,
    HeightMapProvenance as HeightMapProvenance,
    PipeProvenance as PipeProvenance,
)

# Grasps of known bodies
from ._core import (
    sample_grasps as sample_grasps,
    sample_suction_grasps as sample_suction_grasps,
    SampledSuctionGrasps as SampledSuctionGrasps,
    fingers_fit as fingers_fit,
    fingers_meet as fingers_meet,
    seal_gap as seal_gap,
    suction_share as suction_share,
)

# Grasps seen in a height map (P1 3.7.2)
from ._core import (
    Graspability as Graspability,
    evaluate_graspability as evaluate_graspability,
    graspability_map as graspability_map,
    hand_masks as hand_masks,
)

# Grasps of unknown parts in a map, and how probable they are (P3 4)
from ._core import (
    GraspSynthesis as GraspSynthesis,
    GraspRating as GraspRating,
    GraspSuccess as GraspSuccess,
    DrawnSuccess as DrawnSuccess,
    ContactPatch as ContactPatch,
    synthesize_grasps as synthesize_grasps,
    next_view as next_view,
    NextView as NextView,
    ViewCandidate as ViewCandidate,
    LineGrasp as LineGrasp,
)

# Grasps by pushing, while the hand moves on (P1 4.3)
from ._core import (
    PushGrasp as PushGrasp,
    ClosingOutcome as ClosingOutcome,
    push_grasp as push_grasp,
    push_speed_limit as push_speed_limit,
    closing_outcome as closing_outcome,
)

# Pipes (P2 3.2)
from ._core import Pipe as Pipe

# Frames of beams and how they bend where they are held (P2 3.2.3.3.2)
from ._core import (
    BeamFrame as BeamFrame,
    BeamMaterial as BeamMaterial,
    BeamSection as BeamSection,
    BeamMember as BeamMember,
    NodeLoad as NodeLoad,
    BeamSupport as BeamSupport,
    SupportedFrame as SupportedFrame,
    BeamState as BeamState,
    BeamExtreme as BeamExtreme,
    beam_frame as beam_frame,
    copper as copper,
    round_section as round_section,
    rectangular_section as rectangular_section,
)

# An object carried along given poses (P2 3.3), and the grasp that does it best (P2 3.4)
from ._core import (
    ObjectPathProblem as ObjectPathProblem,
    ObjectPathResult as ObjectPathResult,
    ObjectPathEvaluator as ObjectPathEvaluator,
    follow_object_path as follow_object_path,
    FeasibleGrasp as FeasibleGrasp,
    GraspOptimum as GraspOptimum,
    default_grasp_search as default_grasp_search,
    grasp_search_names as grasp_search_names,
    optimize_grasp as optimize_grasp,
    population_search_names as population_search_names,
)

# A part cut into simple bodies, and the primitives that stand for them (P1 5.1, 5.2)
from ._core import (
    segment_mesh as segment_mesh,
    MeshSegmentation as MeshSegmentation,
    MeshSegment as MeshSegment,
    ScrewThread as ScrewThread,
    shape_diameters as shape_diameters,
    fit_primitives as fit_primitives,
    segment_names as segment_names,
    FittedPrimitive as FittedPrimitive,
    GraspWidth as GraspWidth,
)
