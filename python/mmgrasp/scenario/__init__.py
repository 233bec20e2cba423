"""Scenarios: one YAML file that says which robot does what in which storeroom (docs/scenario_format.md).

`load_scenario` resolves it: files read, the robot composed of its sections (`RobotSetup`), parts placed in their trays
(`TraySetup`) and grasps sampled.
"""

from .grasp_types import HandTypes as HandTypes
from .robot_section import ArmSetup as ArmSetup
from .robot_section import RobotSetup as RobotSetup
from .robot_section import read_arm_of as read_arm_of
from .robot_section import read_gripper as read_gripper
from .robot_section import read_hand_types as read_hand_types
from .scenario import Obstacle as Obstacle
from .scenario import Scenario as Scenario
from .scenario import load_scenario as load_scenario
from .tray_section import TraySetup as TraySetup
