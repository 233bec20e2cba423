"""The main job: a storeroom's parts are picked and supplied (P1).

A scenario is planned (`plan_part_supply`), parts may be taken in passing (`plan_drive_by_picks`), plans are written to and
read from plan.json (`read_plan`, `plan_schema`), planned again from where the base really stands (`arrive`), and checked again without the planner (`verify_plan`). Plans of
several robots get times at which they do not meet (`schedule_plans`, `verify_schedule`).
"""

from .arrival import Arrival as Arrival
from .arrival import arrive as arrive
from .drive_by import DriveByPick as DriveByPick
from .drive_by import DriveByPlan as DriveByPlan
from .drive_by import plan_drive_by_picks as plan_drive_by_picks
from .plan_file import plan_schema as plan_schema
from .plan_file import read_plan as read_plan
from .plan_reader import plan_to_check as plan_to_check
from .planning import ScenarioPlan as ScenarioPlan
from .planning import plan_part_supply as plan_part_supply
from .schedule import Schedule as Schedule
from .schedule import schedule_plans as schedule_plans
from .schedule_check import ScheduleVerdict as ScheduleVerdict
from .schedule_check import verify_schedule as verify_schedule
from .scheduled_robot import ScheduledRobot as ScheduledRobot
from .shared_areas import SharedArea as SharedArea
from .verification import PlanVerdict as PlanVerdict
from .verification import verify_plan as verify_plan
