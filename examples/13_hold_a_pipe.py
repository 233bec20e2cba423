"""Hold a pipe so that it sags little and the arm moves little: the best grasp for a path that the pipe must follow."""

import numpy as np

import mmgrasp as mg
from mmgrasp.grasping import ObjectPathProblem, beam_frame, copper, optimize_grasp
from mmgrasp.optim import pairwise_weights
from mmgrasp.problems.pipe_cells import FINGERS, pipe_robot, pipe_structures

robot, arm, gripper = pipe_robot("kr6like")
pipe = pipe_structures()[5]  # Pipe1 of P2 table 3.3: copper tube, 12 mm outside, 10 mm inside
frame = beam_frame(pipe, inner_diameter=0.010, material=copper())
print(f"{pipe}: {1000 * frame.mass:.0f} g")

path = []  # lifted on an arc around the arm while it turns; the first pose is where it lies
for s in np.linspace(0, 1, 30):
    turn = 1.2 * (s - 0.5)
    height = 0.34 + 0.08 * np.sin(np.pi * s)
    path.append(mg.pose([0.45 * np.cos(turn), 0.45 * np.sin(turn), height], rpy=[0.3 * s, 0.4 * s, turn]))
world = mg.World()
world.add_box("table", [2.6, 2.6, 0.05], mg.pose([0, 0, -0.03]))

# joint motion against sag against force, one over the other in the opposite corner
preferences = pairwise_weights([[1, 6, 2], [1 / 6, 1, 1 / 4], [1 / 2, 4, 1]])
motion, deflection, manipulability = preferences.weights
print(f"weights {preferences.weights.round(3)}, consistency ratio {100 * preferences.consistency_ratio:.2f} %")

problem = ObjectPathProblem(
    arm, world, pipe.shapes(), np.array(path), gripper=gripper, touch_links=sorted(FINGERS), frame=frame
)
best = optimize_grasp(
    problem,
    pipe,
    motion_weight=motion,
    deflection_weight=deflection,
    manipulability_weight=manipulability,
    max_evaluations=600,
    seed=1,
)
print(best)
if best.grasp is not None:
    worst = best.feasible[-1]
    print(f"best:  {best.grasp.provenance}")
    print(f"       joint motion {best.path.joint_motion:.2f} rad, sag up to {1000 * max(best.path.sag):.2f} mm")
    print(f"worst: joint motion {worst.joint_motion:.2f} rad, sag {1000 * worst.deflection / 29:.2f} mm on average")
    held = frame.deflection(best.grasp, path[-1])
    print(f"at the end the pipe bears {held.stress.value / 1e6:.1f} MPa on section {held.stress.member}")
    timed = mg.time_parameterize(best.path.path, arm.velocity_limits, arm.acceleration_limits)
    print(f"the motion takes {timed.duration:.2f} s; {len(best.front)} grasps are on the Pareto front")
