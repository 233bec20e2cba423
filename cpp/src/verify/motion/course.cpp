#include "verify/motion/course.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/detail/numbers.hpp"
#include "verify/motion/hermite.hpp"

namespace mmgrasp::verify::detail {
namespace {

/// How far any point that a link carries can be from the link's origin, and from that how far points move.
class Reach {
 public:
  Reach(const Stage& stage, const PlanToCheck& plan) : robot_(*stage.robot), setup_(stage.setup) {
    reach_.assign(robot_.links.size(), 0.0);
    for (std::size_t link = 0; link < reach_.size(); ++link) {
      if (!stage.link_solids[link].empty()) reach_[link] = radius_of(stage.link_solids[link]);
    }
    double& tip = reach_[setup_.tip_link];
    for (const CheckedPart& part : plan.parts) {
      if (!part.target) continue;
      const double radius = radius_of(make_solids(part.body.shapes));
      for (const CheckedGrasp& grasp : part.grasps)
        tip = std::max(tip, grasp.T_object_hand.translation().norm() + radius);
    }
    for (std::size_t i = robot_.joints.size(); i-- > 0;) {  // children first
      const ModelJoint& joint = robot_.joints[i];
      double stroke = 0;
      if (joint.kind == JointKind::prismatic) stroke = std::max(std::abs(lower(joint)), std::abs(upper(joint)));
      double& parent = reach_[joint.parent];
      parent = std::max(parent, joint.T_parent_child.p.Norm() + stroke + reach_[joint.child]);
    }
  }

  double root() const { return reach_[0]; }
  /// How far points move per unit of a joint, with all that follow it [m/rad or m/m].
  double per_unit(int source) const {
    double out = 0;
    for (const ModelJoint& joint : robot_.joints) {
      if (joint.moves() && joint.source == source)
        out += std::abs(joint.multiplier) * (joint.turns() ? reach_[joint.child] : 1.0);
    }
    return out;
  }

 private:
  double lower(const ModelJoint& joint) const { return end(joint, robot_.joints[joint.source].lower); }
  double upper(const ModelJoint& joint) const { return end(joint, robot_.joints[joint.source].upper); }
  static double end(const ModelJoint& joint, double source) { return joint.multiplier * source + joint.offset; }

  const RobotModel& robot_;
  const ArmSetup& setup_;
  std::vector<double> reach_;
};

/// Writes the pieces of a plan down in the order in which they are carried out.
class CourseWriter {
 public:
  CourseWriter(const PlanToCheck& plan, const Stage& stage)
      : plan_(plan), stage_(stage), reach_(stage, plan), arm_(plan.home) {
    for (std::size_t i = 0; i < plan.parts.size(); ++i) part_index_[plan.parts[i].body.name] = static_cast<int>(i);
  }

  std::vector<CoursePiece> write() {
    for (std::size_t leg = 0; leg < plan_.route.size(); ++leg) {
      drive(plan_.route[leg], leg < plan_.stops.size() ? "stop " + std::to_string(leg + 1) : "the goal");
      for (std::size_t i = 0; i < plan_.picks.size(); ++i) {
        if (plan_.picks[i].stop != static_cast<int>(leg)) continue;
        pick(plan_.picks[i]);
        unload(static_cast<int>(i), "stop " + std::to_string(leg + 1) + " again");
      }
    }
    return std::move(pieces_);
  }

 private:
  CoursePiece standing(const std::string& name) const {
    CoursePiece piece;
    piece.name = name;
    piece.from = piece.to = base_;
    piece.arm = arm_;
    piece.opening = piece.opening_after = opening_;
    return piece;
  }

  void drive(const std::vector<Eigen::Vector3d>& poses, const std::string& to) {
    int section = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Eigen::Vector3d from = i > 0 ? poses[i - 1] : poses[0];
      base_ = poses[i];
      const DriveProfile profile(from, base_, plan_.robot.base, plan_.robot.base_limits);
      if (!(profile.duration() > 0)) continue;
      CoursePiece piece = standing("drive to " + to + ", section " + std::to_string(++section));
      piece.from = from;
      piece.duration = profile.duration();
      piece.profile.push_back(profile);
      const Eigen::Vector3d way = base_ - from;
      const double per_share = way.head<2>().norm() + std::abs(way.z()) * reach_.root();
      piece.times = {0.0, piece.duration};
      piece.travel = {0.0, per_share * profile.top() * piece.duration};
      pieces_.push_back(std::move(piece));
    }
  }

  void pick(const CheckedPick& pick) {
    const auto found = part_index_.find(pick.part);
    int in_hand = -1;
    Pose T_tip_part = Pose::Identity();
    if (found != part_index_.end()) {
      const std::vector<CheckedGrasp>& grasps = plan_.parts[found->second].grasps;
      if (pick.grasp >= 0 && pick.grasp < static_cast<int>(grasps.size())) {
        in_hand = found->second;
        T_tip_part = grasps[pick.grasp].T_object_hand.inverse(Eigen::Isometry);
      }
    }
    bool attached = false;
    for (const CheckedMotion& motion : pick.motions) {
      move_fingers(motion.opening, attached, in_hand, T_tip_part, pick.part);
      attached = motion.attached;
      CoursePiece piece = standing(motion.kind + " " + pick.part);
      piece.motion = &motion;
      piece.duration = motion.times.empty() ? 0.0 : motion.times.back();
      if (attached) {
        piece.part = in_hand;
        piece.T_tip_part = T_tip_part;
      }
      measure_arm(motion, piece);
      if (!motion.positions.empty()) arm_ = motion.positions.back();
      pieces_.push_back(std::move(piece));
    }
  }

  /// What the hand opens to before the first motion of all takes no time: it may stand so from the beginning.
  void move_fingers(double opening, bool attached, int part, const Pose& T_tip_part, const std::string& name) {
    const double before = opening_;
    const bool first = !opened_;
    opened_ = true;
    if (first) {
      opening_ = opening;
      return;
    }
    if (before == opening) return;
    CoursePiece piece = standing((opening < before ? "close on " : "open beside ") + name);
    piece.opening_after = opening_ = opening;
    piece.duration = std::abs(opening - before) / plan_.closing_speed;
    if (attached) {
      piece.part = part;
      piece.T_tip_part = T_tip_part;
    }
    double way = 0;
    for (const FingerMap& finger : stage_.setup.fingers)
      way += std::abs(finger.open - finger.closed) * reach_.per_unit(finger.joint);
    piece.times = {0.0, piece.duration};
    piece.travel = {0.0, way * largest_finger_rate() * std::abs(opening - before)};
    pieces_.push_back(std::move(piece));
  }

  /// The largest share of the fingers' way per metre of opening.
  double largest_finger_rate() const {
    const std::vector<double>& openings = stage_.setup.openings;
    double least = mmgrasp::detail::kInfinity;
    for (std::size_t i = 1; i < openings.size(); ++i) least = std::min(least, openings[i] - openings[i - 1]);
    return least > 0 ? 1 / (least * static_cast<double>(openings.size() - 1)) : 0;
  }

  void unload(int pick, const std::string& again) {
    for (const CheckedUnloading& unloading : plan_.unloadings) {
      if (unloading.after_pick != pick) continue;
      drive(unloading.to_goal, "the goal to unload");
      drive(unloading.back, again);
    }
  }

  void measure_arm(const CheckedMotion& motion, CoursePiece& piece) const {
    double way = 0;
    piece.times = {0.0};
    piece.travel = {0.0};
    for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
      const HermiteSegment segment(motion, i);
      for (std::size_t j = 0; j < stage_.setup.arm.size(); ++j)
        way += segment.travel(static_cast<int>(j)) * reach_.per_unit(stage_.setup.arm[j]);
      piece.times.push_back(motion.times[i + 1]);
      piece.travel.push_back(way);
    }
  }

  const PlanToCheck& plan_;
  const Stage& stage_;
  const Reach reach_;
  std::map<std::string, int> part_index_;
  Eigen::Vector3d base_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd arm_;
  double opening_ = 0;
  bool opened_ = false;
  std::vector<CoursePiece> pieces_;
};

/// Straight between the entries of two lists, constant beyond their ends.
double interpolated(const std::vector<double>& at, const std::vector<double>& values, double x) {
  if (at.empty() || x <= at.front()) return values.empty() ? 0 : values.front();
  if (x >= at.back()) return values.back();
  const std::size_t i = std::upper_bound(at.begin(), at.end(), x) - at.begin();
  return values[i - 1] + (values[i] - values[i - 1]) * (x - at[i - 1]) / (at[i] - at[i - 1]);
}

Eigen::VectorXd arm_at(const CoursePiece& piece, double time) {
  if (piece.motion == nullptr) return piece.arm;
  const CheckedMotion& motion = *piece.motion;
  if (motion.times.size() < 2 || time <= 0) return motion.positions.front();
  if (time >= motion.times.back()) return motion.positions.back();
  const std::size_t i = std::upper_bound(motion.times.begin(), motion.times.end(), time) - motion.times.begin() - 1;
  return HermiteSegment(motion, i).at((time - motion.times[i]) / (motion.times[i + 1] - motion.times[i]));
}

}  // namespace

std::vector<CoursePiece> course_of(const PlanToCheck& plan, const Stage& stage) {
  return CourseWriter(plan, stage).write();
}

MovingRobot::MovingRobot(std::shared_ptr<const Stage> stage, const PlanToCheck& plan, std::vector<CoursePiece> pieces,
                         std::vector<double> starts)
    : stage_(std::move(stage)),
      kinematics_(*stage_->robot, stage_->setup),
      pieces_(std::move(pieces)),
      starts_(std::move(starts)) {
  for (std::size_t link = 0; link < stage_->link_solids.size(); ++link) {
    if (stage_->link_solids[link].empty()) continue;
    links_.push_back({stage_->robot->links[link].name, &stage_->link_solids[link], {}, {}, {}});
    link_index_.push_back(static_cast<int>(link));
  }
  part_solids_.resize(plan.parts.size());
  for (const CheckedPart& part : plan.parts) part_names_.push_back(part.body.name);
  for (const CoursePiece& piece : pieces_) {
    if (piece.part >= 0 && part_solids_[piece.part].empty())
      part_solids_[piece.part] = make_solids(plan.parts[piece.part].body.shapes);
  }
}

double MovingRobot::end() const {
  return starts_.back() + pieces_.back().duration;
}

std::vector<double> MovingRobot::changes() const {
  std::vector<double> out = starts_;
  for (std::size_t i = 0; i < pieces_.size(); ++i) out.push_back(starts_[i] + pieces_[i].duration);
  return out;
}

std::size_t MovingRobot::piece_at(double time) const {
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), time);
  return after == starts_.begin() ? 0 : after - starts_.begin() - 1;
}

double MovingRobot::travel(double from, double to) const {
  double way = 0;
  for (std::size_t i = piece_at(from); i < pieces_.size() && starts_[i] < to; ++i) {
    const CoursePiece& piece = pieces_[i];
    way += interpolated(piece.times, piece.travel, to - starts_[i]) -
           interpolated(piece.times, piece.travel, from - starts_[i]);
  }
  return way;
}

std::string MovingRobot::doing(double time) const {
  if (time < starts_.front()) return "its wait at the start";
  const std::size_t i = piece_at(time);
  if (time <= starts_[i] + pieces_[i].duration) return "'" + pieces_[i].name + "'";
  return i + 1 < pieces_.size() ? "its wait after '" + pieces_[i].name + "'" : "its stand at the goal";
}

void MovingRobot::place_body(Placed& body, const Pose& T_world_body) {
  body.T_world.resize(body.solids->size());
  body.bounds.resize(body.solids->size());
  body.total.setEmpty();
  for (std::size_t i = 0; i < body.solids->size(); ++i) {
    body.T_world[i] = T_world_body * (*body.solids)[i].T_body_shape;
    body.bounds[i] = bounds_at((*body.solids)[i], body.T_world[i]);
    body.total.extend(body.bounds[i]);
  }
  total_.extend(body.total);
}

void MovingRobot::place(double time) {
  const std::size_t index = piece_at(time);
  const CoursePiece& piece = pieces_[index];
  const double local = std::clamp(time - starts_[index], 0.0, piece.duration);
  const double done = piece.duration > 0 ? local / piece.duration : 1.0;
  Eigen::Vector3d base = piece.to;
  if (!piece.profile.empty()) base = piece.from + piece.profile.front().share(local) * (piece.to - piece.from);
  const Pose T_world_root = pose_from_planar(base);
  const double opening = piece.opening + done * (piece.opening_after - piece.opening);
  const Poses& poses = kinematics_.place(arm_at(piece, local), opening);
  total_.setEmpty();
  for (std::size_t i = 0; i < links_.size(); ++i) place_body(links_[i], T_world_root * poses[link_index_[i]]);
  attached_.solids = piece.part >= 0 ? &part_solids_[piece.part] : nullptr;
  if (attached_.solids == nullptr) return;
  attached_.name = part_names_[piece.part];
  place_body(attached_, T_world_root * poses[stage_->setup.tip_link] * piece.T_tip_part);
}

std::string MovingRobot::closer_than(double margin, const MovingRobot& other) const {
  const auto far = [margin](const Bounds& a, const Bounds& b) { return a.exteriorDistance(b) >= margin; };
  if (far(total_, other.total_)) return "";
  const auto bodies = [](const MovingRobot& robot) {
    std::vector<const Placed*> out;
    for (const Placed& link : robot.links_) out.push_back(&link);
    if (robot.attached_.solids != nullptr) out.push_back(&robot.attached_);
    return out;
  };
  for (const Placed* a : bodies(*this)) {
    if (far(a->total, other.total_)) continue;
    for (const Placed* b : bodies(other)) {
      if (far(a->total, b->total)) continue;
      for (std::size_t i = 0; i < a->solids->size(); ++i) {
        for (std::size_t k = 0; k < b->solids->size(); ++k) {
          if (far(a->bounds[i], b->bounds[k])) continue;
          if (detail::closer_than(margin, (*a->solids)[i], a->T_world[i], (*b->solids)[k], b->T_world[k]))
            return "'" + a->name + "' to '" + b->name + "'";
        }
      }
    }
  }
  return "";
}

}  // namespace mmgrasp::verify::detail
