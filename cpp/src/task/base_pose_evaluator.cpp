#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "task/no_clock.hpp"
#include "task/scene.hpp"

namespace mmgrasp {
namespace {

constexpr int kFruitless = 2;    // Descents without an arrival after which a grasp counts as out of reach.
constexpr int kIterations = 20;  // Of one descent: from a stored configuration near by, one that arrives takes 4 to 10.
constexpr double kFar = 1.2;     // Cells of the database beyond which only one descent is tried.
constexpr double kSame = 1e-3;   // Configurations nearer than this are one [rad or m].
constexpr int kCheckRestarts = 12;

/// Links that stand still in the tool's frame while the arm moves: those behind the last arm joint.
std::set<std::string> hand_links(const JointGroup& arm) {
  const Robot& robot = arm.robot();
  std::set<std::string> names;
  std::vector<int> open = {robot.joints()[static_cast<std::size_t>(arm.joints().back())].child_link};
  while (!open.empty()) {
    const Link& link = robot.links()[static_cast<std::size_t>(open.back())];
    open.pop_back();
    names.insert(link.name);
    for (int joint : link.child_joints) open.push_back(robot.joints()[static_cast<std::size_t>(joint)].child_link);
  }
  return names;
}

int stage(Rejection cause) {
  switch (cause) {
    case Rejection::limits:
      return 1;
    case Rejection::self_collision:
      return 2;
    case Rejection::scene:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

/// What all clones share.
struct EvaluatorTables {
  const PartSupplyProblem* problem;
  const ReachDatabase* database;
  JointGroup arm;                                               // root at the origin
  std::vector<std::vector<std::vector<int>>> opening;           // [tray][part][grasp]: index of the opening's checker
  std::vector<std::vector<std::vector<std::uint8_t>>> blocked;  // [tray][part][grasp]: the hand alone touches something
};

struct BasePoseEvaluator::Impl {
  std::shared_ptr<const EvaluatorTables> tables;
  CollisionChecker at_rest;
  std::vector<CollisionChecker> opened;
  std::vector<Eigen::Vector3d> opened_at;  // where each checker's root stands now
  IkOptions ik;
  IkWorkspace workspace;
  Eigen::MatrixXd seeds;
  std::vector<Eigen::VectorXd> seen;

  Impl(std::shared_ptr<const EvaluatorTables> shared, CollisionChecker rest, std::vector<CollisionChecker> open)
      : tables(std::move(shared)),
        at_rest(std::move(rest)),
        opened(std::move(open)),
        opened_at(opened.size(), Eigen::Vector3d::Constant(std::nan(""))) {
    ik.max_iterations = kIterations;
    ik.time_limit = kNoClock;
  }

  std::unique_ptr<Impl> clone() const {
    std::vector<CollisionChecker> copies;
    for (const CollisionChecker& checker : opened) copies.push_back(checker.clone());
    return std::make_unique<Impl>(tables, at_rest.clone(), std::move(copies));
  }

  CollisionChecker& checker_at(int index, const Eigen::Vector3d& base_pose) {
    CollisionChecker& checker = opened[static_cast<std::size_t>(index)];
    if (opened_at[static_cast<std::size_t>(index)] != base_pose) {
      checker.set_root(pose_from_planar(base_pose));
      opened_at[static_cast<std::size_t>(index)] = base_pose;
    }
    return checker;
  }

  /// Remembers a solution; false when it was judged already.
  bool is_new(const Eigen::VectorXd& q) {
    for (const Eigen::VectorXd& other : seen) {
      if ((other - q).cwiseAbs().maxCoeff() < kSame) return false;
    }
    seen.push_back(q);
    return true;
  }

  /// One descent from a stored configuration that, failing, also tells whether the pose is reached outside the limits
  /// only.
  IkResult descent(const Pose& T_base_tcp, int seed) {
    IkOptions one = ik;
    one.restarts = 0;
    return solve_ik(tables->arm, T_base_tcp, seeds.col(seed).head(tables->arm.size()), one);
  }

  /// Distance of a stored configuration's tool from the pose, in cells of the database.
  double cells_away(const Pose& T_base_tcp, int seed) const {
    const ReachOptions& cells = tables->database->options();
    const Pose T = tables->arm.fk(seeds.col(seed).head(tables->arm.size()));
    return (T.translation() - T_base_tcp.translation()).norm() / cells.position_cell +
           rotation_distance(T, T_base_tcp) / cells.rotation_cell;
  }

  Rejection grasp(const Eigen::Vector3d& base_pose, const Pose& T_base_tcp, int opening, Eigen::VectorXd& q) {
    const int count = tables->database->nearest(T_base_tcp, tables->problem->options.grid.ik_seeds, seeds);
    if (count == 0) return Rejection::reach;
    CollisionChecker& checker = checker_at(opening, base_pose);
    seen.clear();
    Rejection worst = Rejection::reach;
    // A pose that no stored configuration is near to is hardly ever reached: one descent is enough there.
    const int fruitless = std::min(count, cells_away(T_base_tcp, 0) > kFar ? 1 : kFruitless);
    for (int i = 0; i < count; ++i) {
      if (seen.empty() && i + 1 == fruitless) {
        const IkResult last = descent(T_base_tcp, i);
        if (last.outcome != Outcome::solved) return last.rejections.limits > 0 ? Rejection::limits : Rejection::reach;
        q = last.q;
      } else {
        q = seeds.col(i).head(tables->arm.size());
        if (!refine_ik(tables->arm, T_base_tcp, q, ik, workspace)) continue;
      }
      if (!is_new(q)) continue;
      const Rejection cause = checker.rejection(q);
      if (cause == Rejection::none) return cause;
      if (stage(cause) > stage(worst)) worst = cause;
    }
    return worst;
  }
};

namespace {

/// Indices of checkers by opening; openings that differ by rounding share one.
std::shared_ptr<EvaluatorTables> make_tables(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             std::vector<double>& openings) {
  auto tables =
      std::make_shared<EvaluatorTables>(EvaluatorTables{&problem, &database, problem.arm.at(Pose::Identity()), {}, {}});
  std::map<long, int> known;
  for (const Tray& tray : problem.trays) {
    tables->opening.emplace_back();
    tables->blocked.emplace_back();
    for (const Part& part : tray.parts) {
      std::vector<int> indices;
      for (const Grasp& grasp : part.grasps) {
        const double opening = problem.gripper.pregrasp_opening(grasp.width);
        const auto [it, is_new] = known.emplace(std::lround(opening * 1e9), static_cast<int>(openings.size()));
        if (is_new) openings.push_back(opening);
        indices.push_back(it->second);
      }
      tables->opening.back().push_back(indices);
      tables->blocked.back().emplace_back(part.grasps.size(), 0);
    }
  }
  return tables;
}

/// The robot is lifted, as a whole, so that its tool is at the grasp: what the hand touches there it touches with any
/// arm.
bool hand_touches(CollisionChecker& checker, const Pose& T_tcp_root, const Eigen::VectorXd& q,
                  const std::set<std::string>& hand, const Pose& T_world_tcp) {
  checker.set_root(T_world_tcp * T_tcp_root);
  for (const Contact& contact : checker.contacts(q)) {
    if (contact.with_scene && hand.count(contact.a)) return true;
  }
  return false;
}

void find_blocked_grasps(const PartSupplyProblem& problem, const World& world, const std::vector<double>& openings,
                         EvaluatorTables& tables) {
  const std::vector<std::pair<int, int>> parts = all_parts(problem);
  const std::set<std::string> hand = hand_links(problem.arm);
  const Pose T_tcp_root = tables.arm.fk(problem.home).inverse();
  CheckerOptions scene_only;
  scene_only.check_self = false;
  std::vector<CollisionChecker> originals;
  for (double opening : openings) originals.emplace_back(arm_with_opening(problem, opening), world, scene_only);
  const int threads = resolve_threads(problem.options.threads);
  std::vector<std::vector<CollisionChecker>> checkers(static_cast<std::size_t>(threads));
  parallel_for(parts.size(), threads, [&](std::size_t item, int worker) {
    const auto [tray, index] = parts[item];
    const Part& part = part_of(problem, tray, index);
    if (!part.target) return;
    std::vector<CollisionChecker>& own = checkers[static_cast<std::size_t>(worker)];
    if (own.empty()) {
      for (const CollisionChecker& checker : originals) own.push_back(checker.clone());
    }
    for (std::size_t g = 0; g < part.grasps.size(); ++g) {
      const int opening = tables.opening[static_cast<std::size_t>(tray)][static_cast<std::size_t>(index)][g];
      tables.blocked[static_cast<std::size_t>(tray)][static_cast<std::size_t>(index)][g] =
          hand_touches(own[static_cast<std::size_t>(opening)], T_tcp_root, problem.home, hand,
                       part.T_world_part * part.grasps[g].T_object_tcp);
    }
  });
}

}  // namespace

BasePoseEvaluator::BasePoseEvaluator(const PartSupplyProblem& problem, const ReachDatabase& database) {
  std::vector<double> openings;
  std::shared_ptr<EvaluatorTables> tables = make_tables(problem, database, openings);
  const World world = world_with_parts(problem, all_parts(problem));
  find_blocked_grasps(problem, world, openings, *tables);
  CollisionChecker at_rest(problem.arm, world);
  std::vector<CollisionChecker> opened;
  for (double opening : openings) opened.push_back(at_rest.with_group(arm_with_opening(problem, opening)));
  impl_ = std::make_unique<Impl>(tables, std::move(at_rest), std::move(opened));
}

BasePoseEvaluator::BasePoseEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BasePoseEvaluator::BasePoseEvaluator(BasePoseEvaluator&&) noexcept = default;
BasePoseEvaluator& BasePoseEvaluator::operator=(BasePoseEvaluator&&) noexcept = default;
BasePoseEvaluator::~BasePoseEvaluator() = default;

BasePoseEvaluator BasePoseEvaluator::clone() const {
  return BasePoseEvaluator(impl_->clone());
}

Rejection BasePoseEvaluator::home(const Eigen::Vector3d& base_pose) {
  impl_->at_rest.set_root(pose_from_planar(base_pose));
  return impl_->at_rest.rejection(impl_->tables->problem->home);
}

PartAtPose BasePoseEvaluator::part(const Eigen::Vector3d& base_pose, int tray, int index, int first_grasp) {
  const EvaluatorTables& tables = *impl_->tables;
  const Part& part = part_of(*tables.problem, tray, index);
  const std::vector<int>& openings = tables.opening[static_cast<std::size_t>(tray)][static_cast<std::size_t>(index)];
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  const int count = static_cast<int>(part.grasps.size());
  PartAtPose result;
  result.causes.assign(part.grasps.size(), Rejection::none);
  for (int turn = first_grasp >= 0 ? -1 : 0; turn < count; ++turn) {
    const int g = turn < 0 ? first_grasp : turn;
    if (turn >= 0 && g == first_grasp) continue;
    Rejection& cause = result.causes[static_cast<std::size_t>(g)];
    cause = hand_blocked(tray, index, g)
                ? Rejection::grasp_filter
                : impl_->grasp(base_pose, T_base_part * part.grasps[static_cast<std::size_t>(g)].T_object_tcp,
                               openings[static_cast<std::size_t>(g)], result.q);
    if (cause != Rejection::none) continue;
    result.feasible = true;
    result.grasp = g;
    result.causes.clear();
    return result;
  }
  result.q.resize(0);
  return result;
}

bool BasePoseEvaluator::part_with_restarts(const Eigen::Vector3d& base_pose, int tray, int index, int first_grasp) {
  if (part(base_pose, tray, index, first_grasp).feasible) return true;
  const EvaluatorTables& tables = *impl_->tables;
  const Part& part = part_of(*tables.problem, tray, index);
  const std::vector<int>& openings = tables.opening[static_cast<std::size_t>(tray)][static_cast<std::size_t>(index)];
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(tray, index, g)) continue;
    CollisionChecker& checker = impl_->checker_at(openings[static_cast<std::size_t>(g)], base_pose);
    IkOptions options;
    options.restarts = kCheckRestarts;
    options.time_limit = kNoClock;
    options.seed = static_cast<unsigned>(g) + 1;
    const IkResult found =
        solve_ik(tables.arm, T_base_part * part.grasps[static_cast<std::size_t>(g)].T_object_tcp, tables.problem->home,
                 options, [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
    if (found.outcome == Outcome::solved) return true;
  }
  return false;
}

bool BasePoseEvaluator::hand_blocked(int tray, int part, int grasp) const {
  return impl_->tables
      ->blocked[static_cast<std::size_t>(tray)][static_cast<std::size_t>(part)][static_cast<std::size_t>(grasp)];
}

double BasePoseEvaluator::missing_reach(const Eigen::Vector3d& base_pose, int tray, int index) const {
  const EvaluatorTables& tables = *impl_->tables;
  const Part& part = part_of(*tables.problem, tray, index);
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  double nearest = std::numeric_limits<double>::infinity();
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(tray, index, g)) continue;
    const Eigen::Vector3d p = (T_base_part * part.grasps[static_cast<std::size_t>(g)].T_object_tcp).translation();
    const double outside = std::sqrt(tables.database->bounds().squaredExteriorDistance(p));
    nearest = std::min(nearest, std::max(outside, p.norm() - tables.database->reach()));
  }
  return std::isfinite(nearest) ? std::max(nearest, 0.0) : 0.0;
}

}  // namespace mmgrasp
