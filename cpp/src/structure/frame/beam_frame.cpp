#include "mmgrasp/structure/beam_frame.hpp"

#include <cmath>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "structure/frame/beam_element.hpp"
#include "structure/node_pieces.hpp"

namespace mmgrasp {
namespace {

using detail::entry;
using Eigen::Vector3d;

/// Adds which entry broke a rule of a part. Texts are made only for what fails: searches check a frame for every grasp.
template <typename Check>
void check_part(std::size_t member, const char* part, const Check& check) {
  try {
    check();
  } catch (const InvalidInput& error) {
    throw InvalidInput(entry("members", member) + "." + part + "." + error.what());
  }
}

void check_members(const BeamFrame& frame) {
  const int count = static_cast<int>(frame.nodes.size());
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const BeamMember& member = frame.members[i];
    const auto [a, b] = member.nodes;
    const auto fail = [&, a = a, b = b](const std::string& rule) {
      const std::string value = "(" + std::to_string(a) + ", " + std::to_string(b) + ")";
      require(false, entry("members", i) + ".nodes", value, rule);
    };
    if (!(a >= 0 && b >= 0 && a < count && b < count))
      fail("must be indices of the " + std::to_string(count) + " nodes, from 0");
    if (!(frame.length(static_cast<int>(i)) >= BeamFrame::kShortest)) fail("its nodes must be at least 1e-6 m apart");
    for (std::size_t j = 0; j < i; ++j) {
      const auto [c, d] = frame.members[j].nodes;
      if ((a == c && b == d) || (a == d && b == c)) fail("joins the same nodes as " + entry("members", j));
    }
    check_part(i, "section", [&] { member.section.check(); });
    check_part(i, "material", [&] { member.material.check(); });
    if (member.material.stress_limit > 0 && !member.section.stresses_known()) {
      require(
          false, entry("members", i) + ".material.stress_limit", member.material.stress_limit,
          "must be zero for a section whose y_extent, z_extent or torsion_modulus is not given: its stresses are not "
          "known");
    }
    const Vector3d& y = member.y_towards;
    const Vector3d x = (frame.nodes[b] - frame.nodes[a]).normalized();
    if (y.allFinite() && (y.isZero(0) || x.cross(y).norm() > 1e-6 * y.norm())) continue;
    require(false, entry("members", i) + ".y_towards",
            "(" + std::to_string(y.x()) + ", " + std::to_string(y.y()) + ", " + std::to_string(y.z()) + ")",
            "must be a direction that does not run along the member, or zero");
  }
}

}  // namespace

void BeamFrame::check() const {
  require(!members.empty(), "members", "[]", "a frame has at least one member");
  for (std::size_t i = 0; i < nodes.size(); ++i) require_numbers(nodes[i], entry("nodes", i), "m");
  check_members(*this);
  std::vector<std::array<int, 2>> ends;
  for (const BeamMember& member : members) ends.push_back(member.nodes);
  detail::check_one_piece(nodes.size(), ends, "member", "frame");
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const NodeLoad& load = loads[i];
    require(load.node >= 0 && load.node < static_cast<int>(nodes.size()), entry("loads", i) + ".node", load.node,
            "must be one of the " + std::to_string(nodes.size()) + " nodes, from 0");
    require_not_negative(load.mass, entry("loads", i) + ".mass", "kg", kLargestNumber);
    require_numbers(load.force, entry("loads", i) + ".force", "N", kLargestNumber);
    require_numbers(load.moment, entry("loads", i) + ".moment", "N m", kLargestNumber);
  }
}

double BeamFrame::length(int member) const {
  return detail::member_length<double>(*this, member);
}

Eigen::Matrix3d BeamFrame::R_object_member(int member) const {
  return detail::member_axes<double>(*this, member);
}

double BeamFrame::mass() const {
  double sum = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    sum += members[i].material.density * members[i].section.area * length(static_cast<int>(i));
  }
  for (const NodeLoad& load : loads) sum += load.mass;
  return sum;
}

Vector3d BeamFrame::centre_of_mass() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < members.size(); ++i) {
    const auto [a, b] = members[i].nodes;
    const double weight = members[i].material.density * members[i].section.area * length(static_cast<int>(i));
    sum += weight * (nodes.at(a) + nodes.at(b)) / 2;
  }
  for (const NodeLoad& load : loads) sum += load.mass * nodes.at(load.node);
  const double total = mass();
  require(total > 0, "mass", total, "a frame without mass has no centre of mass");
  return sum / total;
}

BeamFrame BeamFrame::split(int member, double distance) const {
  require(member >= 0 && member < static_cast<int>(members.size()), "member", member,
          "must be one of the " + std::to_string(members.size()) + " members");
  const double whole = length(member);
  require(distance >= kShortest && distance <= whole - kShortest, "distance", distance,
          "must lie inside the member of " + std::to_string(whole) + " m");
  BeamFrame out = *this;
  const auto [a, b] = members[member].nodes;
  const int middle = static_cast<int>(nodes.size());
  out.nodes.emplace_back(nodes[a] + distance / whole * (nodes[b] - nodes[a]));
  out.members[member].y_towards =
      R_object_member(member).col(1);  // the rule for y must not see rounding of the new node
  out.members.push_back(out.members[member]);
  out.members[member].nodes = {a, middle};
  out.members.back().nodes = {middle, b};
  return out;
}

Eigen::MatrixXd BeamFrame::stiffness() const {
  check();
  const auto size = 6 * static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const int member = static_cast<int>(i);
    const detail::Matrix12<double> k =
        detail::BeamElement<double>(members[i], length(member), R_object_member(member)).stiffness_in_object();
    for (int p = 0; p < 2; ++p) {
      for (int q = 0; q < 2; ++q) {
        K.block<6, 6>(6 * members[i].nodes[p], 6 * members[i].nodes[q]) += k.block<6, 6>(6 * p, 6 * q);
      }
    }
  }
  return K;
}

BeamFrame beam_frame(const Pipe& pipe, double inner_diameter, const BeamMaterial& material) {
  pipe.check();
  BeamFrame frame;
  frame.nodes = pipe.nodes;
  for (std::size_t i = 0; i < pipe.sections.size(); ++i) {
    BeamMember member;
    member.nodes = pipe.sections[i];
    member.section = round_section(pipe.diameters[i], inner_diameter);
    member.material = material;
    frame.members.push_back(member);
  }
  frame.check();
  return frame;
}

}  // namespace mmgrasp
