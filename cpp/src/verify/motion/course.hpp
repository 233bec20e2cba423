#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/verify/schedule_check.hpp"
#include "verify/judge.hpp"
#include "verify/motion/drive_profile.hpp"

namespace mmgrasp::verify::detail {

/// A piece of a plan with what moves in it: the base along a straight section, the arm, or the fingers alone.
struct CoursePiece {
  std::string name;
  double duration = 0;
  Eigen::Vector3d from, to;               ///< Base poses; the same where the base stands.
  std::vector<DriveProfile> profile;      ///< One where the base drives.
  const CheckedMotion* motion = nullptr;  ///< Set where the arm moves; else it stands at `arm`.
  Eigen::VectorXd arm;
  double opening = 0, opening_after = 0;  ///< They differ where the fingers move.
  int part = -1;                          ///< Part in the hand, as an index into the plan's parts; -1: none.
  Pose T_tip_part = Pose::Identity();
  std::vector<double> times, travel;  ///< No point of the robot has moved farther at these times of the piece [s, m].
};

/// The pieces of a plan without structural faults.
std::vector<CoursePiece> course_of(const PlanToCheck& plan, const Stage& stage);

/// A robot that carries out a course, each piece when it is said to begin: where all of it is at any time.
class MovingRobot {
 public:
  MovingRobot(std::shared_ptr<const Stage> stage, const PlanToCheck& plan, std::vector<CoursePiece> pieces,
              std::vector<double> starts);

  double end() const;                   ///< When the last piece is done [s].
  std::vector<double> changes() const;  ///< When pieces begin and end: what is held is the same in between [s].
  /// No point moves farther between the two times [m], what is held included.
  double travel(double from, double to) const;
  void place(double time);
  /// The piece that is carried out, or where it stands.
  std::string doing(double time) const;
  /// Two bodies that are closer than `margin` as both robots were placed last: names of links or parts; empty: none.
  std::string closer_than(double margin, const MovingRobot& other) const;

 private:
  struct Placed {
    std::string name;
    const std::vector<Solid>* solids = nullptr;
    Poses T_world;
    std::vector<Bounds> bounds;
    Bounds total;
  };
  void place_body(Placed& body, const Pose& T_world_body);
  std::size_t piece_at(double time) const;  ///< The last one that began; the first before any did.

  std::shared_ptr<const Stage> stage_;
  Kinematics kinematics_;
  std::vector<CoursePiece> pieces_;
  std::vector<double> starts_;
  std::vector<std::string> part_names_;
  std::vector<std::vector<Solid>> part_solids_;  ///< Solids of the parts, by index; empty where a part is not picked.
  std::vector<Placed> links_;                    ///< Links that have solids.
  std::vector<int> link_index_;
  Placed attached_;
  Bounds total_;
};

}  // namespace mmgrasp::verify::detail
