#include "structure/bound/sag_bound.hpp"

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

using Eigen::Vector3d;

namespace {

constexpr int kPlacesPerMember = 3;  // places between the ends of each member that is not clamped
constexpr double kFit = 1e-9;        // share of its size that an interpolated displacement may be off

struct Place {
  int member;
  double distance;
};

/// All nodes, and places inside the members other than the one that is clamped.
std::vector<Place> places_of(const BeamFrame& frame, int clamped) {
  std::vector<Place> places;
  std::vector<char> known(frame.nodes.size(), 0);
  for (int m = 0; m < static_cast<int>(frame.members.size()); ++m) {
    const double length = frame.length(m);
    for (int end = 0; end < 2; ++end) {
      if (known[frame.members[m].nodes[end]]++) continue;
      places.push_back({m, end ? length : 0});
    }
    for (int k = 1; m != clamped && k <= kPlacesPerMember; ++k)
      places.push_back({m, length * k / (kPlacesPerMember + 1)});
  }
  return places;
}

Eigen::Matrix<double, 12, 1> displacement(const SupportedFrame& held, const Place& place) {
  Eigen::Matrix<double, 12, 1> all;
  const Vector3d alone = held.displacement(Vector3d::Zero(), place.member, place.distance);
  for (int j = 0; j < 3; ++j) {
    const Vector3d moved = held.displacement(Vector3d::Unit(j), place.member, place.distance) - alone;
    for (int k = 0; k < 3; ++k) all[4 * k + j] = moved[k];
  }
  for (int k = 0; k < 3; ++k) all[4 * k + 3] = alone[k];
  return all;
}

}  // namespace

SagBound::SagBound(const BeamFrame& frame, std::vector<Vector3d> gravity) : gravity_(std::move(gravity)) {
  Eigen::Matrix<double, kTerms, kTerms> powers;
  Eigen::Matrix<double, kTerms, 1> at;
  for (int i = 0; i < kTerms; ++i) {
    at[i] = std::cos((i + 0.5) * kPi / kTerms);
    for (int p = 0; p < kTerms; ++p) powers(i, p) = std::pow(at[i], p);
  }
  const Eigen::Matrix<double, kTerms, kTerms> fit = powers.inverse();
  for (int m = 0; m < static_cast<int>(frame.members.size()); ++m) {
    const std::vector<Place> places = places_of(frame, m);
    const double length = frame.length(m);
    length_.push_back(length);
    std::vector<Eigen::Matrix<double, 12, kTerms>> values(places.size());
    const auto held_at = [&](double t) {
      return SupportedFrame(frame, {BeamSupport{m, length * (1 + t) / 2, {true, true, true, true, true, true}}});
    };
    for (int i = 0; i < kTerms; ++i) {
      const SupportedFrame held = held_at(at[i]);
      for (std::size_t k = 0; k < places.size(); ++k) values[k].col(i) = displacement(held, places[k]);
    }
    places_.emplace_back();
    off_.emplace_back();
    for (const auto& value : values) {
      places_.back().push_back(value * fit.transpose());
      off_.back().push_back(kFit * value.norm() + 1e-15);
    }
    // That it is a polynomial is proven on paper and tried here, between the places that it was made from.
    const double t = 0.37;
    Eigen::Matrix<double, kTerms, 1> at_t;
    for (int p = 0; p < kTerms; ++p) at_t[p] = std::pow(t, p);
    const SupportedFrame held = held_at(t);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto exact = displacement(held, places[k]);
      const double off = (places_.back()[k] * at_t - exact).norm();
      if (off > off_.back()[k])
        throw Error("SagBound: displacements are no polynomial of the clamp; this is a fault of mmgrasp");
    }
  }
}

LinearForm SagBound::below(int member, double middle, double half) const {
  const double t = 2 * middle / length_[member] - 1, r = 2 * half / length_[member];
  const std::vector<Powers>& places = places_[member];
  Eigen::Matrix<double, kTerms, 1> at_t;
  for (int p = 0; p < kTerms; ++p) at_t[p] = p == 0 ? 1 : at_t[p - 1] * t;
  std::vector<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> now(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Eigen::Matrix<double, 12, 1> flat = places[k] * at_t;
    now[k] = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(flat.data());
  }
  // Looks at the place that moves most in the middle of the box, along its direction there: never more than the
  // largest.
  std::vector<Eigen::Matrix<double, 1, 12>> weights(places.size(), Eigen::Matrix<double, 1, 12>::Zero());
  for (const Vector3d& g : gravity_) {
    Eigen::Vector4d load;
    load << g, 1;
    std::size_t best = 0;
    Vector3d most = Vector3d::Zero();
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Vector3d moved = now[k] * load;
      if (moved.squaredNorm() <= most.squaredNorm()) continue;
      most = moved;
      best = k;
    }
    if (most.norm() == 0) continue;
    most.normalize();
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 4; ++j) weights[best][4 * k + j] += most[k] * load[j];
    }
  }
  Eigen::Matrix<double, 1, kTerms> sum = Eigen::Matrix<double, 1, kTerms>::Zero();
  double off = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (weights[k].isZero(0)) continue;
    sum += weights[k] * places[k];
    off += weights[k].norm() * off_[member][k];
  }
  // Taylor's series about t by repeated synthetic division: exact, the terms beyond the first are the remainder.
  for (int from = 0; from + 1 < kTerms; ++from) {
    for (int p = kTerms - 2; p >= from; --p) sum[p] += t * sum[p + 1];
  }
  double remainder = 0, power = r;
  for (int p = 2; p < kTerms; ++p) remainder += std::abs(sum[p]) * (power *= r);
  return {sum[0], sum[1] * r, 0, remainder + off};
}

}  // namespace mmgrasp::detail
