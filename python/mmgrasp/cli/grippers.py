"""`mmgrasp grippers`: the least set of grippers for an assembly, each as URDF, SRDF and printable finger, and a report."""

from __future__ import annotations

import argparse

from rich.console import Console

from .._files import write_file
from ..grippers.assembly_file import load_assembly
from ..grippers.output import GRIPPER_FILES, GRIPPER_FOLDERS, result_to_dict, write_results
from ..grippers.planning import GripperPlan, plan_grippers
from .console import Reporter, print_answer
from .exit_codes import DONE, exit_code
from .output_folder import OutputFolder


def run_grippers(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code."""
    folder = OutputFolder(arguments.out, GRIPPER_FILES, GRIPPER_FOLDERS)
    with Reporter(console) as report:
        report("reading", 0.0)
        plan = plan_grippers(load_assembly(arguments.assembly), progress=report)
        report("writing", 0.0)
        from ..viz.gripper_report import gripper_report_html

        folder.fill(lambda draft: write_results(plan, draft))
        with folder.illustrated() as draft:
            if not arguments.no_pictures:
                from ..viz.gripper_pictures import write_gripper_pictures

                write_gripper_pictures(plan, draft, report)
            write_file(draft / "report.html", gripper_report_html(plan, draft))
        report("writing", 1.0)
    print_answer(arguments, console, result_to_dict(plan), lambda: _print(plan, console))
    return DONE if plan.solved else exit_code(plan.outcome)


def _print(plan: GripperPlan, console: Console) -> None:
    from ..viz.gripper_report import proof
    from ..viz.report import plural

    for note in plan.notes:
        console.print(f"note: {note}", markup=False, soft_wrap=True)
    result = plan.result
    if not plan.solved or result is None:
        console.print(f"no grippers: {plan.outcome.name.replace('_', ' ')}", style="bold red", markup=False)
        for fault in plan.faults:
            console.print(f"- {fault}", markup=False, soft_wrap=True)
        for change in plan.help:
            console.print(f"  would help: {change}", markup=False, soft_wrap=True)
        return
    what = f"{plural(len(result.grippers), 'gripper')} for {plural(len(result.parts), 'operation')}"
    console.print(f"{what}: {proof(plan)}", markup=False)
    for i, gripper in enumerate(result.grippers):
        takes = [part for part, which in zip(result.parts, result.gripper_of_part, strict=True) if which == i]
        console.print(
            f"- {gripper.name}: {gripper.actuator}, {gripper.fingers} fingers of {1e3 * gripper.finger_length:.1f} mm, opens from "
            f"{1e3 * gripper.min_opening:.1f} to {1e3 * gripper.max_opening:.1f} mm: {', '.join(takes)}",
            markup=False,
            soft_wrap=True,
        )
    console.print(f"- {plural(result.changes, 'change')} of the gripper", markup=False)
    for refused in plan.refused_in_rehearsal:
        console.print(f"- left out, refused in rehearsal: {refused}", markup=False, soft_wrap=True)
