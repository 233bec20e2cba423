"""A gantry carries a bar past two posts: the planner chooses where along the bar to hold it (P2 chapter 4).

One roadmap serves all grasps; each keeps a small graph of its own with what it blocks. With a file name as argument it draws two
of these graphs, with a second one the trees that RRT*-MG grows for five of the grasps (P2 chapter 5): the plane is the
configuration space of the gantry.
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
grasps = [mg.Grasp(mg.pose([place, 0, 0]), cost=0.5 * abs(place)) for place in places]
problem = mg.ManipulationProblem(gantry, world, bar, mg.pose([0.33, 0.3, 0]), mg.pose([1.65, 0.9, 0]), grasps)

roadmap = mg.planning.Roadmap.build(gantry, vertices=1500, gamma=1.5)
print(roadmap, roadmap.statistics)
result = mg.plan_manipulation(problem, roadmap=roadmap, shorten=False)
print(result)
print(f"held {places[result.grasp_index]:+.2f} m from the bar's middle; nothing over the roadmap costs less")
worst = max(range(len(grasps)), key=lambda i: abs(places[i] - places[result.grasp_index]))


def with_grasps(chosen: list[mg.Grasp]) -> mg.ManipulationProblem:
    return mg.ManipulationProblem(gantry, world, bar, problem.T_world_start, problem.T_world_goal, chosen)


other = mg.plan_manipulation(with_grasps([grasps[worst]]), roadmap=roadmap, shorten=False)
print(f"held {places[worst]:+.2f} m from it alone: {other}")

five = list(range(0, 25, 6))
by_trees = mg.plan_manipulation(
    with_grasps([grasps[i] for i in five]), planner="rrt_star_mg", max_iterations=200, range=0.3, keep_trees=True
)
print(f"by trees, with {len(five)} of the grasps: {by_trees}, {len(by_trees.trees)} trees")


def blocked(grasp: mg.Grasp, configurations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which configurations the hand alone blocks, and which of the others the bar in the hand."""
    held = world.copy()
    held.add("bar", [bar])
    held.attach("bar", "hand", np.linalg.inv(grasp.T_object_hand))
    alone = mg.CollisionChecker(gantry.robot, world, gantry)
    bar_only = mg.CollisionChecker(gantry.robot, held, gantry, attached_only=True)
    by_hand = np.array([not alone.is_free(q) for q in configurations])
    return by_hand, ~by_hand & np.array([not bar_only.is_free(q) for q in configurations])


def draw_grasp_graphs(file: str) -> None:
    from matplotlib import pyplot as plt
    from matplotlib.collections import LineCollection

    figure, axes = plt.subplots(1, 2, figsize=(13, 4.4), sharey=True)
    for axis, grasp, found in zip(axes, (result.grasp_index, worst), (result, other), strict=True):
        by_hand, by_bar = blocked(grasps[grasp], roadmap.vertices)
        ends = roadmap.vertices[roadmap.edges]
        axis.add_collection(LineCollection(list(ends), colors="0.85", linewidths=0.5))
        open_ = ~by_hand & ~by_bar
        for mask, colour, label in ((open_, "0.6", "free"), (by_hand, "k", "hand"), (by_bar, "C1", "bar in hand")):
            axis.plot(*roadmap.vertices[mask].T, ".", color=colour, ms=4, label=label)
        if found.path is not None:
            axis.plot(*found.path.T, "C0-o", lw=2, ms=5, label="best path")
        axis.set(xlim=(0, 2), ylim=(0, 1.2), aspect="equal", xlabel="x [m]")
        axis.set_title(f"held {places[grasp]:+.2f} m from the middle: cost {found.cost:.2f} m")
    axes[0].set_ylabel("y [m]")
    axes[0].legend(loc="lower center", bbox_to_anchor=(1.05, -0.38), ncol=4, frameon=False)
    figure.savefig(file, dpi=80, bbox_inches="tight")


def draw_trees(file: str) -> None:
    from matplotlib import pyplot as plt
    from matplotlib.collections import LineCollection

    figure, axis = plt.subplots(figsize=(9, 5.6))
    x, y = np.meshgrid(np.linspace(0, 2, 201), np.linspace(0, 1.2, 121))
    by_hand, by_bar = blocked(grasps[five[by_trees.grasp_index]], np.column_stack([x.ravel(), y.ravel()]))
    shade = np.where(by_hand, 0.75, np.where(by_bar, 0.9, 1.0)).reshape(x.shape)
    axis.imshow(shade, origin="lower", extent=(0, 2, 0, 1.2), cmap="gray", vmin=0, vmax=1)
    for tree in sorted(by_trees.trees, key=lambda tree: tree.grasp):
        colour, grown = f"C{tree.grasp}", np.array(tree.parents) >= 0
        ways = np.stack([tree.vertices[grown], tree.vertices[np.array(tree.parents)[grown]]], axis=1)
        axis.add_collection(
            LineCollection(list(ways), colors=colour, linewidths=1, linestyles="--" if tree.from_goal else "-")
        )
        place = f"held {places[five[tree.grasp]]:+.2f} m from the middle"
        roots = tree.vertices[~grown].T
        axis.plot(*roots, "s" if tree.from_goal else "o", color=colour, label=None if tree.from_goal else place)
    axis.plot(*by_trees.path.T, "k", lw=2.5, label=f"best path, cost {by_trees.cost:.2f} m")
    axis.set(xlim=(0, 2), ylim=(0, 1.2), aspect="equal", xlabel="x [m]", ylabel="y [m]")
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, -0.36), ncol=3, frameon=False)
    figure.savefig(file, dpi=80, bbox_inches="tight")


if len(sys.argv) > 1:
    import matplotlib

    matplotlib.use("Agg")
    draw_grasp_graphs(sys.argv[1])
if len(sys.argv) > 2:
    draw_trees(sys.argv[2])
