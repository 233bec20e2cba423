"""Hands and grasps: sampled on shapes and pipes, found in depth images, and taken in passing."""

# The hand
from ._core import (
    Gripper as Gripper,
    FingerJoint as FingerJoint,
)

# Grasps of known bodies
from ._core import (
    Grasp as Grasp,
    CandidateGrasp as CandidateGrasp,
    sample_grasps as sample_grasps,
)

# Grasps seen in a height map (P1 3.7.2)
from ._core import (
    ScoredGrasp as ScoredGrasp,
    Graspability as Graspability,
    evaluate_graspability as evaluate_graspability,
    graspability_map as graspability_map,
    hand_masks as hand_masks,
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
from ._core import (
    Pipe as Pipe,
    PipeGrasp as PipeGrasp,
)
