#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "task/base_region/ik_seed_grid.hpp"
#include "task/base_region/warm_started_ik.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

constexpr int kNeighbours = 3;  // Nodes around tried where the own one is of no use.
constexpr int kCheckRestarts = 12;

/// Links that stand still in the tool's frame while the arm moves: those behind the last arm joint.
std::set<std::string> hand_links(const JointGroup& arm) {
  const Robot& robot = arm.robot();
  std::set<std::string> names;
  std::vector<int> open = {robot.joints()[arm.joints().back()].child_link};
  while (!open.empty()) {
    const Link& link = robot.links()[open.back()];
    open.pop_back();
    names.insert(link.name);
    for (int joint : link.child_joints) open.push_back(robot.joints()[joint].child_link);
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
  JointGroup arm;  // root at the origin
  Eigen::AlignedBox3d bounds;
  double reach;
  std::shared_ptr<const IkSeedGrid> lattice;
  std::vector<std::pair<int, int>> parts;  // in place
  std::vector<double> openings;
  std::vector<std::vector<int>> first;  // [tray][part]: where its grasps begin in the lists below
  std::vector<int> opening;             // index of the opening's checker
  std::vector<std::uint8_t> blocked;    // the hand alone touches something
};

/// A grasp as it is for one heading of the base, with the base in the origin.
struct PlacedGrasp {
  IkSeedGrid::IkSeedSlice* sheet = nullptr;
  Pose T_root_tcp;
};

struct BasePoseEvaluator::Impl {
  std::shared_ptr<const EvaluatorTables> tables;
  CollisionChecker at_rest;
  std::vector<CollisionChecker> opened;
  std::vector<Eigen::Vector3d> opened_at;  // where each checker's root stands now
  WarmStartedIk descent;
  double heading = std::nan("");    // of `placed`
  std::vector<PlacedGrasp> placed;  // one a grasp
  Eigen::VectorXd q;
  Eigen::MatrixXd seen;  // configurations of the grasp at hand that the checker turned down
  Eigen::Index seen_count = 0;

  Impl(std::shared_ptr<const EvaluatorTables> shared, CollisionChecker rest, std::vector<CollisionChecker> open)
      : tables(std::move(shared)),
        at_rest(std::move(rest)),
        opened(std::move(open)),
        opened_at(opened.size(), Eigen::Vector3d::Constant(std::nan(""))),
        descent(tables->arm),
        placed(tables->opening.size()),
        seen(tables->arm.size(), 16) {}

  std::unique_ptr<Impl> clone() const {
    std::vector<CollisionChecker> copies;
    for (const CollisionChecker& checker : opened) copies.push_back(checker.clone());
    return std::make_unique<Impl>(tables, at_rest.clone(), std::move(copies));
  }

  CollisionChecker& checker_at(int index, const Eigen::Vector3d& base_pose) {
    CollisionChecker& checker = opened[index];
    if (opened_at[index] != base_pose) {
      checker.set_root(pose_from_planar(base_pose));
      opened_at[index] = base_pose;
    }
    return checker;
  }

  const PlacedGrasp& place(double theta, const Part& part, int grasp, int place_of_grasp) {
    if (theta != heading) {
      for (PlacedGrasp& old : placed) old.sheet = nullptr;
      heading = theta;
    }
    PlacedGrasp& placed_grasp = placed[place_of_grasp];
    if (placed_grasp.sheet == nullptr) {
      placed_grasp.T_root_tcp = pose_from_planar(Eigen::Vector3d(0, 0, theta)).inverse() *
                                (part.T_world_part * part.grasps[grasp].T_object_hand);
      placed_grasp.sheet =
          &tables->lattice->sheet(placed_grasp.T_root_tcp.linear(), placed_grasp.T_root_tcp.translation().z());
    }
    return placed_grasp;
  }

  /// Follows one configuration of a node to the pose. True when it arrives; `cause` is then what the checker says.
  bool follow(const double* start, const Pose& T_base_tcp, CollisionChecker& checker, Rejection& cause) {
    q = Eigen::Map<const Eigen::VectorXd>(start, tables->arm.size());
    if (!descent.run(T_base_tcp, q)) return false;
    cause = checker.rejection(q);
    return true;
  }

  /// One grasp, `q` its configuration when there is one. `any_order`: what was of use last is tried first.
  Rejection grasp(const Eigen::Vector3d& base_pose, const Part& part, int index, int place_of_grasp, bool any_order) {
    const PlacedGrasp& grasp = place(base_pose.z(), part, index, place_of_grasp);
    const double c = std::cos(base_pose.z()), s = std::sin(base_pose.z());
    Pose T_base_tcp = grasp.T_root_tcp;
    T_base_tcp.translation().x() -= c * base_pose.x() + s * base_pose.y();
    T_base_tcp.translation().y() -= c * base_pose.y() - s * base_pose.x();
    const double x = T_base_tcp.translation().x(), y = T_base_tcp.translation().y();
    const IkSeedGrid& lattice = *tables->lattice;
    std::array<int, 2> cell;
    IkSeedGrid::Node* node = grasp.sheet->find(x, y, cell);
    if (node == nullptr && !lattice.closed_form()) return Rejection::reach;
    CollisionChecker& checker = checker_at(tables->opening[place_of_grasp], base_pose);
    Rejection worst = Rejection::reach;
    bool arrived = false;
    seen_count = 0;
    const auto tried = [&](const double* start) {
      Rejection cause;
      if (!follow(start, T_base_tcp, checker, cause)) return false;
      arrived = true;
      if (cause == Rejection::none) return true;
      if (stage(cause) > stage(worst)) worst = cause;
      if (lattice.closed_form()) remember();
      return false;
    };
    int k = 0;
    if (node != nullptr) {
      const Pose T_base_node = grasp.sheet->pose(cell[0], cell[1]);
      const int first = any_order ? node->last_good.load(std::memory_order_relaxed) : 0;
      if (const double* start = first > 0 ? node->solution(first, lattice, T_base_node) : nullptr; start != nullptr)
        if (tried(start)) return Rejection::none;
      for (; const double* start = node->solution(k, lattice, T_base_node); ++k) {
        if (k == first && first > 0) continue;
        if (!tried(start)) continue;
        if (any_order) node->last_good.store(k, std::memory_order_relaxed);
        return Rejection::none;
      }
    }
    if (lattice.closed_form()) return from_branches(T_base_tcp, checker, worst);
    if (arrived) return worst;
    return from_neighbours(*grasp.sheet, cell, x, y, tried) ? Rejection::none
           : arrived                                        ? worst
           : k == 0                                         ? node->cause()
                                                            : Rejection::reach;
  }

  void remember() {
    if (seen_count < seen.cols()) seen.col(seen_count++) = q;
  }

  /// The same posture, whole turns aside: all joints of an arm with a closed form turn.
  bool was_seen(const Eigen::VectorXd& other) const {
    constexpr double kSame = 1e-3;  // [rad]
    for (Eigen::Index i = 0; i < seen_count; ++i) {
      Eigen::Index j = 0;
      while (j < other.size() && std::abs(wrap_angle(other[j] - seen(j, i))) < kSame) ++j;
      if (j == other.size()) return true;
    }
    return false;
  }

  /// Every branch of the pose itself but those that have been followed to: after this nothing is left to find.
  Rejection from_branches(const Pose& T_base_tcp, CollisionChecker& checker, Rejection worst) {
    const IkBranches branches = tables->lattice->branches(T_base_tcp);
    if (worst == Rejection::reach && branches.rejections.limits > 0) worst = Rejection::limits;
    for (const Eigen::VectorXd& branch : branches.solutions) {
      if (was_seen(branch)) continue;
      const Rejection cause = checker.rejection(branch);
      if (cause == Rejection::none) {
        q = branch;
        return cause;
      }
      if (stage(cause) > stage(worst)) worst = cause;
    }
    return worst;
  }

  /// Near the edge of the reach a node may lie outside where the pose lies inside.
  template <class Try>
  bool from_neighbours(IkSeedGrid::IkSeedSlice& sheet, const std::array<int, 2>& cell, double x, double y,
                       const Try& tried) {
    struct Near {
      double distance;
      const double* start;
    };
    std::array<Near, 8> near;
    std::size_t count = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const int ix = cell[0] + dx, iy = cell[1] + dy;
        IkSeedGrid::Node* node = sheet.at(ix, iy);
        if (node == nullptr) continue;
        const double* start = node->solution(0, *tables->lattice, sheet.pose(ix, iy));
        if (start != nullptr) near[count++] = {sheet.squared_distance(ix, iy, x, y), start};
      }
    }
    std::stable_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const Near& a, const Near& b) { return a.distance < b.distance; });
    for (std::size_t i = 0; i < std::min<std::size_t>(count, kNeighbours); ++i) {
      if (tried(near[i].start)) return true;
    }
    return false;
  }

  /// The first grasp that works, or -1 with one cause for each.
  int find(const Eigen::Vector3d& base_pose, int tray, int index, int first_grasp, bool any_order,
           std::vector<Rejection>& causes) {
    const Part& part = part_of(*tables->problem, tray, index);
    const int begin = tables->first[tray][index];
    const int count = static_cast<int>(part.grasps.size());
    causes.resize(part.grasps.size());
    for (int turn = first_grasp >= 0 ? -1 : 0; turn < count; ++turn) {
      const int g = turn < 0 ? first_grasp : turn;
      if (turn >= 0 && g == first_grasp) continue;
      Rejection& cause = causes[g];
      cause = tables->blocked[begin + g] ? Rejection::grasp_filter : grasp(base_pose, part, g, begin + g, any_order);
      if (cause == Rejection::none) return g;
    }
    return -1;
  }
};

namespace {

/// Indices of checkers by opening; openings that differ by rounding share one.
std::shared_ptr<EvaluatorTables> make_tables(const PartSupplyProblem& problem, const ReachDatabase& database) {
  const JointGroup arm = problem.arm.at(Pose::Identity());
  auto tables = std::make_shared<EvaluatorTables>(
      EvaluatorTables{&problem,
                      arm,
                      database.bounds(),
                      database.reach(),
                      std::make_shared<const IkSeedGrid>(arm, database, problem.options.grid.ik_seeds),
                      {},
                      {},
                      {},
                      {},
                      {}});
  std::map<long, int> known;
  for (const Tray& tray : problem.trays) {
    tables->first.emplace_back();
    for (const Part& part : tray.parts) {
      tables->first.back().push_back(static_cast<int>(tables->opening.size()));
      for (const Grasp& grasp : part.grasps) {
        const double opening = problem.gripper.pregrasp_opening(grasp.opening);
        const auto [it, is_new] = known.emplace(std::lround(opening * 1e9), static_cast<int>(tables->openings.size()));
        if (is_new) tables->openings.push_back(opening);
        tables->opening.push_back(it->second);
      }
    }
  }
  tables->blocked.assign(tables->opening.size(), 1);
  return tables;
}

/// The hand alone, fingers opened so far, held at the tool centre point of a body without shapes that can be put
/// anywhere: what it touches at a grasp it touches with any arm.
CollisionChecker hand_checker(const PartSupplyProblem& problem, double opening, World world) {
  const JointGroup arm = arm_with_opening(problem, opening);
  const std::vector<Pose> T_root_link = arm.robot().link_poses(arm.full_values(problem.home));
  const Pose T_tcp_root = T_root_link[arm.tip_link()].inverse();
  WorldObject hand;
  const std::set<std::string> links = hand_links(arm);
  for (std::size_t i = 0; i < arm.robot().links().size(); ++i) {
    const Link& link = arm.robot().links()[i];
    if (links.count(link.name) == 0) continue;
    for (LinkShape shape : link.collisions) {
      shape.T_link_shape = T_tcp_root * T_root_link[i] * shape.T_link_shape;
      hand.shapes.push_back(shape);
    }
  }
  static const Robot carrier = Robot::from_strings(
      "<robot name='carrier'><link name='root'/><link name='tcp'/><joint name='turn' type='revolute'><parent "
      "link='root'/><child link='tcp'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='1'/>"
      "</joint></robot>");
  if (!hand.shapes.empty()) {
    std::string name = "hand";
    while (world.has(name)) name += "'";
    world.add(name, std::move(hand));
    world.attach(name, "tcp", Pose::Identity());
  }
  CheckerOptions scene_only;
  scene_only.check_self = false;
  return CollisionChecker(carrier.chain("root", "tcp"), world, scene_only);
}

/// Of the grasps of these parts that `tables` calls blocked.
void find_blocked_grasps(const PartSupplyProblem& problem, const std::vector<std::pair<int, int>>& parts,
                         const World& world, EvaluatorTables& tables) {
  std::vector<CollisionChecker> originals;
  for (double opening : tables.openings) originals.push_back(hand_checker(problem, opening, world));
  const int threads = resolve_threads(problem.options.threads);
  std::vector<std::vector<CollisionChecker>> checkers(static_cast<std::size_t>(threads));
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(1);
  parallel_for(parts.size(), threads, [&](std::size_t item, int worker) {
    const auto [tray, index] = parts[item];
    const Part& part = part_of(problem, tray, index);
    if (!part.target) return;
    std::vector<CollisionChecker>& own = checkers[worker];
    if (own.empty()) {
      for (const CollisionChecker& checker : originals) own.push_back(checker.clone());
    }
    const std::size_t begin = static_cast<std::size_t>(tables.first[tray][index]);
    for (std::size_t g = 0; g < part.grasps.size(); ++g) {
      if (!tables.blocked[begin + g]) continue;
      CollisionChecker& checker = own[tables.opening[begin + g]];
      checker.set_root(part.T_world_part * part.grasps[g].T_object_hand);
      tables.blocked[begin + g] = !checker.is_free(still);
    }
  });
}

}  // namespace

std::unique_ptr<BasePoseEvaluator::Impl> BasePoseEvaluator::make_impl(const std::shared_ptr<EvaluatorTables>& tables,
                                                                      const World& world) {
  const PartSupplyProblem& problem = *tables->problem;
  find_blocked_grasps(problem, tables->parts, world, *tables);
  CollisionChecker at_rest(problem.arm, world);
  std::vector<CollisionChecker> opened;
  for (double opening : tables->openings) opened.push_back(at_rest.with_group(arm_with_opening(problem, opening)));
  return std::make_unique<Impl>(tables, std::move(at_rest), std::move(opened));
}

BasePoseEvaluator::BasePoseEvaluator(const PartSupplyProblem& problem, const ReachDatabase& database) {
  const std::string difference = database.difference(problem.arm);
  if (!difference.empty()) throw InvalidInput("database: was built for another arm than the problem's: " + difference);
  const std::shared_ptr<EvaluatorTables> tables = make_tables(problem, database);
  tables->parts = all_parts(problem);
  impl_ = make_impl(tables, world_with_parts(problem, tables->parts));
}

BasePoseEvaluator BasePoseEvaluator::without(const std::vector<std::pair<int, int>>& tray_and_part) const {
  const auto tables = std::make_shared<EvaluatorTables>(*impl_->tables);
  World world = impl_->at_rest.world();
  for (const auto& leaving : tray_and_part) {
    const auto it = std::find(tables->parts.begin(), tables->parts.end(), leaving);
    require(it != tables->parts.end(), "part", leaving.second, "must be a part of the tray that is in place");
    tables->parts.erase(it);
    world.remove(part_of(*tables->problem, leaving.first, leaving.second).name);
  }
  return BasePoseEvaluator(make_impl(tables, world));
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
  PartAtPose result;
  result.grasp = impl_->find(base_pose, tray, index, first_grasp, false, result.causes);
  result.feasible = result.grasp >= 0;
  if (result.feasible) {
    result.q = impl_->q;
    result.causes.clear();
  }
  return result;
}

int BasePoseEvaluator::find_grasp(const Eigen::Vector3d& base_pose, int tray, int index, int first_grasp,
                                  std::vector<Rejection>& causes) {
  return impl_->find(base_pose, tray, index, first_grasp, true, causes);
}

bool BasePoseEvaluator::part_with_restarts(const Eigen::Vector3d& base_pose, int tray, int index, int first_grasp) {
  if (part(base_pose, tray, index, first_grasp).feasible) return true;
  const EvaluatorTables& tables = *impl_->tables;
  const Part& part = part_of(*tables.problem, tray, index);
  const int begin = tables.first[tray][index];
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(tray, index, g)) continue;
    CollisionChecker& checker = impl_->checker_at(tables.opening[begin + g], base_pose);
    IkOptions options;
    options.restarts = kCheckRestarts;
    options.time_limit = detail::kNoTimeLimit;
    options.seed = static_cast<unsigned>(g) + 1;
    const IkResult found = solve_ik(tables.arm, T_base_part * part.grasps[g].T_object_hand, tables.problem->home,
                                    options, [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
    if (found.outcome == Outcome::solved) return true;
  }
  return false;
}

bool BasePoseEvaluator::hand_blocked(int tray, int part, int grasp) const {
  const int begin = impl_->tables->first[tray][part];
  return impl_->tables->blocked[begin + grasp] != 0;
}

double BasePoseEvaluator::missing_reach(const Eigen::Vector3d& base_pose, int tray, int index) const {
  const EvaluatorTables& tables = *impl_->tables;
  const Part& part = part_of(*tables.problem, tray, index);
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  double nearest = detail::kInfinity;
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(tray, index, g)) continue;
    const Eigen::Vector3d p = (T_base_part * part.grasps[g].T_object_hand).translation();
    const double outside = std::sqrt(tables.bounds.squaredExteriorDistance(p));
    nearest = std::min(nearest, std::max(outside, p.norm() - tables.reach));
  }
  return std::isfinite(nearest) ? std::max(nearest, 0.0) : 0.0;
}

}  // namespace mmgrasp
