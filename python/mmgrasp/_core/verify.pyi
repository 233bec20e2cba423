"""
Checks finished plans; shares no code with the planners.
"""
from __future__ import annotations
import collections.abc
import mmgrasp._core
import numpy
import numpy.typing
import typing
__all__: list[str] = ['CheckedBody', 'CheckedCup', 'CheckedDriveBy', 'CheckedFinger', 'CheckedGrasp', 'CheckedGrid', 'CheckedIntersection', 'CheckedLegValues', 'CheckedMotion', 'CheckedPart', 'CheckedPick', 'CheckedRegion', 'CheckedStop', 'CheckedSuction', 'CheckedTray', 'CheckedUnloadRegion', 'CheckedUnloading', 'Fault', 'PathCheckResult', 'PlanCheckResult', 'PlanToCheck', 'StopRate', 'broken_seal', 'check_path', 'check_plan', 'check_schedule', 'overlapping_bodies', 'pads_unlike_grasp']
class CheckedBody:
    """
    A body of the scene as the plan file describes it.
    """
    def __init__(self, name: str, shapes: collections.abc.Sequence[mmgrasp._core.LinkShape], pose: numpy.typing.ArrayLike) -> None:
        """
        `pose` (4, 4): T_world_body; `shapes` in its frame.
        """
class CheckedGrasp:
    """
    A grasp of a part as the plan file describes it.
    """
    def __init__(self, pose: numpy.typing.ArrayLike, opening: float) -> None:
        """
        `pose` (4, 4): T_object_hand; `opening`: between the pads while holding [m].
        """
class CheckedPart:
    """
    A part and the grasps that a plan may use.
    """
    def __init__(self, body: CheckedBody, tray: str, target: bool, grasps: collections.abc.Sequence[CheckedGrasp], mass: float = 0.0, scanned: bool = False) -> None:
        """
        `tray`: name of the tray it lies in; a part that is no `target` stays; `mass` [kg], 0: not known; `scanned`: its
        body is a cover around what sensors saw, from which the widths of its grasps are not to be told.
        """
class CheckedCup:
    """
    A suction cup as the plan file describes it.
    """
    def __init__(self, position: numpy.typing.ArrayLike, radius: float) -> None:
        """
        Middle of the rim in the tool frame (3,) and its radius [m].
        """
class CheckedSuction:
    """
    Suction cups of a hand as the plan file describes them.
    """
    def __init__(self, cups: collections.abc.Sequence[CheckedCup], *, max_gap: float, vacuum: float, friction: float, safety: float) -> None:
        """
        As Suction has them.
        """
class CheckedFinger:
    """
    A finger joint, linear in the opening.
    """
    def __init__(self, joint: str, closed: float, open: float) -> None:
        """
        Values of the joint with the fingers `closed` and fully `open` [rad or m].
        """
class CheckedMotion:
    """
    One timed arm motion of a pick.
    """
    def __init__(self, kind: str, opening: float, attached: bool, times: collections.abc.Sequence[float], positions: numpy.typing.ArrayLike, velocities: numpy.typing.ArrayLike, accelerations: numpy.typing.ArrayLike | None = None) -> None:
        """
        `kind`: transit, approach, lift, stow, transfer or retreat; `opening` of the fingers [m]; `attached`: the part is; `times` (k,) [s];
        `positions`, `velocities` and, where given, `accelerations` (k, n) of the arm's joints.
        """
class CheckedPick:
    """
    One pick of a plan.
    """
    def __init__(self, stop: int, tray: str, part: str, grasp: int, motions: collections.abc.Sequence[CheckedMotion]) -> None:
        """
        Index of its stop, names of tray and part, index into the part's grasps, motions in order.
        """
class CheckedDriveBy:
    """
    A pick in one motion of base and arm, with the drive to its stop where it is the first one there.
    """
    def __init__(self, pick: int, close_at: float, closed_at: float, motion: CheckedMotion, from_release: bool = False, to_release: bool = False) -> None:
        """
        `pick`: index into the plan's picks; the fingers begin to close at `close_at` [s] and hold the part from `closed_at`
        [s] on; rows of `motion` hold x, y, theta, then the arm's joints. `from_release`: it begins where the pick before
        lets its part go, else at home; `to_release`: it ends where the part is let go, else once it is lifted.
        """
class CheckedStop:
    """
    A stop of the base.
    """
    def __init__(self, pose: numpy.typing.ArrayLike, radius: float, trays: collections.abc.Sequence[str], *, arrivals: int = 0, arrivals_served: int = 0) -> None:
        """
        `pose` (3,): x, y, theta [m, m, rad]; `radius` of the disc in which every target part stays graspable [m]; names of
        the trays served; how many arrivals were drawn, and how many serve all parts.
        """
class CheckedRegion:
    """
    Base poses that a plan says serve a tray.
    """
    def __init__(self, tray: str, cells: numpy.typing.ArrayLike) -> None:
        """
        `cells`: zeros and ones, (headings, ny, nx) flattened.
        """
class CheckedLegValues:
    """
    What a plan says about a leg of its route.
    """
    def __init__(self, length: float, turning: float, duration: float) -> None:
        """
        Length [m], sum of absolute heading changes [rad], duration [s].
        """
class CheckedIntersection:
    """
    A place that a plan says lies in the regions of several trays.
    """
    def __init__(self, trays: collections.abc.Sequence[str], heading: float, centre: numpy.typing.ArrayLike, radius: float) -> None:
        """
        Names of the trays, heading [rad], centre (2,) and radius of the disc [m].
        """
class CheckedUnloading:
    """
    A drive to the goal with a full bin, as the plan file has it.
    """
    def __init__(self, after_pick: int, to_goal: numpy.typing.ArrayLike, to_goal_values: CheckedLegValues, back: numpy.typing.ArrayLike | None = None, back_values: CheckedLegValues | None = None) -> None:
        """
        Index of the pick that filled the bin; base poses (k, 3) to the goal and, where parts are left at the stop, back, and what is
        said about both.
        """
class CheckedUnloadRegion:
    """
    Where parts are let go at the goal, as the plan file has it.
    """
    def __init__(self, T_world_region: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, drop_height: float) -> None:
        """
        Middle of the rectangle (4, 4), z up, its x and y (2,) [m], and how far above it parts are let go [m].
        """
class CheckedGrid:
    """
    The grid of a plan's regions.
    """
    def __init__(self, origin: numpy.typing.ArrayLike, resolution: float, nx: int, ny: int, headings: collections.abc.Sequence[float]) -> None:
        """
        Lower corner of cell (0, 0) (2,) [m], edge of a cell [m], cells along x and y, headings [rad].
        """
class CheckedTray:
    """
    How base poses for a tray were searched.
    """
    def __init__(self, headings: collections.abc.Sequence[float], middle: numpy.typing.ArrayLike, max_distance: float, shares_headings: bool = False) -> None:
        """
        Base headings tried [rad], the tray's middle (2,), the distance from it beyond which none were tried [m], and whether other trays' headings were tried where one of these can be served.
        """
class PlanToCheck:
    """
    A whole plan as read from plan.json: what the checker needs to know, and what is claimed. `mmgrasp.verify_plan` makes
    one of a file.
    
        verdict = mg.verify_plan("out/storeroom/plan.json")
        for fault in verdict.faults:
            print(fault.code, fault.where, fault.message)
    """
    def __init__(self, robot: mmgrasp._core.RobotSource) -> None:
        """
        A plan for this robot; everything else is set afterwards.
        """
    @property
    def T_base_bin(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the bin's top plane in the robot's root frame (4, 4), z up.
        """
    @T_base_bin.setter
    def T_base_bin(self, arg1: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def acceleration_limits(self) -> list[float]:
        """
        One an arm joint [rad/s^2 or m/s^2].
        """
    @acceleration_limits.setter
    def acceleration_limits(self, arg0: collections.abc.Sequence[float]) -> None:
        ...
    @property
    def allowed_collisions(self) -> list[tuple[str, str]]:
        """
        Pairs of names (links, obstacles, parts) that may touch.
        """
    @allowed_collisions.setter
    def allowed_collisions(self, arg0: collections.abc.Sequence[tuple[str, str]]) -> None:
        ...
    @property
    def approach(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit vector (3,) in the tip's frame along which the hand comes.
        """
    @approach.setter
    def approach(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def approach_distance(self) -> float:
        """
        Least straight way to a grasp [m].
        """
    @approach_distance.setter
    def approach_distance(self, arg0: float) -> None:
        ...
    @property
    def arm_joints(self) -> list[str]:
        """
        Names of the columns of the motions.
        """
    @arm_joints.setter
    def arm_joints(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def arrival_covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Covariance of x, y [m^2] and theta [rad^2] about a stop (3, 3); zeros: arrivals are not judged.
        """
    @arrival_covariance.setter
    def arrival_covariance(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def bin_size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Inner x and y (2,) [m].
        """
    @bin_size.setter
    def bin_size(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def capacity(self) -> int:
        """
        So many parts fill the bin; 0: it takes all.
        """
    @capacity.setter
    def capacity(self, arg0: int) -> None:
        ...
    @property
    def clearance(self) -> float:
        """
        Opening beyond the part's width before grasping [m].
        """
    @clearance.setter
    def clearance(self, arg0: float) -> None:
        ...
    @property
    def closing(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit vector (3,) in the tip's frame along which the pads close.
        """
    @closing.setter
    def closing(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def closing_speed(self) -> float:
        """
        How fast the opening shrinks [m/s], for drive_by.
        """
    @closing_speed.setter
    def closing_speed(self, arg0: float) -> None:
        ...
    @property
    def drive_by(self) -> list[CheckedDriveBy]:
        """
        What of route and picks is done in passing.
        """
    @drive_by.setter
    def drive_by(self, arg0: collections.abc.Sequence[CheckedDriveBy]) -> None:
        ...
    @property
    def drive_clearance(self) -> float:
        """
        Kept by drives farther than 1 m from both their ends [m]; 0: not asked for.
        """
    @drive_clearance.setter
    def drive_clearance(self, arg0: float) -> None:
        ...
    @property
    def drop_height(self) -> float:
        """
        Height above the bin's top plane at which parts are released [m].
        """
    @drop_height.setter
    def drop_height(self, arg0: float) -> None:
        ...
    @property
    def finger_depth(self) -> float:
        """
        Size of a pad along the approach [m]; 0: widths are not compared with the parts.
        """
    @finger_depth.setter
    def finger_depth(self, arg0: float) -> None:
        ...
    @property
    def finger_links(self) -> list[str]:
        """
        Links that may touch the part that is held.
        """
    @finger_links.setter
    def finger_links(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def finger_width(self) -> float:
        """
        Size of a pad across approach and closing [m].
        """
    @finger_width.setter
    def finger_width(self, arg0: float) -> None:
        ...
    @property
    def fingers(self) -> list[CheckedFinger]:
        """
        Finger joints.
        """
    @fingers.setter
    def fingers(self, arg0: collections.abc.Sequence[CheckedFinger]) -> None:
        ...
    @property
    def floor(self) -> float:
        """
        Everything below this height is ground [m], which links that the arm joints move, and what they hold, must not
        touch; -inf: there is none.
        """
    @floor.setter
    def floor(self, arg0: float) -> None:
        ...
    @property
    def goal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Base pose at the end (3,): x, y, theta [m, m, rad].
        """
    @goal.setter
    def goal(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def grid(self) -> CheckedGrid:
        """
        Grid of the regions.
        """
    @grid.setter
    def grid(self, arg0: CheckedGrid) -> None:
        ...
    @property
    def home(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Arm configuration while driving (n,).
        """
    @home.setter
    def home(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def intersections(self) -> list[CheckedIntersection]:
        """
        Places that the plan says lie in several regions.
        """
    @intersections.setter
    def intersections(self, arg0: collections.abc.Sequence[CheckedIntersection]) -> None:
        ...
    @property
    def leg_values(self) -> list[CheckedLegValues]:
        """
        One a leg; empty: not given.
        """
    @leg_values.setter
    def leg_values(self, arg0: collections.abc.Sequence[CheckedLegValues]) -> None:
        ...
    @property
    def lift_height(self) -> float:
        """
        Least straight way up after closing [m].
        """
    @lift_height.setter
    def lift_height(self, arg0: float) -> None:
        ...
    @property
    def lower_bound(self) -> int:
        """
        Least number of stops, as the plan says.
        """
    @lower_bound.setter
    def lower_bound(self, arg0: int) -> None:
        ...
    @property
    def max_opening(self) -> float:
        """
        Largest opening of the gripper [m].
        """
    @max_opening.setter
    def max_opening(self, arg0: float) -> None:
        ...
    @property
    def obstacles(self) -> list[CheckedBody]:
        """
        Bodies of the scene.
        """
    @obstacles.setter
    def obstacles(self, arg0: collections.abc.Sequence[CheckedBody]) -> None:
        ...
    @property
    def openings(self) -> list[float]:
        """
        Openings at equal steps of the finger joints from closed to open [m]; empty: linear from 0.
        """
    @openings.setter
    def openings(self, arg0: collections.abc.Sequence[float]) -> None:
        ...
    @property
    def other_joints(self) -> dict[str, float]:
        """
        Values of joints outside the arm [rad or m].
        """
    @other_joints.setter
    def other_joints(self, arg0: collections.abc.Mapping[str, float]) -> None:
        ...
    @property
    def padded(self) -> bool:
        """
        Bodies were kept apart by more than touching: cells beside a region prove nothing.
        """
    @padded.setter
    def padded(self, arg0: bool) -> None:
        ...
    @property
    def parts(self) -> list[CheckedPart]:
        """
        All parts, targets and others.
        """
    @parts.setter
    def parts(self, arg0: collections.abc.Sequence[CheckedPart]) -> None:
        ...
    @property
    def payload(self) -> float:
        """
        Heaviest part that may be picked [kg].
        """
    @payload.setter
    def payload(self, arg0: float) -> None:
        ...
    @property
    def picks(self) -> list[CheckedPick]:
        """
        The picks in order.
        """
    @picks.setter
    def picks(self, arg0: collections.abc.Sequence[CheckedPick]) -> None:
        ...
    @property
    def planned_robot(self) -> mmgrasp._core.RobotSource:
        """
        As the planners understood it; without URDFs: not compared.
        """
    @planned_robot.setter
    def planned_robot(self, arg0: mmgrasp._core.RobotSource) -> None:
        ...
    @property
    def positioning_uncertainty(self) -> float:
        """
        Radius of the disc in which the base may come to stand [m].
        """
    @positioning_uncertainty.setter
    def positioning_uncertainty(self, arg0: float) -> None:
        ...
    @property
    def regions(self) -> list[CheckedRegion]:
        """
        One a tray.
        """
    @regions.setter
    def regions(self, arg0: collections.abc.Sequence[CheckedRegion]) -> None:
        ...
    @property
    def robot(self) -> mmgrasp._core.RobotSource:
        """
        What the robot really is: its URDFs as they were given.
        """
    @robot.setter
    def robot(self, arg0: mmgrasp._core.RobotSource) -> None:
        ...
    @property
    def robustness_rate(self) -> float:
        """
        As the plan says; NaN: not given.
        """
    @robustness_rate.setter
    def robustness_rate(self, arg0: float) -> None:
        ...
    @property
    def route(self) -> list[list[numpy.typing.NDArray[numpy.float64]]]:
        """
        Legs of base poses (3,), one more than stops.
        """
    @route.setter
    def route(self, arg0: collections.abc.Sequence[collections.abc.Sequence[numpy.typing.ArrayLike]]) -> None:
        ...
    @property
    def searched(self) -> dict[str, CheckedTray]:
        """
        How base poses for each tray were searched, by its name.
        """
    @searched.setter
    def searched(self, arg0: collections.abc.Mapping[str, CheckedTray]) -> None:
        ...
    @property
    def start(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Base pose at the beginning (3,): x, y, theta [m, m, rad].
        """
    @start.setter
    def start(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def stops(self) -> list[CheckedStop]:
        """
        The stops in the order in which they are visited.
        """
    @stops.setter
    def stops(self, arg0: collections.abc.Sequence[CheckedStop]) -> None:
        ...
    @property
    def suction(self) -> CheckedSuction:
        """
        What holds parts in place of fingers; no cups: fingers do.
        """
    @suction.setter
    def suction(self, arg0: CheckedSuction) -> None:
        ...
    @property
    def tip_link(self) -> str:
        """
        Link of the tool centre point.
        """
    @tip_link.setter
    def tip_link(self, arg0: str) -> None:
        ...
    @property
    def trays(self) -> list[str]:
        """
        Names of the trays.
        """
    @trays.setter
    def trays(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def unload_region(self) -> CheckedUnloadRegion | None:
        """
        Where parts are let go at the goal that the hand brings there; None: they go into the bin.
        """
    @unload_region.setter
    def unload_region(self, arg0: CheckedUnloadRegion | None) -> None:
        ...
    @property
    def unloadings(self) -> list[CheckedUnloading]:
        """
        Drives to the goal with a full bin, in order.
        """
    @unloadings.setter
    def unloadings(self, arg0: collections.abc.Sequence[CheckedUnloading]) -> None:
        ...
    @property
    def velocity_limits(self) -> list[float]:
        """
        One an arm joint [rad/s or m/s].
        """
    @velocity_limits.setter
    def velocity_limits(self, arg0: collections.abc.Sequence[float]) -> None:
        ...
class PathCheckResult:
    """
    What check_path found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def configurations_checked(self) -> int:
        """
        How many were checked.
        """
    @property
    def free(self) -> bool:
        """
        Nothing is wrong.
        """
    @property
    def where(self) -> str:
        """
        Where and what is wrong; empty when free.
        """
class Fault:
    """
    One thing that is physically wrong with a plan.
    """
    def __init__(self, code: str, where: str, message: str) -> None:
        """
        A fault found elsewhere, e.g. while reading the plan.
        """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def code(self) -> str:
        """
        Which rule is broken.
        """
    @property
    def message(self) -> str:
        """
        What is wrong, with the value and the bound.
        """
    @property
    def where(self) -> str:
        """
        E.g. pick, motion and time.
        """
class StopRate:
    """
    How often every target part stayed graspable around a stop.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def good(self) -> int:
        """
        Draws from which every target part could be grasped.
        """
    @property
    def samples(self) -> int:
        """
        Draws checked; fewer than asked when the verdict was clear before.
        """
    @property
    def stop(self) -> int:
        """
        Index of the stop.
        """
    @property
    def worst_part(self) -> str:
        """
        The part that was lost most often; empty: none.
        """
class PlanCheckResult:
    """
    What the check of a plan found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def configurations_checked(self) -> int:
        """
        How many were checked.
        """
    @property
    def faults(self) -> list[Fault]:
        """
        Empty: the plan holds.
        """
    @property
    def lower_bound(self) -> int:
        """
        Fewer stops are not enough: proven again. Below minimal_stops: the least number is not decided.
        """
    @property
    def minimal_stops(self) -> int:
        """
        So many stops are enough for the plan's regions: found again.
        """
    @property
    def ok(self) -> bool:
        """
        There are no faults.
        """
    @property
    def rates(self) -> list[StopRate]:
        """
        One a stop.
        """
    @property
    def regions_searched(self) -> bool:
        """
        Cells were looked for that the regions lack; without it the numbers of stops hold for the regions as they stand.
        """
    @property
    def search_cut(self) -> bool:
        """
        The search for shared regions ended at its limit, which lower_bound allows for.
        """
def broken_seal(hand: mmgrasp._core.Hand, part: collections.abc.Sequence[mmgrasp._core.LinkShape], grasp: CheckedGrasp) -> str:
    """
    What is wrong with the seal of the hand's suction cups at the grasp, by the rule of check_plan; '' where they seal.
    """
def check_path(robot: mmgrasp._core.Robot, joints: collections.abc.Sequence[str], path: numpy.typing.ArrayLike, bodies: collections.abc.Sequence[CheckedBody], *, other_joints: collections.abc.Mapping[str, float] = {}, allowed_collisions: collections.abc.Sequence[tuple[str, str]] = [], joint_step: float = 0.005) -> PathCheckResult:
    """
    Looks at waypoints (k, n) joined by straight lines, in steps of joint_step [rad or m]: limits, self-collisions and
    collisions with the bodies, by KDL and FCL called directly. Pairs of links or bodies in `allowed_collisions` may touch.
    """
def check_plan(plan: PlanToCheck, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, joint_step: float = 0.01, base_step: float = 0.01, position_tolerance: float = 0.0001, rotation_tolerance: float = 0.001, samples: int = 1000, required_rate: float = 0.999, region_samples: int = 20, seed: int = 20240607, threads: int = 0) -> PlanCheckResult:
    """
    Checks a finished plan against its scenario.
    
    Keyword options:
        joint_step: float = 0.01  # arm paths are checked at least this finely [rad or m]
        base_step: float = 0.01  # the route [m, and rad x 2]
        position_tolerance: float = 0.0001  # of a grasp [m]
        rotation_tolerance: float = 0.001  # of a grasp [rad]
        samples: int = 1000  # base poses drawn in the uncertainty disc of each stop
        required_rate: float = 0.999  # share of them from which every target part has a grasp
        region_samples: int = 20  # base poses drawn in each region, cells drawn beside it, and poses in the radius a stop claims
        seed: int = 20240607  # of the base poses drawn
        threads: int = 0  # 0: all
    """
def check_schedule(plans: collections.abc.Sequence[PlanToCheck], starts: collections.abc.Sequence[collections.abc.Sequence[float]], durations: collections.abc.Sequence[collections.abc.Sequence[float]], clearance: float, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> list[Fault]:
    """
    Faults of robots that carry out their plans on one clock and come closer to each other than `clearance` [m], less 1 mm, at any
    moment. `starts`: when each piece of each plan begins [s]: straight sections of drives, motions of picks,
    closings and openings of the hand; `durations`: how long they are said to take.
    """
def overlapping_bodies(bodies: collections.abc.Sequence[CheckedBody], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> list[tuple[int, int]]:
    """
    Index pairs of the bodies that overlap by more than 1e-4 m; those that just touch do not. `progress(stage, fraction)`
    hears how far it is.
    """
def pads_unlike_grasp(hand: mmgrasp._core.Hand, part: collections.abc.Sequence[mmgrasp._core.LinkShape], grasp: CheckedGrasp) -> str:
    """
    How pads of the hand's size that close on the part otherwise meet it than the grasp says, '' where they do not: each
    must stop half the opening from the hand's middle, within 1.5 mm or a twentieth of the opening.
    """
