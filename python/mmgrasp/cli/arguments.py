"""The arguments of the command `mmgrasp`."""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import _core
from . import argument_kinds as kinds

if TYPE_CHECKING:  # argparse has no public name for what add_subparsers gives
    Commands = argparse._SubParsersAction["_Parser"]


class _Parser(argparse.ArgumentParser):
    """An argument parser whose options may not be abbreviated: a script keeps its meaning when options are added.

    Every negative number is a value: argparse itself takes -0.001 for one but -1e-3 and -inf for unknown options.
    """

    def __init__(self, **keywords: Any) -> None:
        super().__init__(allow_abbrev=False, **keywords)
        self._negative_number_matcher = re.compile(
            r"-(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$|-(inf|infinity|nan)$", re.IGNORECASE
        )


def build_parser() -> argparse.ArgumentParser:
    """The parser of all commands; `command` is the name of the one that was asked for."""
    parser = _Parser(prog="mmgrasp", description="Planning for mobile manipulators.")
    parser.add_argument("--version", action="version", version=f"mmgrasp {_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="command", parser_class=_Parser)
    adders = (
        _add_plan,
        _add_verify,
        _add_arrive,
        _add_schedule,
        _add_check,
        _add_init,
        _add_scan,
        _add_grasp,
        _add_pipe,
        _add_segment,
        _add_grippers,
    )
    for add in (*adders, _add_reproduce, _add_bench, _add_view):
        add(commands)
    return parser


def _add_plan(commands: Commands) -> None:
    parser = commands.add_parser(
        "plan", help="plan a part-supply round and write plan, report, pictures and trajectories"
    )
    parser.add_argument("scenario", type=kinds.path, help="scenario file (YAML)")
    parser.add_argument("-o", "--out", type=kinds.path, required=True, metavar="DIR", help="folder to write into")
    parser.add_argument(
        "--robot",
        type=kinds.source,
        metavar="NAME",
        help="another robot: a shipped profile (tiago, ...) or a profile file",
    )
    parser.add_argument(
        "--threads", type=kinds.threads, metavar="N", help="0: all (default); the plan does not depend on it"
    )
    parser.add_argument("--seed", type=kinds.seed, metavar="N", help="same seed, same plan")
    parser.add_argument(
        "--drive-by",
        action="store_true",
        help="make one motion of each pick and the way to it: base and arm do not stop for parts",
    )
    parser.add_argument("--no-pictures", action="store_true", help="write plan.json and the trajectories only")


def _add_verify(commands: Commands) -> None:
    parser = commands.add_parser("verify", help="check a finished plan or schedule without the planner")
    parser.add_argument(
        "plan", type=kinds.plan, help="plan.json, or the folder it lies in; or what `mmgrasp schedule` wrote"
    )
    parser.add_argument("--scenario", type=kinds.path, metavar="FILE", help="compare with this scenario, read anew")
    parser.add_argument("--robot", type=kinds.source, metavar="NAME", help="the robot profile the plan was made with")
    parser.add_argument(
        "--samples",
        type=kinds.count(1, 1_000_000, "base poses"),
        metavar="N",
        help="base poses drawn at each stop (default 1000)",
    )
    parser.add_argument("--threads", type=kinds.threads, metavar="N", help="0: all (default)")
    parser.add_argument("--json", action="store_true", help="print the verdict as JSON")


def _add_arrive(commands: Commands) -> None:
    parser = commands.add_parser("arrive", help="plan the picks of a stop again, from where the base really stands")
    parser.add_argument("plan", type=kinds.plan, help="plan.json, or the folder it lies in")
    parser.add_argument(
        "--stop",
        type=kinds.count(1, 1_000_000, "stops"),
        required=True,
        metavar="K",
        help="the plan's K-th stop, from 1",
    )
    parser.add_argument(
        "--pose",
        type=kinds.coordinate,
        nargs=3,
        required=True,
        metavar=("X", "Y", "THETA"),
        help="measured base pose [m, m, rad]",
    )
    parser.add_argument(
        "--picked", type=kinds.name, nargs="+", default=[], metavar="PART", help="parts that are gone already"
    )
    parser.add_argument("--scenario", type=kinds.path, metavar="FILE", help="the plan's scenario, where it has moved")
    parser.add_argument("--robot", type=kinds.source, metavar="NAME", help="the robot profile the plan was made with")
    parser.add_argument(
        "-o", "--out", type=kinds.path, metavar="DIR", help="write arrival.json and the trajectories there"
    )
    parser.add_argument("--json", action="store_true", help="print arrival.json")


def _add_schedule(commands: Commands) -> None:
    parser = commands.add_parser(
        "schedule", help="find when each of several robots may go in one room so that they never meet"
    )
    parser.add_argument(
        "plans",
        type=kinds.plan,
        nargs="+",
        help="plan.json of each robot, or the folder it lies in: the first goes as planned, each other one waits for those before it",
    )
    parser.add_argument(
        "-o", "--out", type=kinds.path, required=True, metavar="FILE", help="where the schedule is written (JSON)"
    )
    parser.add_argument(
        "--clearance",
        type=kinds.Number(0.01, 10, "m"),
        default=0.1,
        metavar="M",
        help="how far the robots stay apart at every moment, arms and parts in the hand included [m] (default 0.1)",
    )
    parser.add_argument(
        "--trajectories",
        type=kinds.path,
        metavar="DIR",
        help="also write each robot's round with its waits there, as CSV and as a ROS message (JSON)",
    )
    parser.add_argument(
        "--png", type=kinds.path, metavar="FILE", help="also draw what each robot does when, and the areas they share"
    )
    parser.add_argument("--json", action="store_true", help="print the schedule as JSON")


def _add_init(commands: Commands) -> None:
    parser = commands.add_parser("init", help="write a first scenario for a robot, with comments")
    parser.add_argument("urdf", type=kinds.source, help="a URDF, or a .xacro file that expands to one")
    parser.add_argument(
        "map", type=kinds.path, nargs="?", help="map.yaml of map_server or SLAM: the counter is put where it is free"
    )
    parser.add_argument(
        "-o",
        "--out",
        type=kinds.path,
        default=Path("scenario.yaml"),
        metavar="FILE",
        help="where it is written (default scenario.yaml); no file is replaced",
    )
    parser.add_argument(
        "--srdf", type=kinds.path, metavar="FILE", help="default: one of the URDF's name beside it, if any"
    )
    _add_robot_files(parser)
    parser.add_argument(
        "--mount",
        action="append",
        default=[],
        metavar="FILE=LINK",
        type=kinds.mount,
        help="another robot on a link of this one: an arm on a base, a gripper on an arm; may be repeated",
    )
    parser.add_argument("--base", choices=["diff_drive", "omni"], help="default: told from the wheels")
    parser.add_argument(
        "--group", type=kinds.name, metavar="NAME", help="SRDF group of the arm (default: the longest arm)"
    )
    parser.add_argument(
        "--tool-link",
        type=kinds.name,
        metavar="LINK",
        help="the tool frame (default: found, or made between the finger tips)",
    )


def _add_check(commands: Commands) -> None:
    parser = commands.add_parser("check", help="tell what mmgrasp understands of a robot")
    parser.add_argument("urdf", type=kinds.path, help="a URDF, or a .xacro file that expands to one")
    parser.add_argument("--srdf", type=kinds.path, metavar="FILE")
    _add_robot_files(parser)
    parser.add_argument(
        "--base",
        choices=["fixed", "diff_drive", "omni"],
        help="how it drives (default: as its wheels tell; fixed without any)",
    )
    parser.add_argument(
        "--mesh-tolerance",
        type=kinds.length,
        default=0.0,
        metavar="M",
        help="how far simpler solids may stick out of collision meshes [m] (default 0: only the same solid)",
    )
    parser.add_argument(
        "--write-srdf", type=kinds.path, metavar="FILE", help="write an SRDF with the computed link pairs"
    )
    parser.add_argument("--json", action="store_true")


def _add_scan(commands: Commands) -> None:
    parser = commands.add_parser(
        "scan", help="make a map of surfaces from a folder of depth images with poses, and a report"
    )
    parser.add_argument(
        "frames",
        type=kinds.path,
        help="folder in the layout of TUM RGB-D, Redwood / Open3D, 7-Scenes or mmgrasp's .npz",
    )
    parser.add_argument(
        "-o",
        "--out",
        type=kinds.path,
        required=True,
        metavar="DIR",
        help="folder to write into; a run goes on where it ended",
    )
    parser.add_argument(
        "--sensors",
        type=kinds.path,
        metavar="FILE",
        help="YAML about the cameras (default: sensors.yaml in the folder, if any)",
    )
    parser.add_argument(
        "--voxel",
        type=kinds.voxel,
        metavar="M",
        help="edge of a voxel [m] (default: what a pixel covers, at least 0.002)",
    )
    parser.add_argument(
        "--truncation",
        type=kinds.voxel,
        metavar="M",
        help="how far from a surface distances are kept [m] (default: 5 voxels, more for noisy cameras)",
    )
    parser.add_argument(
        "--every",
        type=kinds.count(1, 1_000_000, "frames"),
        default=1,
        metavar="N",
        help="take every Nth frame (default 1)",
    )
    parser.add_argument("--up", type=kinds.direction, metavar="X,Y,Z", help="where up is in the world of the poses")
    parser.add_argument(
        "--max-memory", type=kinds.megabytes, metavar="MB", help="largest map in memory [MB] (default 2000)"
    )
    parser.add_argument(
        "--outlier-gate",
        type=kinds.gate,
        metavar="K",
        help="leave out depths more than K standard deviations from their neighbours or from what three frames saw (default: none)",
    )
    parser.add_argument(
        "--max-incidence",
        type=kinds.incidence,
        metavar="RAD",
        help="leave out what is seen more slanted [rad] (default 1.05); 1.3 shows walls of low parts to cameras that look down",
    )
    parser.add_argument(
        "--register",
        action="store_true",
        default=None,
        help="move each frame onto the map, as far as pose_error of its sensor says that its pose may be off; what all frames share is then not in sigma",
    )
    parser.add_argument(
        "--octree",
        type=kinds.voxel,
        metavar="M",
        help="also write occupancy.bt: OctoMap's free, occupied and unknown cells of this edge [m]",
    )
    parser.add_argument("--start-over", action="store_true", help="make the map anew instead of going on with it")
    parser.add_argument("--no-pictures", action="store_true", help="leave the pictures out of the report")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def _add_grasp(commands: Commands) -> None:
    parser = commands.add_parser("grasp", help="rank grasps of the objects in a map that `mmgrasp scan` made")
    parser.add_argument("map", type=kinds.path, help="folder that `mmgrasp scan` wrote")
    parser.add_argument(
        "--gripper",
        type=kinds.source,
        metavar="NAME",
        help="whose gripper: a shipped profile (tiago, ..., sdhlike), or the file of a robot profile or scenario",
    )
    parser.add_argument(
        "--robot",
        type=kinds.source,
        metavar="NAME",
        help="only grasps that this robot's arm reaches without collisions, with its own gripper; named like --gripper",
    )
    parser.add_argument(
        "--base",
        type=kinds.base,
        metavar="X,Y,Z,HEADING",
        help="where the root of --robot stands in the map's world [m, m, m, rad] (default 0,0,0,0)",
    )
    parser.add_argument("--object", type=kinds.name, metavar="NAME", help="only this object of objects.json")
    parser.add_argument("-o", "--out", type=kinds.path, metavar="FILE", help="also write all grasps as JSON")
    parser.add_argument(
        "--png",
        type=kinds.path,
        metavar="FILE",
        help="also draw the best grasp of each object with its contact patches",
    )
    parser.add_argument(
        "--samples",
        type=kinds.count(1, 100_000, "samples"),
        default=200,
        metavar="N",
        help="grasps tried for an object, with each type of grasp",
    )
    parser.add_argument(
        "--sigmas",
        type=kinds.sigmas,
        metavar="K",
        help="standard deviations of the map's surface that hand and arm keep free (default: 2; where that leaves no grasp, the hand 1, then 0)",
    )
    parser.add_argument(
        "--grasps",
        type=kinds.count(1, 1000, "grasps"),
        default=20,
        metavar="N",
        help="best kept of an object (default 20)",
    )
    parser.add_argument("--seed", type=kinds.seed, default=1, metavar="N", help="same seed, same grasps")
    parser.add_argument("--json", action="store_true", help="print all grasps as JSON")


def _add_pipe(commands: Commands) -> None:
    parser = commands.add_parser("pipe", help="find the grasp that carries a pipe along a path and bends it least")
    parser.add_argument("problem", type=kinds.source, help="problem file (YAML), or the name of a shipped one (pipe1)")
    parser.add_argument("-o", "--out", type=kinds.path, required=True, metavar="DIR", help="folder to write into")
    parser.add_argument(
        "--algorithm",
        choices=_core.grasp_search_names(),
        metavar="NAME",
        help=f"in place of the problem's: {', '.join(_core.grasp_search_names())} (the last proves its answer)",
    )
    parser.add_argument(
        "--threads", type=kinds.threads, metavar="N", help="0: all (default); the answer does not depend on it"
    )
    parser.add_argument("--seed", type=kinds.seed, metavar="N", help="same seed, same grasp")
    parser.add_argument("--no-pictures", action="store_true", help="leave the pictures out of the report")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_segment(commands: Commands) -> None:
    parser = commands.add_parser(
        "segment", help="cut a part into the simple bodies it is composed of, and say where it can be held"
    )
    parser.add_argument("mesh", type=kinds.path, help="STL, OBJ, PLY or DAE")
    parser.add_argument("-o", "--out", type=kinds.path, metavar="DIR", help="folder for segments.json and the pictures")
    parser.add_argument(
        "--unit", choices=["m", "cm", "mm", "inch"], default="m", help="what one unit of the file is (default m)"
    )
    parser.add_argument("--seed", type=kinds.seed, default=1, metavar="N", help="same seed, same segments")
    parser.add_argument("--threads", type=kinds.threads, default=0, metavar="N", help="0: all (default)")
    parser.add_argument("--no-pictures", action="store_true", help="leave the pictures out")
    parser.add_argument("--json", action="store_true", help="print segments.json instead of the table")


def _add_grippers(commands: Commands) -> None:
    parser = commands.add_parser("grippers", help="find the least set of grippers for an assembly, from its meshes")
    parser.add_argument(
        "assembly", type=kinds.source, help="assembly file (YAML), or the name of a shipped one (pulley)"
    )
    parser.add_argument("-o", "--out", type=kinds.path, required=True, metavar="DIR", help="folder to write into")
    parser.add_argument("--no-pictures", action="store_true", help="leave the pictures out of the report")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_reproduce(commands: Commands) -> None:
    parser = commands.add_parser(
        "reproduce", help="compute a paper's tables and figures again, beside the paper's numbers"
    )
    parser.add_argument("name", type=kinds.name, nargs="*", help="p1-table-3.3, ... or all; none: list them")
    parser.add_argument("--quick", action="store_true", help="smaller set-ups that show the same in seconds")
    parser.add_argument(
        "--json", action="store_true", help="print JSON instead of Markdown: an object for one name, else a list"
    )
    parser.add_argument(
        "--out", type=kinds.path, metavar="DIR", help="also write JSON and pictures there, and a page of all of them"
    )
    parser.add_argument("--seed", type=kinds.seed, default=1, metavar="N", help="of whatever is random (default 1)")
    _add_cluster_options(parser)


def _add_bench(commands: Commands) -> None:
    parser = commands.add_parser("bench", help="run published problem sets and look at every answer again")
    parser.add_argument("name", choices=["mbm"], help="mbm: MotionBenchMaker's problems for Panda and UR5")
    parser.add_argument(
        "--data",
        type=kinds.path,
        default=Path("../shared/data"),
        metavar="DIR",
        help="folder with robots/ and planning/ (default ../shared/data)",
    )
    parser.add_argument("--robot", type=kinds.name, nargs="+", default=["panda", "ur5"], metavar="NAME")
    parser.add_argument(
        "--set", type=kinds.name, nargs="+", metavar="NAME", help="bookshelf_small, ...; default: all seven"
    )
    parser.add_argument(
        "--limit",
        type=kinds.count(1, 1_000_000, "problems"),
        default=50,
        metavar="N",
        help="problems of each set (default 50)",
    )
    parser.add_argument(
        "--seeds",
        type=kinds.count(1, 1_000_000, "runs"),
        default=1,
        metavar="N",
        help="runs of each problem (default 1)",
    )
    parser.add_argument("--planner", type=kinds.name, default="rrt_connect", help="a name of planner_names()")
    parser.add_argument("--json", action="store_true")


def _add_view(commands: Commands) -> None:
    parser = commands.add_parser("view", help="show a plan in the browser, or draw it")
    parser.add_argument("plan", type=kinds.plan, help="plan.json, or the folder it lies in")
    parser.add_argument("--png", type=kinds.path, metavar="FILE", help="write a picture instead of opening the browser")
    parser.add_argument("--film", type=kinds.path, metavar="FILE", help="write the whole round as an animated GIF")
    parser.add_argument("--port", type=kinds.count(0, 65535, ""), default=8080, metavar="N")


def _add_robot_files(parser: argparse.ArgumentParser) -> None:
    """What a URDF alone does not say about its files."""
    parser.add_argument(
        "--xacro-arg",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        type=kinds.xacro_argument,
        help="an argument of the xacro file; may be repeated",
    )
    parser.add_argument(
        "--package",
        action="append",
        default=[],
        metavar="NAME=DIR",
        type=kinds.package,
        help="where package://NAME/... lies; may be repeated",
    )


def _add_cluster_options(parser: argparse.ArgumentParser) -> None:
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=kinds.count(0, 1024, "processes"),
        metavar="N",
        help="spread the work over N local processes (0: one a core)",
    )
    where.add_argument(
        "--scheduler",
        type=kinds.address,
        metavar="ADDRESS",
        help="spread the work over a Dask cluster, tcp://host:port",
    )
    parser.add_argument(
        "--shards", type=kinds.path, metavar="DIR", help="where --workers and --scheduler keep finished shards"
    )
