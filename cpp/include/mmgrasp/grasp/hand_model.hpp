#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// The face of a finger that touches: a rectangle. Frame: origin in its middle, z the way it pushes, x along its depth
/// (the hand's approach for parallel fingers), y along its width.
struct MMGRASP_EXPORT FingerPad {
  Pose T_hand_pad = Pose::Identity();
  double depth = 0.03;  ///< Along x [m], > 0.
  double width = 0.02;  ///< Along y [m], > 0.
};

/// Where a hand's pads and bodies are at any posture, in its tool frame: what grasp synthesis asks of a hand, whether
/// it is a parallel gripper or has many joints. `shares` say how far each closing group is open, in [0, 1].
///
///     const std::shared_ptr<const HandModel> model = make_hand_model(hand);
///     for (const FingerPad& pad : model->pads(std::vector<double>(model->groups(), 0.5))) draw(pad);
class MMGRASP_EXPORT HandModel {
 public:
  virtual ~HandModel() = default;

  virtual const Hand& hand() const = 0;
  /// Closing groups: those that Hand::preshape does not hold. At least one.
  virtual int groups() const = 0;
  /// Closing group of each pad.
  virtual std::vector<int> group_of_pad() const = 0;
  /// Link of each pad; empty for hands without a robot that do not name theirs.
  virtual std::vector<std::string> link_of_pad() const = 0;
  /// Pads of at least two fingers; the first pushes along its side of the closing line, others along or against it.
  virtual std::vector<FingerPad> pads(const std::vector<double>& shares) const = 0;
  /// Boxes around all bodies of the hand.
  virtual std::vector<LinkShape> boxes(const std::vector<double>& shares) const = 0;
  /// One number for each of Hand::groups(), as Grasp::posture has them; empty for hands that the opening describes.
  virtual std::vector<double> posture(const std::vector<double>& shares) const = 0;
  /// The shares that a pre-touch posture stands for: the opening of hands that it describes [m], else the posture.
  virtual std::vector<double> shares_of(double opening, const std::vector<double>& posture) const = 0;
  /// Pads keep their directions and move along the closing axis alone: distances follow without new rays.
  virtual bool parallel() const = 0;
};

/// A hand by its numbers: two pads of finger_depth x finger_width, the boxes of Hand::shapes(). Throws InvalidInput for
/// hands of several joint groups, which need their robot (eigengrasp.hpp).
MMGRASP_EXPORT std::shared_ptr<const HandModel> make_hand_model(const Hand& hand);

/// 0 for the pads that push the first one's way, 1 for those that push against it, by the unit vectors along which they
/// push; what all have in common, as when fingers spread out, does not count.
MMGRASP_EXPORT std::vector<int> opposed_sides(const std::vector<Eigen::Vector3d>& pushes);

/// Two virtual fingers: the pads of either of opposed_sides() (Arbib et al. 1985).
struct MMGRASP_EXPORT ClosingLine {
  /// As far from either side, in the tool frame [m]: a side's distance is the mean of its pads' ways to this place
  /// along their pushes. It lies on the line along `axis` through the middle of both sides' mean pads.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< From the first side to the other, a unit vector.
  /// The sum of both sides' distances [m]: how far two parallel pads are apart, the diameter of a ball between fingers
  /// all around; negative once they passed each other.
  double opening = 0;
};
MMGRASP_EXPORT ClosingLine closing_line(const std::vector<FingerPad>& pads);

}  // namespace mmgrasp
