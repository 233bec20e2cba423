"""A gantry carries a bar past two posts: the planner chooses where along the bar to hold it (P2 chapter 4).

One roadmap serves all grasps; each keeps a small overlay of what it blocks. With a file name as argument it draws two
overlays: the plane is the configuration space of the gantry.
"""

import sys

import numpy as np

import mmgrasp as mg

URDF = """<robot name="gantry"><link name="frame"/>
<link name="bridge"/><link name="hand"><collision><geometry><cylinder radius="0.03" length="0.1"/></geometry></collision></link>
<joint name="x" type="prismatic"><parent link="frame"/><child link="bridge"/><axis xyz="1 0 0"/>
  <limit lower="0" upper="2" velocity="1" effort="1"/></joint>
<joint name="y" type="prismatic"><parent link="bridge"/><child link="hand"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="1.2" velocity="1" effort="1"/></joint></robot>"""
LENGTH = 0.4

gantry = mg.Robot.from_strings(URDF, "").group(base_link="frame", tip="hand")
world = mg.World()
for i, (x, y, height) in enumerate([(0.7, 0.4, 0.8), (1.3, 0.85, 0.7), (1.3, 0.05, 0.1)]):
    world.add_box(f"post {i}", [0.06, height, 0.2], mg.pose([x, y, 0]))
bar = mg.LinkShape(mg.Box([LENGTH, 0.02, 0.02]))
places = np.linspace(-LENGTH / 2 + 0.02, LENGTH / 2 - 0.02, 25)
# The farther from the middle, the more the bar's weight bends the hand: a cost beside the path's length.
grasps = [mg.CandidateGrasp(mg.pose([place, 0, 0]), cost=0.5 * abs(place)) for place in places]
problem = mg.ManipulationProblem(gantry, world, bar, mg.pose([0.33, 0.3, 0]), mg.pose([1.65, 0.9, 0]), grasps)

roadmap = mg.Roadmap.build(gantry, vertices=1500, gamma=1.5)
print(roadmap, roadmap.figures)
result = mg.plan_manipulation(problem, roadmap=roadmap)
print(result)
print(f"held {places[result.grasp_index]:+.2f} m from the bar's middle; nothing over the roadmap costs less")
worst = max(range(len(grasps)), key=lambda i: abs(places[i] - places[result.grasp_index]))
other = mg.plan_manipulation(
    mg.ManipulationProblem(gantry, world, bar, problem.T_world_start, problem.T_world_goal, grasps[worst : worst + 1]),
    roadmap=roadmap,
)
print(f"held {places[worst]:+.2f} m from it alone: {other}")


def blocked_vertices(grasp: int) -> tuple[np.ndarray, np.ndarray]:
    """Which vertices the hand alone blocks, and which of the others the bar in the hand."""
    held = world.copy()
    held.add("bar", [bar])
    held.attach("bar", "hand", np.linalg.inv(grasps[grasp].T_object_tool))
    alone = mg.CollisionChecker(gantry.robot, world, gantry)
    bar_only = mg.CollisionChecker(gantry.robot, held, gantry, held_only=True)
    by_hand = np.array([not alone.is_free(q) for q in roadmap.vertices])
    return by_hand, ~by_hand & np.array([not bar_only.is_free(q) for q in roadmap.vertices])


if len(sys.argv) > 1:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import LineCollection

    figure, axes = plt.subplots(1, 2, figsize=(13, 4.4), sharey=True)
    for axis, grasp, found in zip(axes, (result.grasp_index, worst), (result, other), strict=True):
        by_hand, by_bar = blocked_vertices(grasp)
        ends = roadmap.vertices[roadmap.edges]
        axis.add_collection(LineCollection(ends, colors="0.85", linewidths=0.5))
        open_ = ~by_hand & ~by_bar
        for mask, colour, label in ((open_, "0.6", "free"), (by_hand, "k", "hand"), (by_bar, "C1", "bar in hand")):
            axis.plot(*roadmap.vertices[mask].T, ".", color=colour, ms=4, label=label)
        if found.path is not None:
            axis.plot(*found.path.T, "C0-o", lw=2, ms=5, label=f"path, {found.cost:.2f} m")
        axis.set(xlim=(0, 2), ylim=(0, 1.2), aspect="equal", xlabel="x [m]")
        axis.set_title(f"held {places[grasp]:+.2f} m from the middle")
    axes[0].set_ylabel("y [m]")
    axes[0].legend(loc="lower center", bbox_to_anchor=(1.05, -0.38), ncol=4, frameon=False)
    figure.savefig(sys.argv[1], dpi=80, bbox_inches="tight")
