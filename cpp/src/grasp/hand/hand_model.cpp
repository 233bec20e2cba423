#include "mmgrasp/grasp/hand_model.hpp"

#include <string>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// The pads of Hand's numbers: midway on the closing axis, as deep as finger_depth along the approach.
class NumberedHand final : public HandModel {
 public:
  explicit NumberedHand(const Hand& hand) : hand_(hand) { hand_.check_fingers(); }

  const Hand& hand() const override { return hand_; }
  int groups() const override { return 1; }
  std::vector<int> group_of_pad() const override { return {0, 0}; }
  std::vector<std::string> link_of_pad() const override {
    return hand_.finger_links.size() == 2 ? hand_.finger_links : std::vector<std::string>{};
  }

  std::vector<FingerPad> pads(const std::vector<double>& shares) const override {
    std::vector<FingerPad> pads;
    for (const double side : {-1.0, 1.0}) {
      const Vector3d push = -side * hand_.closing;
      FingerPad pad;
      pad.T_hand_pad.linear() << hand_.approach, push.cross(hand_.approach), push;
      pad.T_hand_pad.translation() = side * opening(shares) / 2 * hand_.closing;
      pad.depth = hand_.finger_depth;
      pad.width = hand_.finger_width;
      pads.push_back(pad);
    }
    return pads;
  }

  std::vector<LinkShape> boxes(const std::vector<double>& shares) const override {
    return hand_.shapes(opening(shares));
  }
  std::vector<double> posture(const std::vector<double>&) const override { return {}; }
  std::vector<double> shares_of(double opening, const std::vector<double>&) const override {
    return {hand_.share_open(opening)};
  }
  bool parallel() const override { return true; }

 private:
  double opening(const std::vector<double>& shares) const { return hand_.opening_at(shares.at(0)); }

  Hand hand_;
};

}  // namespace

std::shared_ptr<const HandModel> make_hand_model(const Hand& hand) {
  const std::size_t groups = hand.groups().size();
  require(groups <= 1, "hand", std::to_string(groups) + " groups of joints",
          "needs its robot, which has the links that they move: without it a hand is two pads");
  return std::make_shared<NumberedHand>(hand);
}

std::vector<int> opposed_sides(const std::vector<Vector3d>& pushes) {
  Vector3d common = Vector3d::Zero();
  for (const Vector3d& push : pushes) common += push / static_cast<double>(pushes.size());
  std::vector<int> sides;
  for (const Vector3d& push : pushes) sides.push_back((push - common).dot(pushes[0] - common) > 0 ? 0 : 1);
  return sides;
}

ClosingLine closing_line(const std::vector<FingerPad>& pads) {
  require(pads.size() >= 2, "pads", std::to_string(pads.size()), "a hand needs at least two fingertips");
  std::vector<Vector3d> pushes;
  for (const FingerPad& pad : pads) pushes.push_back(pad.T_hand_pad.linear().col(2));
  const std::vector<int> sides = opposed_sides(pushes);
  Vector3d place[2] = {Vector3d::Zero(), Vector3d::Zero()}, push[2] = {Vector3d::Zero(), Vector3d::Zero()};
  int count[2] = {0, 0};
  for (std::size_t k = 0; k < pads.size(); ++k) {
    place[sides[k]] += pads[k].T_hand_pad.translation();
    push[sides[k]] += pushes[k];
    ++count[sides[k]];
  }
  require(count[0] > 0 && count[1] > 0, "pads", std::to_string(pads.size()),
          "no fingertip pushes against the first one");
  ClosingLine line;
  line.axis = (push[0].normalized() - push[1].normalized()).normalized();
  line.middle = (place[0] / count[0] + place[1] / count[1]) / 2;
  double way[2] = {0, 0}, rate[2] = {0, 0};  // from the pads to the middle along their pushes, and how it grows
  for (std::size_t k = 0; k < pads.size(); ++k) {
    way[sides[k]] += (line.middle - pads[k].T_hand_pad.translation()).dot(pushes[k]) / count[sides[k]];
    rate[sides[k]] += line.axis.dot(pushes[k]) / count[sides[k]];
  }
  // Three fingers around a ball: the mean pad of two of them is nearer to the middle than either.
  const double shift = (way[1] - way[0]) / (rate[0] - rate[1]);
  line.middle += shift * line.axis;
  line.opening = way[0] + way[1] + shift * (rate[0] + rate[1]);
  return line;
}

}  // namespace mmgrasp
