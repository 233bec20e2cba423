#pragma once

#include <string>

namespace mmgrasp::test {

inline std::string urdf_link(const std::string& name, const std::string& collision = "") {
  return "<link name='" + name + "'>" + (collision.empty() ? "" : "<collision>" + collision + "</collision>") +
         "</link>\n";
}

inline std::string urdf_joint(const std::string& name, const std::string& type, const std::string& parent,
                              const std::string& child, const std::string& xyz, const std::string& axis,
                              const std::string& lower = "-3.0", const std::string& upper = "3.0") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" + child +
         "'/><origin xyz='" + xyz + "'/><axis xyz='" + axis + "'/>" +
         (type == "fixed" ? "" : "<limit lower='" + lower + "' upper='" + upper + "' velocity='1' effort='10'/>") +
         "</joint>\n";
}

/// Three prismatic joints of +-0.5 m along x, y, z, then a wrist about z, y, x: the tip's pose is
/// (x, y, z) and Rz(a) Ry(b) Rx(c) in closed form. No shapes.
inline std::string gantry_urdf() {
  std::string urdf = "<robot name='gantry'>" + urdf_link("base");
  const char* parents[] = {"base", "x", "y", "z", "a", "b"};
  const char* children[] = {"x", "y", "z", "a", "b", "c"};
  const char* axes[] = {"1 0 0", "0 1 0", "0 0 1", "0 0 1", "0 1 0", "1 0 0"};
  for (int i = 0; i < 6; ++i) {
    const std::string name = children[i];
    urdf += urdf_link(name) +
            (i < 3 ? urdf_joint("joint_" + name, "prismatic", parents[i], name, "0 0 0", axes[i], "-0.5", "0.5")
                   : urdf_joint("joint_" + name, "continuous", parents[i], name, "0 0 0", axes[i]));
  }
  return urdf + "</robot>";
}

/// Two links of 0.5 m turning about z, a ball of 0.1 m radius on the base and on the tip: they touch when the tip comes
/// within 0.2 m of the base. A small ball halfway along the upper link touches neither; it keeps base and tip from
/// counting as adjacent.
inline std::string two_balls_urdf() {
  const std::string ball = "<geometry><sphere radius='0.1'/></geometry>";
  return "<robot name='two_balls'>" + urdf_link("base", ball) +
         urdf_link("upper", "<origin xyz='0.25 0 0'/><geometry><sphere radius='0.05'/></geometry>") +
         urdf_link("lower") + urdf_link("tip", ball) +
         urdf_joint("shoulder", "revolute", "base", "upper", "0 0 0", "0 0 1") +
         urdf_joint("elbow", "revolute", "upper", "lower", "0.5 0 0", "0 0 1") +
         urdf_joint("flange", "fixed", "lower", "tip", "0.5 0 0", "0 0 1") + "</robot>";
}

/// A seven-joint arm of about 1 m on a short column, with primitive shapes and joint limits like an industrial arm's.
inline std::string seven_joint_urdf(const std::string& elbow_upper = "2.4") {
  const auto cylinder = [](const std::string& z, const std::string& radius, const std::string& length) {
    return "<origin xyz='0 0 " + z + "'/><geometry><cylinder radius='" + radius + "' length='" + length +
           "'/></geometry>";
  };
  return "<robot name='seven'>" +
         urdf_link("column", "<origin xyz='0 0 0.15'/><geometry><box size='0.2 0.2 0.3'/></geometry>") +
         urdf_link("l1") + urdf_link("l2", cylinder("0.2", "0.06", "0.3")) + urdf_link("l3") +
         urdf_link("l4", cylinder("0.2", "0.05", "0.28")) + urdf_link("l5") +
         urdf_link("l6", "<geometry><sphere radius='0.06'/></geometry>") +
         urdf_link("l7", "<origin xyz='0 0 0.1'/><geometry><box size='0.08 0.12 0.1'/></geometry>") +
         urdf_link("tool") + urdf_joint("j1", "revolute", "column", "l1", "0 0 0.36", "0 0 1", "-2.9", "2.9") +
         urdf_joint("j2", "revolute", "l1", "l2", "0 0 0", "0 1 0", "-1.9", "1.9") +
         urdf_joint("j3", "revolute", "l2", "l3", "0 0 0.4", "0 0 1", "-2.9", "2.9") +
         urdf_joint("j4", "revolute", "l3", "l4", "0 0 0", "0 1 0", "-2.4", elbow_upper) +
         urdf_joint("j5", "continuous", "l4", "l5", "0 0 0.4", "0 0 1") +
         urdf_joint("j6", "revolute", "l5", "l6", "0 0 0", "0 1 0", "-2.1", "2.1") +
         urdf_joint("j7", "continuous", "l6", "l7", "0 0 0", "0 0 1") +
         urdf_joint("flange", "fixed", "l7", "tool", "0 0 0.2", "0 0 1") + "</robot>";
}

}  // namespace mmgrasp::test
