#include "grasp/synthesis/evaluate_grasp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr int kOpenings = 32;        // intervals of the table of openings
constexpr double kPathStep = 0.01;   // between places on the way in that are checked [m]
constexpr double kPlaced = 5e-4;     // pads this near to where they should be are there [m]
constexpr int kRounds = 12;          // of moving finger by finger
constexpr double kShareStep = 0.02;  // for the pads' speed by finite differences
constexpr double kSteep = 0.3;       // least share of an approach that leads down, of those that the table ends
constexpr double kClear = 1e-4;      // left above the table, for roundings and what centring changes [m]

Vector3d pad_direction(const FingerPad& pad) {
  return pad.T_hand_pad.linear().col(2);
}

/// The rotation that takes the orthonormal pair (a, b) to (to_a, to_b); b is made orthogonal first.
Eigen::Matrix3d rotation_between(const Vector3d& a, const Vector3d& b, const Vector3d& to_a, const Vector3d& to_b) {
  const auto frame = [](const Vector3d& x, const Vector3d& y) {
    Eigen::Matrix3d R;
    const Vector3d second = (y - y.dot(x) * x).normalized();
    R << x, second, x.cross(second);
    return R;
  };
  return frame(to_a, to_b) * frame(a, b).transpose();
}

}  // namespace

GraspEvaluator::GraspEvaluator(const ProbabilisticSdf& map, const HandModel& hand, const MapSurface& surface,
                               const SynthesisOptions& options)
    : map_(map),
      hand_(hand),
      surface_(surface),
      options_(options),
      clearance_(surface.scene, surface.scene_normal, surface.scene_sigma, options.sigmas,
                 std::max(options.margin, 0.75 * map.options().voxel), options.table) {
  for (int k = 0; k <= kOpenings; ++k)
    openings_.push_back(opening_at(std::vector<double>(hand.groups(), 1.0 * k / kOpenings)));
  // Fingers that pass each other while they close are closed where they meet.
  openings_.front() = std::max(0.0, openings_.front());
  for (std::size_t k = 1; k < openings_.size(); ++k) openings_[k] = std::max(openings_[k], openings_[k - 1]);
  require(openings_.back() > openings_.front(), "hand", openings_.back(), "its pads do not move apart [m]");
}

double GraspEvaluator::opening_at(const std::vector<double>& shares) const {
  return closing_line(hand_.pads(shares)).opening;
}

std::vector<double> GraspEvaluator::shares_at(double opening) const {
  const auto above = std::lower_bound(openings_.begin(), openings_.end(), opening);
  double share = 1;
  if (above == openings_.begin()) {
    share = 0;
  } else if (above != openings_.end()) {
    const double low = *(above - 1);
    share = (static_cast<double>(above - 1 - openings_.begin()) + (opening - low) / (*above - low)) / kOpenings;
  }
  return std::vector<double>(hand_.groups(), share);
}

EvaluatedGrasp GraspEvaluator::place(const Vector3d& middle, const Vector3d& axis, const Vector3d& approach,
                                     double width) const {
  EvaluatedGrasp grasp;
  grasp.shares = shares_at(std::min(width + 2 * hand_.hand().clearance, largest_opening()));
  const ClosingLine line = closing_line(hand_.pads(grasp.shares));
  grasp.T_world_hand.linear() = rotation_between(line.axis, hand_.hand().approach, axis, approach);
  grasp.T_world_hand.translation() = middle - grasp.T_world_hand.linear() * line.middle;
  draw_back(grasp);
  return grasp;
}

Vector3d GraspEvaluator::closing_axis(const EvaluatedGrasp& grasp) const {
  return grasp.T_world_hand.linear() * closing_line(hand_.pads(grasp.shares)).axis;
}

Vector3d GraspEvaluator::approach(const EvaluatedGrasp& grasp) const {
  return grasp.T_world_hand.linear() * hand_.hand().approach;
}

Verdict GraspEvaluator::cast(const EvaluatedGrasp& grasp, std::vector<ContactPatch>& patches) const {
  const std::vector<FingerPad> pads = hand_.pads(grasp.shares);
  const double reach = closing_line(pads).opening;
  const Eigen::Index each = static_cast<Eigen::Index>(options_.patch.rays) * options_.patch.rays;
  PadRays all;
  all.origins.resize(3, each * static_cast<Eigen::Index>(pads.size()));
  all.directions.resize(3, all.origins.cols());
  for (std::size_t k = 0; k < pads.size(); ++k) {
    const PadRays rays = pad_rays(pads[k], grasp.T_world_hand, options_.patch);
    all.origins.middleCols(static_cast<Eigen::Index>(k) * each, each) = rays.origins;
    all.directions.middleCols(static_cast<Eigen::Index>(k) * each, each) = rays.directions;
  }
  const SdfHits hits = map_.cast_rays(all.origins, all.directions, 1);
  patches.assign(pads.size(), {});
  Verdict verdict = Verdict::good;
  for (std::size_t k = 0; k < pads.size(); ++k) {
    const Eigen::Index first = static_cast<Eigen::Index>(k) * each;
    SdfHits own;
    own.hit.assign(hits.hit.begin() + first, hits.hit.begin() + first + each);
    own.distance = hits.distance.segment(first, each);
    own.point = hits.point.middleCols(first, each);
    own.sigma = hits.sigma.segment(first, each);
    switch (fit_contact_patch(own, all.directions.col(first), reach, patches[k], options_.patch)) {
      case PatchState::missed:
        return Verdict::missed;
      case PatchState::uneven:
        verdict = Verdict::uneven;
        break;
      case PatchState::found:
        break;
    }
  }
  return verdict;
}

/// Pads move along their own rays: where they end up needs no new ones.
void GraspEvaluator::centre_parallel(EvaluatedGrasp& grasp) const {
  std::vector<ContactPatch>& patches = grasp.patches;
  const double opening = opening_at(grasp.shares), width = opening - patches[0].distance - patches[1].distance;
  const double wanted = std::min(width + 2 * hand_.hand().clearance, largest_opening());
  const Vector3d axis = closing_axis(grasp);
  grasp.T_world_hand.translation() += (patches[0].distance - patches[1].distance) / 2 * axis;
  grasp.shares = shares_at(wanted);
  for (ContactPatch& patch : patches) {
    const double moved = (wanted - width) / 2 - patch.distance;
    patch.distance += moved;
    patch.nearest += moved;
  }
}

std::vector<double> GraspEvaluator::moved_fingers(const EvaluatedGrasp& grasp,
                                                  const std::vector<double>& errors) const {
  const std::vector<int> group = hand_.group_of_pad();
  const std::vector<FingerPad> here = hand_.pads(grasp.shares);
  std::vector<double> shares = grasp.shares;
  for (int g = 0; g < hand_.groups(); ++g) {
    // Towards the middle of the range, so that the finite difference stays inside.
    std::vector<double> near = grasp.shares;
    const double step = grasp.shares[g] > 0.5 ? -kShareStep : kShareStep;
    near[g] += step;
    const std::vector<FingerPad> there = hand_.pads(near);
    double speed = 0, error = 0;
    int count = 0;
    for (std::size_t k = 0; k < here.size(); ++k) {
      if (group[k] != g) continue;
      speed +=
          (there[k].T_hand_pad.translation() - here[k].T_hand_pad.translation()).dot(pad_direction(here[k])) / step;
      error += errors[k];
      ++count;
    }
    if (count == 0 || std::abs(speed) < 1e-6) continue;
    shares[g] = std::clamp(shares[g] + std::clamp(error / speed, -0.2, 0.2), 0.0, 1.0);
  }
  return shares;
}

/// P3 4.6.3: fingers close until they are at the wanted distance, and the hand shifts by half of what the two sides
/// differ.
Verdict GraspEvaluator::centre_by_finger(EvaluatedGrasp& grasp) const {
  const double wanted = hand_.hand().clearance;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<FingerPad> pads = hand_.pads(grasp.shares);
    std::vector<Vector3d> pushes;
    for (const FingerPad& pad : pads) pushes.push_back(pad_direction(pad));
    const std::vector<int> sides = opposed_sides(pushes);
    const Vector3d axis = closing_line(pads).axis;
    std::vector<double> errors;
    double side[2] = {0, 0}, rate[2] = {0, 0}, worst = 0;
    int count[2] = {0, 0};
    for (std::size_t k = 0; k < pads.size(); ++k) {
      errors.push_back(grasp.patches[k].distance - wanted);
      worst = std::max(worst, std::abs(errors[k]));
      side[sides[k]] += errors[k];
      rate[sides[k]] += axis.dot(pushes[k]);
      ++count[sides[k]];
    }
    if (worst < kPlaced) break;
    const double shift = (side[0] / count[0] - side[1] / count[1]) / (rate[0] / count[0] - rate[1] / count[1]);
    for (std::size_t k = 0; k < pads.size(); ++k) errors[k] -= shift * axis.dot(pushes[k]);
    grasp.T_world_hand.translation() += shift * (grasp.T_world_hand.linear() * axis);
    const std::vector<double> before = grasp.shares;
    grasp.shares = moved_fingers(grasp, errors);
    const Verdict verdict = cast(grasp, grasp.patches);
    if (verdict != Verdict::good) return verdict;
    if (before == grasp.shares && std::abs(shift) < kPlaced) break;  // open or closed as far as it goes
  }
  return Verdict::good;
}

void GraspEvaluator::rate(EvaluatedGrasp& grasp) const {
  grasp.success = evaluate_success(grasp.patches, surface_.extent, hand_.hand().clearance, options_.success);
  grasp.verdict = grasp.success.certainty <= 0     ? Verdict::uncertain
                  : grasp.success.probability <= 0 ? Verdict::slipping
                                                   : Verdict::good;
}

void GraspEvaluator::evaluate(EvaluatedGrasp& grasp) const {
  grasp.success = {};
  grasp.verdict = cast(grasp, grasp.patches);
  if (grasp.verdict != Verdict::good) return;
  if (hand_.parallel()) {
    centre_parallel(grasp);
  } else {
    grasp.verdict = centre_by_finger(grasp);
    if (grasp.verdict != Verdict::good) return;
  }
  rate(grasp);
  if (grasp.verdict != Verdict::good) return;
  const HandContact contact = clearance_.check(hand_.boxes(grasp.shares), grasp.T_world_hand);
  if (contact == HandContact::map) grasp.verdict = Verdict::collision;
  if (contact == HandContact::table) grasp.verdict = Verdict::table;
}

void GraspEvaluator::confirm(EvaluatedGrasp& grasp) const {
  grasp.verdict = cast(grasp, grasp.patches);
  if (grasp.verdict != Verdict::good) return;
  rate(grasp);
  if (grasp.verdict != Verdict::good) return;
  const std::vector<LinkShape> boxes = hand_.boxes(grasp.shares);
  const Vector3d in = approach(grasp);
  const int steps = static_cast<int>(std::ceil(options_.approach_distance / kPathStep));
  for (int k = steps; k >= 0 && grasp.verdict == Verdict::good; --k) {
    Pose T = grasp.T_world_hand;
    if (steps > 0) T.translation() -= options_.approach_distance * k / steps * in;
    const HandContact contact = clearance_.check(boxes, T);
    if (contact == HandContact::map) grasp.verdict = Verdict::collision;
    if (contact == HandContact::table) grasp.verdict = Verdict::table;
  }
  if (grasp.verdict != Verdict::good) return;
  std::vector<double> closed;
  if (hand_.parallel()) {
    const double width = opening_at(grasp.shares) - grasp.patches[0].nearest - grasp.patches[1].nearest;
    if (width < smallest_opening()) {
      grasp.verdict = Verdict::missed;
      return;
    }
    closed = shares_at(width);
  } else {
    closed = holding_shares(grasp);
  }
  const std::vector<LinkShape> holding = hand_.boxes(closed);
  if (clearance_.in_table(holding, grasp.T_world_hand) > 0) {
    grasp.verdict = Verdict::table;  // fingertips that swing go down as they close
  } else if (clearance_.pierced(holding, grasp.T_world_hand, options_.patch.plane_tolerance)) {
    grasp.verdict = Verdict::collision;  // something beside the pads keeps them from closing
  }
}

EvaluatedGrasp GraspEvaluator::shifted(const EvaluatedGrasp& from, double radius, bool turned, Rng& rng) const {
  EvaluatedGrasp grasp;
  grasp.T_world_hand = from.T_world_hand;
  grasp.shares = from.shares;
  Vector3d axis = closing_axis(from);
  if (turned) {
    Vector3d side[2] = {Vector3d::Zero(), Vector3d::Zero()}, middle = Vector3d::Zero();
    for (const ContactPatch& patch : from.patches) {
      side[patch.pad_normal.dot(axis) > 0 ? 0 : 1] += patch.normal;
      middle += patch.point / static_cast<double>(from.patches.size());
    }
    const Vector3d facing = (side[1].normalized() - side[0].normalized()).normalized();
    if (facing.dot(axis) > 0.5) {
      const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(axis, facing).toRotationMatrix();
      const Vector3d out = R * approach(from);
      if (-out.z() >= std::cos(options_.max_tilt)) {
        grasp.T_world_hand.linear() = R * from.T_world_hand.linear();
        grasp.T_world_hand.translation() = middle + R * (from.T_world_hand.translation() - middle);
        axis = facing;
      }
    }
  }
  const Eigen::Vector2d shift = rng.in_disc(radius);
  const Vector3d in = approach(grasp);
  grasp.T_world_hand.translation() += shift.x() * in + shift.y() * axis.cross(in);
  draw_back(grasp);
  return grasp;
}

/// Low parts are held as deep as the table allows: a hand that would stand in it goes back along its approach.
void GraspEvaluator::draw_back(EvaluatedGrasp& grasp) const {
  const Vector3d in = approach(grasp);
  const double deep = clearance_.in_table(hand_.boxes(grasp.shares), grasp.T_world_hand);
  if (deep > 0 && -in.z() > kSteep) grasp.T_world_hand.translation() += (deep + kClear) / in.z() * in;
}

std::vector<double> GraspEvaluator::holding_shares(const EvaluatedGrasp& grasp) const {
  EvaluatedGrasp closing = grasp;
  std::vector<double> left;
  for (const ContactPatch& patch : grasp.patches) left.push_back(patch.nearest);
  const std::vector<FingerPad> begin = hand_.pads(grasp.shares);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> next = moved_fingers(closing, left);
    if (next == closing.shares) break;
    closing.shares = next;
    const std::vector<FingerPad> now = hand_.pads(next);
    for (std::size_t k = 0; k < now.size(); ++k)
      left[k] = grasp.patches[k].nearest -
                (now[k].T_hand_pad.translation() - begin[k].T_hand_pad.translation()).dot(pad_direction(begin[k]));
  }
  return closing.shares;
}

}  // namespace mmgrasp::detail
