"""Names of links and joints in a scenario, as its robot has them."""

from __future__ import annotations

from .._core import InvalidInput, Robot
from ..documents.reading import Node, near_miss


def check_link(robot: Robot, node: Node) -> None:
    """Refuses the name of a link that the robot does not have."""
    if node.string() not in robot.links:
        node.fail(f"the robot has no such link{near_miss(node.raw, robot.links)}")


def joint_value(robot: Robot, name: str, node: Node) -> float:
    """A value that the joint can have."""
    if name not in robot.joints:
        node.fail(f"the robot has no movable joint {name}{near_miss(name, robot.joints)}")
    value = node.number()
    try:
        robot.values({name: value})
    except InvalidInput as error:
        node.fail(str(error))
    return value
