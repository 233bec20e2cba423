"""find_base_placement of scikit-robot on targets from a file; run by bench_base_placement.py with the baseline's python.

base_placement_baseline.py TASK.json prints one JSON line for each number of targets and set-up.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np
from skrobot.coordinates import Coordinates
from skrobot.kinematics import find_base_placement
from skrobot.kinematics.inverse_reachability_map import InverseReachabilityMap
from skrobot.models.urdf import RobotModelFromURDF


def planar(x: float, y: float, yaw: float) -> Coordinates:
    return Coordinates(pos=[x, y, 0]).rotate(yaw, "z")


def main() -> None:
    with open(sys.argv[1]) as file:
        task = json.load(file)
    robot = RobotModelFromURDF(urdf_file=task["urdf"])
    tip = getattr(robot, task["tip"])
    links = [joint.child_link for joint in robot.joint_list if joint.name in task["joints"]]
    columns = [[joint.name for joint in robot.joint_list].index(name) for name in task["joints"]]
    begin = time.perf_counter()
    table = InverseReachabilityMap(robot, tip, link_list=links).compute()
    built = time.perf_counter() - begin
    starts = [planar(*pose) for pose in task["starts"]]
    set_ups = {
        "map": {"irm": table, "initial_angles": np.array(task["postures"][:1])},
        "map, 4 postures": {"irm": table, "initial_angles": np.array(task["postures"])},
        "no map, starts around the table": {"initial_base_poses": starts},
    }
    for count in task["counts"]:
        targets = [Coordinates(pos=np.array(T)[:3, 3], rot=np.array(T)[:3, :3]) for T in task["targets"][str(count)]]
        for name, options in set_ups.items():
            times, processor = [], []
            for _ in range(task["rounds"]):
                begin, used = time.perf_counter(), time.process_time()
                found = find_base_placement(
                    robot,
                    targets,
                    move_target=tip,
                    link_list=links,
                    thre=task["position_tolerance"],
                    rthre=task["rotation_tolerance"],
                    **options,
                )
                times.append(time.perf_counter() - begin)
                processor.append(time.process_time() - used)
            base = found.base_pose.worldpos()
            yaw = np.arctan2(found.base_pose.worldrot()[1, 0], found.base_pose.worldrot()[0, 0])
            answer = {
                "count": count,
                "set_up": name,
                "seconds": min(times),
                "processor": min(processor),
                "map_s": built if "irm" in options else 0.0,
                "samples": table.n_samples if "irm" in options else 0,
                "base": [float(base[0]), float(base[1]), float(yaw)],
                "reached": [bool(ok) for ok in found.success],
                "angles": np.asarray(found.angle_vectors)[:, columns].tolist(),
            }
            print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
