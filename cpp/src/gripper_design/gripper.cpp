#include "mmgrasp/gripper_design/gripper.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp {
namespace {

using detail::kPi;

constexpr double kLongestPad = 0.02;  // [m]
constexpr double kDensity = 1240;     // Density of a printed plastic (PLA) [kg/m3].
constexpr double kGap = 1e-4;         // Between the flanks of closed centric fingers [m].

/// Half the finger's width at depth `x` behind the pad. Three fingers stay in sectors of 120 degrees, so that they do
/// not meet however far they are closed.
double half_width(const Gripper& g, double x) {
  const double whole = g.finger_width / 2;
  if (g.fingers == 2) return whole;
  return std::clamp((g.min_opening / 2 + x) * std::tan(kPi / 3) - kGap, 0.0, whole);
}

/// Corners of the finger across its length: x behind the pad, y across; counter-clockwise.
std::vector<Eigen::Vector2d> outline(const Gripper& g) {
  const double pad = half_width(g, 0), back = half_width(g, g.finger_thickness);
  std::vector<Eigen::Vector2d> right{{0, -pad}};
  if (pad < back) {
    const double depth = (back + kGap) / std::tan(kPi / 3) - g.min_opening / 2;  // Where it is as wide as at the back.
    if (pad == 0) right.front().x() = std::max(0.0, kGap / std::tan(kPi / 3) - g.min_opening / 2);
    if (!detail::at_most(g.finger_thickness, depth)) right.emplace_back(depth, -back);
  }
  right.emplace_back(g.finger_thickness, -back);
  std::vector<Eigen::Vector2d> all = right;
  for (auto p = right.rbegin(); p != right.rend(); ++p) {
    if (p->y() < 0) all.emplace_back(p->x(), -p->y());
  }
  return all;
}

std::string number(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(12);
  out << (std::abs(value) < 1e-15 ? 0.0 : value);
  return out.str();
}

std::string vector_text(double x, double y, double z) {
  return number(x) + " " + number(y) + " " + number(z);
}

/// About the centre of mass, which lies at y = 0; axes as the link's.
struct Inertia {
  double mass = 0, xx = 0, yy = 0, zz = 0;
  double x = 0, z = 0;  // Centre of mass [m].
};

/// A finger: its outline, symmetric about y = 0, drawn out along z.
Inertia finger_inertia(const Gripper& g) {
  const std::vector<Eigen::Vector2d> corners = outline(g);
  double area = 0, first = 0;
  Eigen::Vector2d second = Eigen::Vector2d::Zero();  // Moments of x^2 and y^2.
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double twice = a.x() * b.y() - b.x() * a.y();
    area += twice / 2;
    first += twice * (a.x() + b.x()) / 6;
    second += twice / 12 * (a.cwiseAbs2() + a.cwiseProduct(b) + b.cwiseAbs2());
  }
  const double l = g.finger_length, x = first / area;
  const double about_z = second.x() / area - x * x, about_x = second.y() / area;
  Inertia out;
  out.mass = kDensity * area * l;
  out.xx = out.mass * (about_x + l * l / 12);
  out.yy = out.mass * (about_z + l * l / 12);
  out.zz = out.mass * (about_x + about_z);
  out.x = x;
  out.z = l / 2;
  return out;
}

std::string inertial(const Inertia& i) {
  return "    <inertial>\n      <origin xyz=\"" + vector_text(i.x, 0, i.z) +
         "\" rpy=\"0 0 0\"/>\n      <mass value=\"" + number(i.mass) + "\"/>\n      <inertia ixx=\"" + number(i.xx) +
         "\" ixy=\"0\" ixz=\"0\" iyy=\"" + number(i.yy) + "\" iyz=\"0\" izz=\"" + number(i.zz) +
         "\"/>\n    </inertial>\n";
}

std::string shape(const std::string& kind, const std::string& geometry, double z) {
  return "    <" + kind + ">\n      <origin xyz=\"" + vector_text(0, 0, z) + "\" rpy=\"0 0 0\"/>\n      <geometry>" +
         geometry + "</geometry>\n    </" + kind + ">\n";
}

std::string both_shapes(const std::string& geometry, double z) {
  return shape("visual", geometry, z) + shape("collision", geometry, z);
}

std::string finger_name(int i) {
  return "finger_" + std::to_string(i + 1);
}

std::string finger_urdf(const Gripper& g, int i) {
  const double turn = detail::kTwoPi * i / g.fingers, closed = g.min_opening / 2;
  std::string out = "  <link name=\"" + finger_name(i) + "\">\n" + inertial(finger_inertia(g)) +
                    both_shapes("<mesh filename=\"finger.stl\" scale=\"0.001 0.001 0.001\"/>", 0) + "  </link>\n";
  out += "  <joint name=\"" + finger_name(i) +
         "_joint\" type=\"prismatic\">\n    <parent link=\"base\"/>\n    <child link=\"" + finger_name(i) +
         "\"/>\n    <origin xyz=\"" + vector_text(closed * std::cos(turn), closed * std::sin(turn), g.palm_height) +
         "\" rpy=\"" + vector_text(0, 0, turn) + "\"/>\n    <axis xyz=\"1 0 0\"/>\n    <limit lower=\"0\" upper=\"" +
         number((g.max_opening - g.min_opening) / 2) + "\" effort=\"" + number(g.max_force) + "\" velocity=\"" +
         number(g.max_speed) + "\"/>\n";
  if (i > 0) out += "    <mimic joint=\"" + finger_name(0) + "_joint\"/>\n";
  return out + "  </joint>\n";
}

std::string urdf(const Gripper& g) {
  const double r = g.palm_radius(), h = g.palm_height, mass = kDensity * kPi * r * r * h;
  const double across = mass * (3 * r * r + h * h) / 12;
  std::string out = "<?xml version=\"1.0\"?>\n<robot name=\"" + g.name + "\">\n  <link name=\"base\">\n" +
                    inertial({mass, across, across, mass * r * r / 2, 0, h / 2}) +
                    both_shapes("<cylinder radius=\"" + number(r) + "\" length=\"" + number(h) + "\"/>", h / 2) +
                    "  </link>\n";
  for (int i = 0; i < g.fingers; ++i) out += finger_urdf(g, i);
  return out + "  <link name=\"tool\"/>\n  <joint name=\"tool_joint\" type=\"fixed\">\n    <parent link=\"base\"/>\n" +
         "    <child link=\"tool\"/>\n    <origin xyz=\"" +
         vector_text(0, 0, h + g.finger_length - g.pad_length() / 2) + "\" rpy=\"0 0 0\"/>\n  </joint>\n</robot>\n";
}

std::string srdf(const Gripper& g) {
  std::string out = "<?xml version=\"1.0\"?>\n<robot name=\"" + g.name + "\">\n  <group name=\"fingers\">\n";
  for (int i = 0; i < g.fingers; ++i) out += "    <joint name=\"" + finger_name(i) + "_joint\"/>\n";
  out += "  </group>\n";
  const auto state = [&](const std::string& name, double value) {
    out += "  <group_state name=\"" + name + "\" group=\"fingers\">\n    <joint name=\"" + finger_name(0) +
           "_joint\" value=\"" + number(value) + "\"/>\n  </group_state>\n";
  };
  state("open", (g.max_opening - g.min_opening) / 2);
  state("closed", 0);
  out += "  <end_effector name=\"gripper\" parent_link=\"base\" group=\"fingers\"/>\n";
  // Fingers slide on the palm, and closed ones may stand flank to flank.
  for (int i = 0; i < g.fingers; ++i) {
    out += "  <disable_collisions link1=\"base\" link2=\"" + finger_name(i) + "\" reason=\"Adjacent\"/>\n";
    for (int k = i + 1; k < g.fingers; ++k) {
      out += "  <disable_collisions link1=\"" + finger_name(i) + "\" link2=\"" + finger_name(k) +
             "\" reason=\"Default\"/>\n";
    }
  }
  return out + "</robot>\n";
}

template <class T>
void append(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

/// A binary STL in millimetres, which programs for printers take it to be in.
std::string stl_to_print(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  append(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    for (const Eigen::Vector3d* v : {&normal, &a, &b, &c}) {
      const double unit = v == &normal ? 1 : 1000;
      for (int axis = 0; axis < 3; ++axis) append(out, static_cast<float>(unit * (*v)[axis]));
    }
    append(out, std::uint16_t{0});
  }
  return out;
}

}  // namespace

void Gripper::check() const {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; };
  require(!name.empty() && std::all_of(name.begin(), name.end(), allowed), "name", "'" + name + "'",
          "must be made of letters, digits, '_', '-' and '.'");
  require(fingers == 2 || fingers == 3, "fingers", fingers, "must be 2 or 3");
  require_not_negative(min_opening, "min_opening", "m");
  require_number(max_opening, "max_opening", "m");
  require(max_opening > min_opening, "max_opening", max_opening, "must be above min_opening [m]");
  const auto positive = [](const char* field, double value) { require_positive(value, field); };
  positive("finger_length", finger_length);
  positive("finger_width", finger_width);
  positive("finger_thickness", finger_thickness);
  positive("palm_height", palm_height);
  positive("max_force", max_force);
  positive("max_speed", max_speed);
}

bool Gripper::holds(const SegmentRequirement& requirement) const {
  using detail::at_most;
  return requirement.fingers == fingers && at_most(min_opening, requirement.opening) &&
         at_most(requirement.least_min_opening, min_opening) && at_most(requirement.opening, max_opening) &&
         at_most(max_opening - min_opening, requirement.max_stroke) &&
         at_most(requirement.min_finger_length, finger_length) && at_most(finger_length, requirement.max_finger_length);
}

double Gripper::pad_length() const {
  return std::min(kLongestPad, finger_length);
}

double Gripper::pad_width() const {
  return 2 * half_width(*this, 0);
}

double Gripper::palm_radius() const {
  return std::hypot(max_opening / 2 + finger_thickness, finger_width / 2);
}

Hand Gripper::hand() const {
  check();
  require(fingers == 2, "fingers", fingers, "must be 2: a hand has pads that stand opposite each other");
  Hand hand;
  hand.tool_link = "tool";
  hand.approach = Eigen::Vector3d::UnitZ();
  hand.closing = Eigen::Vector3d::UnitX();
  hand.min_opening = min_opening;
  hand.max_opening = max_opening;
  hand.finger_depth = pad_length();
  hand.finger_width = finger_width;
  hand.joints = {{finger_name(0) + "_joint", 0.0, (max_opening - min_opening) / 2}};  // the other finger mimics it
  hand.finger_links = {finger_name(0), finger_name(1)};
  hand.body = {finger_thickness, finger_length, 2 * palm_radius(), 2 * palm_radius()};
  return hand;
}

std::shared_ptr<const TriangleMesh> Gripper::finger_mesh() const {
  check();
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& p : outline(*this)) {
    for (const double z : {0.0, finger_length}) corners.emplace_back(p.x(), p.y(), z);
  }
  return convex_hull(corners);
}

std::map<std::string, std::string> Gripper::files() const {
  check();
  return {{"gripper.urdf", urdf(*this)}, {"gripper.srdf", srdf(*this)}, {"finger.stl", stl_to_print(*finger_mesh())}};
}

void Gripper::to_urdf(const std::string& folder) const {
  const auto texts = files();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError("gripper '" + folder + "': cannot make the folder: " + error.message());
  for (const auto& [file, text] : texts) {
    detail::write_file((std::filesystem::path(folder) / file).string(), "gripper", {text});
  }
}

}  // namespace mmgrasp
