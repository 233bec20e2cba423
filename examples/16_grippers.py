"""Two mesh files, one assembly: which grippers put them together, and their fingers as files to print."""

from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.output import write_results
from mmgrasp.grippers.turned_parts import turned
from mmgrasp.viz.gripper_pictures import write_gripper_pictures


def write_obj(path: Path, mesh: mg.Mesh) -> None:
    """What a CAD program would export, in millimetres."""
    lines = ["v {:.6f} {:.6f} {:.6f}".format(*vertex) for vertex in 1e3 * np.asarray(mesh.vertices)]
    lines += ["f {} {} {}".format(*triangle) for triangle in np.asarray(mesh.triangles) + 1]
    path.write_text("\n".join(lines) + "\n")


# A pin on a foot, and a bush that goes over it: closed profiles of (radius, z) [mm].
PIN = np.array([(0, 0), (20, 0), (20, 8), (6, 8), (6, 50), (0, 50)])
BUSH = np.array([(6.1, 0), (15, 0), (15, 12), (10, 12), (10, 22), (6.1, 22)])
write_obj(Path("pin.obj"), turned(1e-3 * PIN))
write_obj(Path("bush.obj"), turned(1e-3 * BUSH))
Path("assembly.yaml").write_text("""
format: mmgrasp-assembly
version: 1
name: a bush on a pin
unit: mm
parts:
  - {name: table, box: [120, 120, 10], pose: {xyz: [0, 0, -5]}}
  - {name: pin, mesh: pin.obj}
  - {name: bush, mesh: bush.obj, pose: {xyz: [0, 0, 8]}}
order:
  - {part: pin, onto: [table], from: {xyz: [0, 0, 60]}}
  - {part: bush, onto: [table, pin], from: {xyz: [0, 0, 60]}, insertion: {force: 15}}
actuators:
  - {name: air chuck, fingers: 3, stroke: 12}
fingers: {width: 10, thickness: 6, min_contact: 2}
holding: {force: 40, friction: 0.5, modulus: 3}   # N, -, MPa
""")

plan = plan_grippers(load_assembly("assembly.yaml"))
assert plan.solved and plan.result is not None
for operation, gripper, requirement in zip(
    plan.result.parts, plan.result.gripper_of_part, plan.result.requirement_of_part, strict=True
):
    asked, held = plan.requirements[requirement], plan.holdings[requirement]
    assert held is not None
    print(
        f"{operation}: {plan.result.grippers[gripper].name} by {asked.segment}, {1e3 * asked.opening:.1f} mm wide, "
        f"fingers of at least {1e3 * asked.min_finger_length:.1f} mm; holds {held.safety:.1f} times its load"
    )
folder = Path("grippers")
folder.mkdir(exist_ok=True)
write_results(plan, folder)  # gripper_1/gripper.urdf, gripper.srdf, finger.stl, ...
pictures = write_gripper_pictures(plan, folder, lambda stage, share: None)
hand = mg.Robot.load(folder / "gripper_1" / "gripper.urdf", srdf=folder / "gripper_1" / "gripper.srdf")
print(f"{hand.name}: {', '.join(sorted(p.name for p in (folder / 'gripper_1').iterdir()))}; {len(pictures)} pictures")
