#include "mmgrasp/structure/supported_frame.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "structure/frame/beam_element.hpp"
#include "structure/frame/beam_solve.hpp"
#include "structure/frame/load_balance.hpp"
#include "structure/frame/longest_point.hpp"
#include "structure/frame/wide.hpp"

namespace mmgrasp {
namespace {

using detail::Curve;
using detail::Vector12d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr int kLoads = 4;  // gravity of 1 m/s2 along x, y, z, and what is fixed in the object's frame
/// Factors of the four loads under a gravity.
Eigen::Vector4d factors(const Vector3d& gravity) {
  require_numbers(gravity, "gravity", "m/s2");
  return {gravity.x(), gravity.y(), gravity.z(), 1};
}

/// A part of a member between nodes and supports.
struct Piece {
  int member = 0;
  double from = 0, to = 0;  ///< On the member [m].
  std::array<int, 2> nodes{};
  Eigen::Matrix3d R_object_member;
  double line_density = 0;  ///< [kg/m]
  std::array<Curve, kLoads> curves{};
  Eigen::Matrix<double, 12, kLoads> end_forces{};  ///< What the nodes do to its ends, in the member's frame.

  double length() const { return to - from; }
};

}  // namespace

struct SupportedFrame::Data {
  BeamFrame frame;
  std::vector<Piece> pieces;  ///< Member by member, along each.
  std::vector<int> support_nodes;
  MatrixXd displacements;  ///< 6 x nodes (the supports' after the frame's) rows, a column for each load.
  MatrixXd reactions;      ///< 6 x supports rows.

  void divide(const std::vector<BeamSupport>& supports);
  /// False when the frame can move, or its answer is lost, as far as `Scalar` can tell.
  template <class Scalar>
  bool solve(const std::vector<BeamSupport>& supports);
  const Piece& piece(int member, double distance) const;
  BeamExtreme longest(const Eigen::Vector4d& load) const;
  double stress(const Piece& piece, const Vector12d& end_forces, const Vector3d& weight, double x) const;
  void find_stress(const Eigen::Vector4d& load, const Vector3d& gravity, BeamState& state) const;
};

BeamSupport beam_support(const Grasp& grasp) {
  const auto* place = std::get_if<PipeProvenance>(&grasp.provenance);
  require(place != nullptr, "grasp.provenance", "of another kind", "must say section and length on a pipe");
  return {place->section, place->length, {true, true, true, true, true, true}};
}

Vector3d gravity_in_object(const Pose& T_world_object, double gravity) {
  require_not_negative(gravity, "gravity", "m/s2");
  return -gravity * T_world_object.linear().row(2).transpose();
}

BeamState BeamFrame::deflection(const Grasp& grasp, const Pose& T_world_object, double gravity) const {
  return deflection({beam_support(grasp)}, T_world_object, gravity);
}

BeamState BeamFrame::deflection(const std::vector<BeamSupport>& supports, const Pose& T_world_object,
                                double gravity) const {
  return SupportedFrame(*this, supports).state(gravity_in_object(T_world_object, gravity));
}

SupportedFrame::SupportedFrame(const BeamFrame& frame, const std::vector<BeamSupport>& supports) {
  frame.check();
  auto data = std::make_shared<Data>();
  data->frame = frame;
  data->divide(supports);
  require(data->solve<double>(supports) || data->solve<detail::Wide>(supports), "supports", "unstable",
          "they leave the frame movable, or hold it by members 1e20 times softer than others; clamp it, or hinder all "
          "six movements together");
  data_ = data;
}

void SupportedFrame::Data::divide(const std::vector<BeamSupport>& supports) {
  const int members = static_cast<int>(frame.members.size());
  std::vector<std::vector<std::pair<double, int>>> cuts(members);  // distance and node
  int nodes = static_cast<int>(frame.nodes.size());
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const BeamSupport& support = supports[i];
    if (!(support.member >= 0 && support.member < members)) {
      require(false, "supports[" + std::to_string(i) + "].member", support.member,
              "must be one of the " + std::to_string(members) + " members, from 0");
    }
    const double length = frame.length(support.member), at = support.distance;
    if (!(at >= 0 && at <= length + BeamFrame::kShortest)) {
      require(false, "supports[" + std::to_string(i) + "].distance", at,
              "must lie on the member of " + std::to_string(length) + " m");
    }
    int node = -1;
    if (at < BeamFrame::kShortest) node = frame.members[support.member].nodes[0];
    if (length - at < BeamFrame::kShortest) node = frame.members[support.member].nodes[1];
    for (const auto& [other, taken] : cuts[support.member]) {
      if (std::abs(other - at) < BeamFrame::kShortest) node = taken;
    }
    if (node < 0) {
      node = nodes++;
      cuts[support.member].emplace_back(at, node);
    }
    require(std::find(support_nodes.begin(), support_nodes.end(), node) == support_nodes.end(),
            "supports[" + std::to_string(i) + "]", "at the place of another", "two supports must not share a place");
    support_nodes.push_back(node);
  }
  for (int i = 0; i < members; ++i) {
    std::sort(cuts[i].begin(), cuts[i].end());
    cuts[i].emplace_back(frame.length(i), frame.members[i].nodes[1]);
    std::pair<double, int> last{0, frame.members[i].nodes[0]};
    for (const auto& cut : cuts[i]) {
      const BeamMember& member = frame.members[i];
      pieces.push_back({i,
                        last.first,
                        cut.first,
                        {last.second, cut.second},
                        frame.R_object_member(i),
                        member.material.density * member.section.area});
      last = cut;
    }
  }
  displacements = MatrixXd::Zero(6 * nodes, kLoads);
}

template <class Scalar>
bool SupportedFrame::Data::solve(const std::vector<BeamSupport>& supports) {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  const auto weight = [](const Piece& piece, int load) -> Vector3 {
    return load < 3 ? Vector3(Scalar(piece.line_density) * Vector3::Unit(load)) : Vector3(Vector3::Zero());
  };
  const auto nodes = static_cast<std::size_t>(displacements.rows() / 6);
  std::vector<Vector3> places(nodes);
  for (std::size_t i = 0; i < frame.nodes.size(); ++i) places[i] = frame.nodes[i].cast<Scalar>();
  detail::BeamEquations<Scalar> equations(static_cast<int>(displacements.rows()), kLoads);
  for (const NodeLoad& load : frame.loads) {
    for (int axis = 0; axis < 3; ++axis) equations.loads(6 * load.node + axis, axis) += load.mass;
    equations.loads.template block<3, 1>(6 * load.node, 3) += load.force.cast<Scalar>();
    equations.loads.template block<3, 1>(6 * load.node + 3, 3) += load.moment.cast<Scalar>();
  }
  auto forces = (-equations.loads).eval();  // what holds the nodes
  std::vector<detail::BeamElement<Scalar>> elements;
  std::vector<Eigen::Matrix<Scalar, 3, 3>> axes;
  for (const Piece& piece : pieces) {
    const BeamMember& member = frame.members[piece.member];
    axes.push_back(detail::member_axes<Scalar>(frame, piece.member));
    const bool last = piece.nodes[1] == member.nodes[1];
    const Scalar end = last ? detail::member_length<Scalar>(frame, piece.member) : Scalar(piece.to);
    if (!last) places[piece.nodes[1]] = places[member.nodes[0]] + end * axes.back().col(0);
    elements.emplace_back(member, end - Scalar(piece.from), axes.back());
    equations.add(elements.back().stiffness_in_object(), piece.nodes);
    for (int axis = 0; axis < 3; ++axis) {
      const detail::Vector12<Scalar> loads = elements.back().end_loads(weight(piece, axis));
      for (int k = 0; k < 2; ++k)
        equations.loads.template block<6, 1>(6 * piece.nodes[k], axis) += loads.template segment<6>(6 * k);
    }
  }
  std::vector<bool> fixed(displacements.rows(), false);
  for (std::size_t i = 0; i < supports.size(); ++i) {
    for (int k = 0; k < 6; ++k)
      fixed[6 * support_nodes[i] + k] = fixed[6 * support_nodes[i] + k] || supports[i].fixed[k];
  }
  const auto moved = equations.solve(fixed);
  if (!moved) return false;
  displacements = moved->template cast<double>();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Piece& piece = pieces[i];
    for (int load = 0; load < kLoads; ++load) {
      detail::Vector12<Scalar> ends;
      for (int k = 0; k < 2; ++k)
        ends.template segment<6>(6 * k) = moved->template block<6, 1>(6 * piece.nodes[k], load);
      piece.curves[load] = elements[i].displacement(ends, weight(piece, load));
      const detail::Vector12<Scalar> at_ends = elements[i].end_forces(ends, weight(piece, load));
      piece.end_forces.col(load) = at_ends.template cast<double>();
      for (int k = 0; k < 4; ++k) {
        forces.template block<3, 1>(6 * piece.nodes[k / 2] + 3 * (k % 2), load) +=
            axes[i] * at_ends.template segment<3>(3 * k);
      }
    }
  }
  reactions = MatrixXd::Zero(6 * static_cast<Eigen::Index>(supports.size()), kLoads);
  bool balanced = true;
  for (int load = 0; load < kLoads; ++load) {
    detail::LoadBalance<Scalar> balance;
    for (std::size_t i = 0; i < nodes; ++i)
      balance.add(places[i] - places[support_nodes[0]],
                  equations.loads.template block<6, 1>(6 * static_cast<long>(i), load));
    for (std::size_t i = 0; i < supports.size(); ++i) {
      Eigen::Matrix<Scalar, 6, 1> held = forces.template block<6, 1>(6 * support_nodes[i], load);
      for (int k = 0; k < 6; ++k) {
        if (!supports[i].fixed[k]) held(k) = Scalar(0);
      }
      reactions.block<6, 1>(6 * static_cast<long>(i), load) = held.template cast<double>();
      balance.add(places[support_nodes[i]] - places[support_nodes[0]], held);
    }
    balanced = balanced && balance.holds();
  }
  return balanced;
}

const Piece& SupportedFrame::Data::piece(int member, double distance) const {
  require(member >= 0 && member < static_cast<int>(frame.members.size()), "member", member,
          "must be one of the " + std::to_string(frame.members.size()) + " members, from 0");
  const double length = frame.length(member);
  require(distance >= 0 && distance <= length * (1 + 1e-12), "distance", distance,
          "must lie on the member of " + std::to_string(length) + " m");
  const Piece* found = nullptr;
  for (const Piece& piece : pieces) {
    if (piece.member == member && (found == nullptr || piece.from <= distance)) found = &piece;
  }
  return *found;
}

BeamExtreme SupportedFrame::Data::longest(const Eigen::Vector4d& load) const {
  std::vector<Curve> curves;
  curves.reserve(pieces.size());
  detail::LongestPoint best;
  BeamExtreme out;
  for (const Piece& piece : pieces) {
    Curve curve = load(0) * piece.curves[0];
    for (int k = 1; k < kLoads; ++k) curve += load(k) * piece.curves[k];
    curves.push_back(curve);
  }
  const auto place = [&](std::size_t i, double at) {
    out.member = pieces[i].member;
    out.distance = pieces[i].from + at * pieces[i].length();
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {  // ends first: they are mostly the largest and spare the rest
    for (const int end : {0, 4}) {
      const double squared = curves[i].col(end).squaredNorm();
      if (squared <= best.squared) continue;
      best = {squared, end / 4.0};
      place(i, best.at);
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (detail::raise_to_longest(curves[i], best)) place(i, best.at);
  }
  out.value = std::sqrt(best.squared);
  return out;
}

double SupportedFrame::Data::stress(const Piece& piece, const Vector12d& end_forces, const Vector3d& weight,
                                    double x) const {
  const BeamSection& section = frame.members[piece.member].section;
  const Vector6d cut = detail::section_forces(end_forces, piece.R_object_member, weight, x);
  const double about_y = std::abs(cut(4)) * section.z_extent / section.iy;
  const double about_z = std::abs(cut(5)) * section.y_extent / section.iz;
  const double bending = section.round ? std::hypot(about_y, about_z) : about_y + about_z;
  const double normal = std::abs(cut(0)) / section.area + bending, shear = cut(3) / section.torsion_modulus;
  return std::sqrt(normal * normal + 3 * shear * shear);
}

void SupportedFrame::Data::find_stress(const Eigen::Vector4d& load, const Vector3d& gravity, BeamState& state) const {
  constexpr int kSteps = 32;
  const auto raise = [](std::optional<BeamExtreme>& best, double value, const Piece& piece, double x) {
    if (!best || value > best->value) best = BeamExtreme{value, piece.member, piece.from + x};
  };
  for (const Piece& piece : pieces) {
    if (!frame.members[piece.member].section.stresses_known()) continue;
    const Vector3d weight = piece.line_density * gravity;
    const Vector12d at_ends = piece.end_forces * load;
    const double length = piece.length();
    const auto value = [&](double x) { return stress(piece, at_ends, weight, x); };
    int top = 0;
    double largest = value(0);
    for (int i = 1; i <= kSteps; ++i) {
      const double here = value(length * i / kSteps);
      if (here <= largest) continue;
      largest = here;
      top = i;
    }
    double low = length * std::max(0, top - 1) / kSteps, high = length * std::min(kSteps, top + 1) / kSteps;
    double x = length * top / kSteps;
    for (int i = 0; i < 30; ++i) {  // golden section around the largest of the steps
      const double a = high - 0.6180339887498949 * (high - low), b = low + 0.6180339887498949 * (high - low);
      const bool rises = value(a) < value(b);
      (rises ? low : high) = rises ? a : b;
    }
    if (value((low + high) / 2) > largest) {
      x = (low + high) / 2;
      largest = value(x);
    }
    raise(state.stress, largest, piece, x);
    const double limit = frame.members[piece.member].material.stress_limit;
    if (limit > 0) raise(state.over_limit, largest / limit, piece, x);
  }
}

BeamState SupportedFrame::state(const Vector3d& gravity) const {
  const Eigen::Vector4d load = factors(gravity);
  const auto nodes = static_cast<Eigen::Index>(data_->frame.nodes.size());
  const auto supports = static_cast<Eigen::Index>(data_->support_nodes.size());
  BeamState state;
  const Eigen::VectorXd moved = data_->displacements * load, held = data_->reactions * load;
  state.nodes = Eigen::Map<const MatrixXd>(moved.data(), 6, nodes);
  state.reactions = Eigen::Map<const MatrixXd>(held.data(), 6, supports);
  state.displacement = data_->longest(load);
  data_->find_stress(load, gravity, state);
  return state;
}

BeamExtreme SupportedFrame::largest_displacement(const Vector3d& gravity) const {
  return data_->longest(factors(gravity));
}

Vector3d SupportedFrame::displacement(const Vector3d& gravity, int member, double distance) const {
  const Eigen::Vector4d load = factors(gravity);
  const Piece& piece = data_->piece(member, distance);
  const double t = std::clamp((distance - piece.from) / piece.length(), 0.0, 1.0), s = 1 - t;
  Eigen::Matrix<double, 5, 1> basis;
  basis << s * s * s * s, 4 * t * s * s * s, 6 * t * t * s * s, 4 * t * t * t * s, t * t * t * t;
  Vector3d out = Vector3d::Zero();
  for (int k = 0; k < kLoads; ++k) out += load(k) * (piece.curves[k] * basis);
  return out;
}

Vector6d SupportedFrame::section_forces(const Vector3d& gravity, int member, double distance) const {
  const Piece& piece = data_->piece(member, distance);
  const Vector3d weight = piece.line_density * gravity;
  return detail::section_forces(piece.end_forces * factors(gravity), piece.R_object_member, weight,
                                distance - piece.from);
}

}  // namespace mmgrasp
