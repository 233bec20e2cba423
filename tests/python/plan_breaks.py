"""Ways to break a plan, one physical thing at a time: functions that change the content of a plan.json in place."""

from __future__ import annotations

import copy
import itertools
from typing import Any


def motion(plan: dict[str, Any], kind: str, pick: Any = 0) -> Any:
    return next(m for m in plan["picks"][pick]["motions"] if m["kind"] == kind)


def joint_moved(plan: dict[str, Any]) -> None:
    m = motion(plan, "transit")
    m["positions"][len(m["positions"]) // 2][1] += 0.3


def end_moved(plan: dict[str, Any]) -> None:
    motion(plan, "approach")["positions"][-1][3] += 0.02


def joint_beyond_limit(plan: dict[str, Any]) -> None:
    m = motion(plan, "transfer")
    m["positions"][len(m["positions"]) // 2][2] += 7.0


def too_fast(plan: dict[str, Any]) -> None:
    for m in plan["picks"][0]["motions"]:
        m["times"] = [t / 3 for t in m["times"]]
        m["velocities"] = [[3 * v for v in row] for row in m["velocities"]]


def obstacle_added(plan: dict[str, Any]) -> None:
    x, y, _ = plan["stops"][0]["pose"]
    shape = {"type": "box", "pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]}, "size": [0.5, 0.5, 2.0]}
    plan["scenario"]["obstacles"].append(
        {"name": "surprise", "pose": {"xyz": [x, y, 1.0], "quat_xyzw": [0, 0, 0, 1]}, "shapes": [shape]}
    )


def obstacle_on_the_route(plan: dict[str, Any]) -> None:
    poses = plan["route"][0]["poses"]
    a, b = max(itertools.pairwise(poses), key=lambda e: abs(e[0][0] - e[1][0]) + abs(e[0][1] - e[1][1]))
    xyz = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0.2]
    shape = {"type": "box", "pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]}, "size": [0.1, 0.1, 0.4]}
    plan["scenario"]["obstacles"].append(
        {"name": "box", "pose": {"xyz": xyz, "quat_xyzw": [0, 0, 0, 1]}, "shapes": [shape]}
    )


def stop_shifted(plan: dict[str, Any]) -> None:
    plan["stops"][0]["pose"][0] += 0.15


def stop_turned(plan: dict[str, Any]) -> None:
    plan["stops"][0]["pose"][2] += 0.2


def part_forgotten(plan: dict[str, Any]) -> None:
    del plan["picks"][-1]


def part_picked_twice(plan: dict[str, Any]) -> None:
    plan["picks"].append(copy.deepcopy(plan["picks"][0]))


def motions_swapped(plan: dict[str, Any]) -> None:
    m = plan["picks"][0]["motions"]
    m[1], m[2] = m[2], m[1]


def motion_missing(plan: dict[str, Any]) -> None:
    del plan["picks"][0]["motions"][2]


def picks_exchanged_motions(plan: dict[str, Any]) -> None:
    a, b = plan["picks"][0], plan["picks"][1]
    a["motions"], b["motions"] = b["motions"], a["motions"]


def part_renamed(plan: dict[str, Any]) -> None:
    plan["picks"][0]["part"] = "A/bracket_99"


def other_grasp(plan: dict[str, Any]) -> None:
    pick = plan["picks"][0]
    part = next(p for p in plan["scenario"]["parts"] if p["name"] == pick["part"])
    pick["grasp"] = (pick["grasp"] + 1) % len(part["grasps"])


def grasp_out_of_range(plan: dict[str, Any]) -> None:
    plan["picks"][0]["grasp"] = 100000


def part_moved(plan: dict[str, Any]) -> None:
    name = plan["picks"][0]["part"]
    part = next(p for p in plan["scenario"]["parts"] if p["name"] == name)
    part["pose"]["xyz"][0] += 0.01


def route_cut(plan: dict[str, Any]) -> None:
    del plan["route"][-1]


def route_jumps(plan: dict[str, Any]) -> None:
    leg = max(plan["route"], key=lambda leg: len(leg["poses"]))
    leg["poses"][len(leg["poses"]) // 2][1] += 0.4


def route_sideways(plan: dict[str, Any]) -> None:
    leg = plan["route"][0]
    leg["poses"] = [leg["poses"][0], leg["poses"][-1]]


def start_elsewhere(plan: dict[str, Any]) -> None:
    plan["scenario"]["start"][0] -= 0.3


def fingers_closed_too_early(plan: dict[str, Any]) -> None:
    motion(plan, "approach")["opening"] = 0.0
    motion(plan, "transit")["opening"] = 0.0


def fingers_open_while_holding(plan: dict[str, Any]) -> None:
    motion(plan, "transfer")["opening"] = plan["scenario"]["gripper"]["max_opening"]


def not_holding(plan: dict[str, Any]) -> None:
    motion(plan, "transfer")["attached"] = False


def time_runs_backwards(plan: dict[str, Any]) -> None:
    times = motion(plan, "lift")["times"]
    times[-1] = times[-2] - 0.01


def time_stands(plan: dict[str, Any]) -> None:
    times = motion(plan, "transit")["times"]
    times[3] = times[2]


def clock_begins_late(plan: dict[str, Any]) -> None:
    for pick in plan["picks"]:
        for m in pick["motions"]:
            m["times"] = [t + 5 for t in m["times"]]


def stop_added(plan: dict[str, Any]) -> None:
    plan["stops"].append(copy.deepcopy(plan["stops"][0]))
    last = plan["route"][-1]["poses"][0]
    plan["route"].insert(-1, {"poses": [list(last), list(last)], "length": 0, "turning": 0, "duration": 0})


def bound_lowered(plan: dict[str, Any]) -> None:
    plan["lower_bound"] = 0


def uncertainty_grown(plan: dict[str, Any]) -> None:
    plan["scenario"]["positioning_uncertainty"] = 0.8


def region_emptied(plan: dict[str, Any]) -> None:
    plan["regions"][0]["cells"] = {}


def wrist_jumps(plan: dict[str, Any]) -> None:
    m = motion(plan, "transfer")
    for row in m["positions"][len(m["positions"]) // 2 :]:
        row[-1] += 0.5


def robot_shrunk_arm_limits(plan: dict[str, Any]) -> None:
    plan["scenario"]["arm"]["velocity_limits"] = [v / 10 for v in plan["scenario"]["arm"]["velocity_limits"]]


def bin_moved(plan: dict[str, Any]) -> None:
    plan["scenario"]["place_region"]["pose"]["xyz"][0] -= 0.5


def approach_cut(plan: dict[str, Any]) -> None:
    """All but the last third is done in the transit."""
    transit, approach = plan["picks"][0]["motions"][:2]
    cut = 2 * len(approach["times"]) // 3
    for key in ("positions", "velocities", "accelerations"):
        transit[key] += approach[key][1 : cut + 1]
        approach[key] = approach[key][cut:]
    end, begin = transit["times"][-1], approach["times"][cut]
    transit["times"] += [end + t for t in approach["times"][1 : cut + 1]]
    approach["times"] = [t - begin for t in approach["times"][cut:]]


def lift_cut(plan: dict[str, Any]) -> None:
    lift, transfer = plan["picks"][0]["motions"][2:4]
    cut = len(lift["times"]) // 3
    begin, rest = lift["times"][cut], len(lift["times"]) - 1 - cut
    for key in ("positions", "velocities", "accelerations"):
        transfer[key] = lift[key][cut:-1] + transfer[key]
        lift[key] = lift[key][: cut + 1]
    ends = [t - begin for t in lift["times"][cut:]]
    transfer["times"] = ends[:rest] + [ends[-1] + t for t in transfer["times"]]
    lift["times"] = lift["times"][: cut + 1]


def accelerations_zeroed(plan: dict[str, Any]) -> None:
    for pick in plan["picks"]:
        for m in pick["motions"]:
            m["accelerations"] = [[0.0] * len(row) for row in m["accelerations"]]


def widths_scaled(plan: dict[str, Any], factor: float) -> None:
    for part in plan["scenario"]["parts"]:
        for grasp in part["grasps"]:
            grasp["opening"] *= factor
    for pick in plan["picks"]:
        for m in pick["motions"]:
            if m["attached"]:
                m["opening"] *= factor


def fingers_press_into_the_part(plan: dict[str, Any]) -> None:
    widths_scaled(plan, 0.5)


def fingers_stand_clear_of_the_part(plan: dict[str, Any]) -> None:
    widths_scaled(plan, 1.2)


def region_and_radius_inflated(plan: dict[str, Any]) -> None:
    cells = plan["regions"][0]["cells"]
    rows = {iy: (a, b) for iy, a, b in cells["0"]}
    wide = min(a for a, _ in rows.values()) - 2, max(b for _, b in rows.values()) + 2
    cells["0"] = [[iy, *wide] for iy in range(min(rows) - 2, max(rows) + 3)]
    plan["stops"][0]["radius"] *= 1.3


def drop_raised(plan: dict[str, Any]) -> None:
    plan["scenario"]["place_region"]["drop_height"] += 0.1


def bin_region_widened(plan: dict[str, Any]) -> None:
    plan["scenario"]["place_region"]["size"] = [2.0, 2.0]


def robot_moved_off_its_base(plan: dict[str, Any]) -> None:
    plan["scenario"]["robot"]["urdfs"][0]["pose"]["xyz"] = [3.0, 0.0, 10.0]


def rate_halved(plan: dict[str, Any]) -> None:
    plan["robustness_rate"] = 0.5


def rate_of_no_count(plan: dict[str, Any]) -> None:
    plan["robustness_rate"] = 1 - 0.3 / plan["scenario"]["options"]["robustness_samples"]


def grid_wider_on_one_side(plan: dict[str, Any]) -> None:
    plan["grid"]["nx"] += 3


def grid_between_cells(plan: dict[str, Any]) -> None:
    plan["grid"]["origin"][1] += 0.3 * plan["grid"]["resolution"]


def obstructed_and_solved(plan: dict[str, Any]) -> None:
    nothing = {"reach_deficit": 0, "advised_move": [0, 0], "move_trays": [], "move_objects": [], "needed_opening": 0}
    plan["obstructions"] = [
        {"tray": "A", "part": "", "stage": "region", "message": "x", "largest_uncertainty": -1, **nothing}
    ]


def called_not_minimal(plan: dict[str, Any]) -> None:
    plan["proven_minimal"] = False


def tool_elsewhere(plan: dict[str, Any]) -> None:
    plan["scenario"]["gripper"]["tool_link"] = "base_link"


def closing_along_the_approach(plan: dict[str, Any]) -> None:
    plan["scenario"]["gripper"]["closing"] = plan["scenario"]["gripper"]["approach"]


def other_intersection(plan: dict[str, Any]) -> None:
    plan["stops"][0]["intersection"] = 999


def cells_miscounted(plan: dict[str, Any]) -> None:
    plan["intersections"][0]["cells"] += 1


def tray_twice_in_an_intersection(plan: dict[str, Any]) -> None:
    said = plan["intersections"][0]
    plan["intersections"].append({**said, "trays": [said["trays"][0], *said["trays"]]})


def tray_moved(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["pose"]["xyz"][0] += 0.05


def tray_flattened(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["size"][2] *= 0.5


def other_headings(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["headings"] = [0.3]


def causes_miscounted(plan: dict[str, Any]) -> None:
    plan["regions"][0]["explanations"][0]["rejections"]["scene"] += 1


def explanations_thinned(plan: dict[str, Any]) -> None:
    """One base pose was tried, as if the region had not been looked for."""
    for said in plan["regions"][0]["explanations"]:
        said["base_poses_tried"] = said["base_poses_feasible"] = 1
        said["rejections"] = dict.fromkeys(said["rejections"], 0)


def proof_disowned(plan: dict[str, Any]) -> None:
    plan["proven_minimal"] = plan["premises"]["search_finished"] = not plan["proven_minimal"]


def workspace_shrunk(plan: dict[str, Any]) -> None:
    plan["scenario"]["robot"]["base_limits"]["workspace"] = 0.5


# Each must be refused.
BREAKS = [
    approach_cut,
    drop_raised,
    bin_region_widened,
    robot_moved_off_its_base,
    lift_cut,
    accelerations_zeroed,
    fingers_press_into_the_part,
    fingers_stand_clear_of_the_part,
    region_and_radius_inflated,
    rate_halved,
    rate_of_no_count,
    grid_wider_on_one_side,
    grid_between_cells,
    obstructed_and_solved,
    called_not_minimal,
    tool_elsewhere,
    closing_along_the_approach,
    other_intersection,
    cells_miscounted,
    tray_twice_in_an_intersection,
    tray_moved,
    tray_flattened,
    other_headings,
    causes_miscounted,
    explanations_thinned,
    proof_disowned,
    workspace_shrunk,
    joint_moved,
    end_moved,
    joint_beyond_limit,
    too_fast,
    obstacle_added,
    obstacle_on_the_route,
    stop_shifted,
    stop_turned,
    part_forgotten,
    part_picked_twice,
    motions_swapped,
    motion_missing,
    picks_exchanged_motions,
    part_renamed,
    other_grasp,
    grasp_out_of_range,
    part_moved,
    route_cut,
    route_jumps,
    route_sideways,
    start_elsewhere,
    fingers_closed_too_early,
    fingers_open_while_holding,
    not_holding,
    time_runs_backwards,
    time_stands,
    clock_begins_late,
    stop_added,
    bound_lowered,
    uncertainty_grown,
    region_emptied,
    wrist_jumps,
    robot_shrunk_arm_limits,
    bin_moved,
]
