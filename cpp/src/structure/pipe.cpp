#include "mmgrasp/structure/pipe.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "structure/node_pieces.hpp"
#include "structure/section_axes.hpp"

namespace mmgrasp {
using detail::entry;
using Eigen::Vector3d;

void Pipe::check() const {
  require(!sections.empty(), "sections", "[]", "a pipe has at least one section");
  require(diameters.size() == sections.size(), "diameters", std::to_string(diameters.size()) + " values",
          "must be one for each of the " + std::to_string(sections.size()) + " sections");
  for (std::size_t i = 0; i < nodes.size(); ++i) require_numbers(nodes[i], entry("nodes", i), "m");
  const int count = static_cast<int>(nodes.size());
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const auto [a, b] = sections[i];
    const std::string value = "(" + std::to_string(a) + ", " + std::to_string(b) + ")";
    require(a >= 0 && b >= 0 && a < count && b < count, entry("sections", i), value,
            "must be indices of the " + std::to_string(count) + " nodes, from 0");
    require(length(static_cast<int>(i)) >= kShortest * (1 - 1e-9), entry("sections", i), value,
            "its nodes must be at least 0.001 m apart");
    for (std::size_t j = 0; j < i; ++j) {
      const auto [c, d] = sections[j];
      require(!((a == c && b == d) || (a == d && b == c)), entry("sections", i), value,
              "joins the same nodes as " + entry("sections", j));
    }
    require_length(diameters[i], entry("diameters", i));
  }
  detail::check_one_piece(nodes.size(), sections, "section", "pipe");
}

double Pipe::length(int section) const {
  const auto [a, b] = sections.at(section);
  return (nodes.at(b) - nodes.at(a)).norm();
}

Pose Pipe::T_object_section(int section) const {
  const auto [a, b] = sections.at(section);
  Pose T = Pose::Identity();
  T.linear() = detail::section_axes(nodes.at(b) - nodes.at(a));
  T.translation() = nodes.at(a);
  return T;
}

Vector3d Pipe::centre_of_mass() const {
  Vector3d sum = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double weight = length(static_cast<int>(i)) * diameters.at(i);
    sum += weight * (nodes.at(sections[i][0]) + nodes.at(sections[i][1])) / 2;
    mass += weight;
  }
  return sum / mass;
}

std::vector<LinkShape> Pipe::shapes(PipeEnds ends) const {
  check();
  std::vector<LinkShape> out;
  std::vector<int> meeting(nodes.size(), 0);
  std::vector<double> widest(nodes.size(), 0.0);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const double along = length(static_cast<int>(i)), radius = diameters[i] / 2;
    Pose T = T_object_section(static_cast<int>(i));
    T = T * Eigen::Translation3d(along / 2, 0, 0) *
        Eigen::AngleAxisd(detail::kPi / 2, Vector3d::UnitY());  // the shapes' z along the section's x
    LinkShape shape;
    shape.shape = ends == PipeEnds::round ? Shape(Capsule{radius, along}) : Shape(Cylinder{radius, along});
    shape.T_link_shape = T;
    out.push_back(shape);
    for (const int node : sections[i]) {
      ++meeting[node];
      widest[node] = std::max(widest[node], radius);
    }
  }
  if (ends == PipeEnds::round) return out;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (meeting[i] < 2) continue;
    LinkShape joint_sphere;
    joint_sphere.shape = Sphere{widest[i]};
    joint_sphere.T_link_shape.translation() = nodes[i];
    out.push_back(joint_sphere);
  }
  return out;
}

}  // namespace mmgrasp
