#include "checker_argument.hpp"

#include "given.hpp"
#include "same_robot.hpp"

namespace mmgrasp::python {

CollisionChecker checker_argument(const RobotOrChecker& robot, const OptionalGroup& given_group,
                                  const OptionalWorld& given_world, const OptionalPadding& padding) {
  if (py::isinstance<CollisionChecker>(robot)) {
    if (!given_group.is_none() || !given_world.is_none() || !padding.is_none())
      throw InvalidInput("robot: is a CollisionChecker, which has its own group, world and padding: leave those out");
    return py::cast<const CollisionChecker&>(robot).clone();
  }
  const JointGroup& group = taken(py::reinterpret_borrow<Given<JointGroup>>(given_group), "group");
  check_same_robot(taken(py::reinterpret_borrow<Given<Robot>>(robot), "robot"), group);
  const World& world = taken(py::reinterpret_borrow<Given<World>>(given_world), "world");
  return CollisionChecker(with_sampled_pairs(group), padded(world, padding));
}

}  // namespace mmgrasp::python
