"""
Checks finished plans; shares no code with the planners.
"""
from __future__ import annotations
import collections.abc
import mmgrasp._core
import numpy
import numpy.typing
import typing
__all__: list[str] = ['CheckedBody', 'CheckedDriveBy', 'CheckedFinger', 'CheckedGrasp', 'CheckedGrid', 'CheckedIntersection', 'CheckedLegFigures', 'CheckedMotion', 'CheckedPart', 'CheckedPick', 'CheckedRegion', 'CheckedStop', 'Fault', 'PathCheckResult', 'PlanCheckResult', 'PlanToCheck', 'StopRate', 'check_path', 'check_plan']
class CheckedBody:
    def __init__(self, name: str, shapes: collections.abc.Sequence[mmgrasp._core.LinkShape], pose: numpy.typing.ArrayLike) -> None:
        ...
class CheckedGrasp:
    def __init__(self, pose: numpy.typing.ArrayLike, width: float) -> None:
        ...
class CheckedPart:
    def __init__(self, body: CheckedBody, tray: str, target: bool, grasps: collections.abc.Sequence[CheckedGrasp]) -> None:
        ...
class CheckedFinger:
    def __init__(self, joint: str, closed: float, open: float) -> None:
        ...
class CheckedMotion:
    def __init__(self, kind: str, opening: float, holding: bool, times: collections.abc.Sequence[float], positions: numpy.typing.ArrayLike, velocities: numpy.typing.ArrayLike, accelerations: numpy.typing.ArrayLike | None = None) -> None:
        ...
class CheckedPick:
    def __init__(self, stop: int, tray: str, part: str, grasp: int, motions: collections.abc.Sequence[CheckedMotion]) -> None:
        ...
class CheckedDriveBy:
    def __init__(self, pick: int, close_at: float, closed_at: float, motion: CheckedMotion) -> None:
        ...
class CheckedStop:
    def __init__(self, pose: numpy.typing.ArrayLike, radius: float, trays: collections.abc.Sequence[str]) -> None:
        ...
class CheckedRegion:
    def __init__(self, tray: str, cells: numpy.typing.ArrayLike) -> None:
        ...
class CheckedLegFigures:
    def __init__(self, length: float, turning: float, duration: float) -> None:
        ...
class CheckedIntersection:
    def __init__(self, trays: collections.abc.Sequence[str], heading: float, centre: numpy.typing.ArrayLike, radius: float) -> None:
        ...
class CheckedGrid:
    def __init__(self, origin: numpy.typing.ArrayLike, resolution: float, nx: int, ny: int, headings: collections.abc.Sequence[float]) -> None:
        ...
class PlanToCheck:
    """
    A whole plan as read from plan.json.
    """
    grid: CheckedGrid
    tip_link: str
    def __init__(self, robot: mmgrasp._core.RobotSource) -> None:
        ...
    @property
    def T_base_bin(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @T_base_bin.setter
    def T_base_bin(self, arg1: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def acceleration_limits(self) -> list[float]:
        ...
    @acceleration_limits.setter
    def acceleration_limits(self, arg0: collections.abc.Sequence[float]) -> None:
        ...
    @property
    def approach(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @approach.setter
    def approach(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def arm_joints(self) -> list[str]:
        ...
    @arm_joints.setter
    def arm_joints(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def bin_size(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @bin_size.setter
    def bin_size(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def clearance(self) -> float:
        ...
    @clearance.setter
    def clearance(self, arg0: float) -> None:
        ...
    @property
    def closing_speed(self) -> float:
        ...
    @closing_speed.setter
    def closing_speed(self, arg0: float) -> None:
        ...
    @property
    def drive_by(self) -> list[CheckedDriveBy]:
        ...
    @drive_by.setter
    def drive_by(self, arg0: collections.abc.Sequence[CheckedDriveBy]) -> None:
        ...
    @property
    def drop_gap(self) -> float:
        ...
    @drop_gap.setter
    def drop_gap(self, arg0: float) -> None:
        ...
    @property
    def finger_links(self) -> list[str]:
        ...
    @finger_links.setter
    def finger_links(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def fingers(self) -> list[CheckedFinger]:
        ...
    @fingers.setter
    def fingers(self, arg0: collections.abc.Sequence[CheckedFinger]) -> None:
        ...
    @property
    def goal(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @goal.setter
    def goal(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def home(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @home.setter
    def home(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def intersections(self) -> list[CheckedIntersection]:
        ...
    @intersections.setter
    def intersections(self, arg0: collections.abc.Sequence[CheckedIntersection]) -> None:
        ...
    @property
    def lower_bound(self) -> int:
        ...
    @lower_bound.setter
    def lower_bound(self, arg0: int) -> None:
        ...
    @property
    def max_opening(self) -> float:
        ...
    @max_opening.setter
    def max_opening(self, arg0: float) -> None:
        ...
    @property
    def obstacles(self) -> list[CheckedBody]:
        ...
    @obstacles.setter
    def obstacles(self, arg0: collections.abc.Sequence[CheckedBody]) -> None:
        ...
    @property
    def other_joints(self) -> dict[str, float]:
        ...
    @other_joints.setter
    def other_joints(self, arg0: collections.abc.Mapping[str, float]) -> None:
        ...
    @property
    def parts(self) -> list[CheckedPart]:
        ...
    @parts.setter
    def parts(self, arg0: collections.abc.Sequence[CheckedPart]) -> None:
        ...
    @property
    def picks(self) -> list[CheckedPick]:
        ...
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
        ...
    @positioning_uncertainty.setter
    def positioning_uncertainty(self, arg0: float) -> None:
        ...
    @property
    def regions(self) -> list[CheckedRegion]:
        ...
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
        ...
    @robustness_rate.setter
    def robustness_rate(self, arg0: float) -> None:
        ...
    @property
    def route(self) -> list[list[numpy.typing.NDArray[numpy.float64]]]:
        ...
    @route.setter
    def route(self, arg0: collections.abc.Sequence[collections.abc.Sequence[numpy.typing.ArrayLike]]) -> None:
        ...
    @property
    def route_figures(self) -> list[CheckedLegFigures]:
        ...
    @route_figures.setter
    def route_figures(self, arg0: collections.abc.Sequence[CheckedLegFigures]) -> None:
        ...
    @property
    def start(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @start.setter
    def start(self, arg0: numpy.typing.ArrayLike) -> None:
        ...
    @property
    def stops(self) -> list[CheckedStop]:
        ...
    @stops.setter
    def stops(self, arg0: collections.abc.Sequence[CheckedStop]) -> None:
        ...
    @property
    def trays(self) -> list[str]:
        ...
    @trays.setter
    def trays(self, arg0: collections.abc.Sequence[str]) -> None:
        ...
    @property
    def velocity_limits(self) -> list[float]:
        ...
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
        ...
    @property
    def configurations_checked(self) -> int:
        ...
    @property
    def free(self) -> bool:
        ...
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
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        ...
    @property
    def code(self) -> str:
        ...
    @property
    def message(self) -> str:
        ...
    @property
    def where(self) -> str:
        ...
class StopRate:
    """
    How often every target part stayed graspable around a stop.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        ...
    @property
    def good(self) -> int:
        ...
    @property
    def samples(self) -> int:
        ...
    @property
    def stop(self) -> int:
        ...
    @property
    def worst_part(self) -> str:
        ...
class PlanCheckResult:
    """
    What the check of a plan found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        ...
    @property
    def configurations_checked(self) -> int:
        ...
    @property
    def faults(self) -> list[Fault]:
        """
        Empty: the plan holds.
        """
    @property
    def minimal_stops(self) -> int:
        ...
    @property
    def ok(self) -> bool:
        ...
    @property
    def rates(self) -> list[StopRate]:
        ...
def check_path(robot: mmgrasp._core.Robot, joints: collections.abc.Sequence[str], path: numpy.typing.ArrayLike, bodies: collections.abc.Sequence[CheckedBody], *, other_joints: collections.abc.Mapping[str, float] = {}, joint_step: float = 0.005) -> PathCheckResult:
    """
    Looks at waypoints (k, n) joined by straight lines, in steps of joint_step [rad or m]: limits, self-collisions and
    collisions with the bodies, by KDL and FCL called directly.
    """
def check_plan(plan: PlanToCheck, *, progress: collections.abc.Callable[[str, float], object] | None = None, joint_step: float = 0.01, base_step: float = 0.01, position_tolerance: float = 0.0001, rotation_tolerance: float = 0.001, samples: int = 1000, required_rate: float = 0.999, seed: int = 20240607, threads: int = 0) -> PlanCheckResult:
    """
    Checks a finished plan against its scenario.
    
    Keyword options:
        joint_step: float = 0.01  # arm paths are checked at least this finely [rad or m]
        base_step: float = 0.01  # the route [m, and rad x 2]
        position_tolerance: float = 0.0001  # of a grasp [m]
        rotation_tolerance: float = 0.001  # of a grasp [rad]
        samples: int = 1000  # base poses drawn in the uncertainty disc of each stop
        required_rate: float = 0.999  # share of them from which every target part has a grasp
        seed: int = 20240607  # of the base poses drawn
        threads: int = 0  # 0: all
    """
