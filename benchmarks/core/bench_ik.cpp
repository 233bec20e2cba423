// Inverse kinematics: 10,000 random reachable poses a robot, the same seed configurations for everyone, every answer
// judged by KDL's forward kinematics and the joint limits.
//
//   bench_ik                    mmgrasp and KDL's LMA, in this process
//   bench_ik --poses FOLDER     writes <robot>.poses for baselines_ik.py (one line a pose: 16 entries row by row, the
//   seed) bench_ik --answers FOLDER   judges the <robot>.<baseline>.answers that baselines_ik.py wrote (a line: time
//   [us], q) bench_ik --branches FOLDER  judges <robot>.<baseline>.branches, found on FOLDER/<robot>.urdf: every branch
//   a baseline finds
//                               must be among ours
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "core/report.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::kdl_chain;
using testing_support::load_kinematics;
using testing_support::to_kdl;

namespace {

constexpr int kPoses = 10000;
constexpr double kPositionTolerance = 1e-5, kRotationTolerance = 1e-4;  // [m], [rad]

struct Case {
  std::string name;
  JointGroup group;
  Pose T_world_base;  // baselines are asked in the frame of the chain's base link
  std::vector<Eigen::VectorXd> seeds;
  Poses poses;
};

Case make_case(const std::string& name, const Robot& robot, const std::string& base, const std::string& tip) {
  const JointGroup group = robot.chain(base, tip);
  const Pose T_world_base = robot.link_poses(robot.default_values())[robot.link_index(base)];
  Case c{name, group, T_world_base, {}, {}};
  Rng rng(2026);
  for (int i = 0; i < kPoses; ++i) {
    c.poses.push_back(group.fk(rng.uniform(group.sample_lower(), group.sample_upper())));
    c.seeds.push_back(rng.uniform(group.sample_lower(), group.sample_upper()));
  }
  return c;
}

std::vector<Case> cases() {
  return {make_case("panda", load_kinematics("robots/panda/moveit_resources_panda_description/urdf/panda.urdf"),
                    "panda_link0", "panda_link8"),
          make_case("ur5", load_kinematics("robots/ur5_vamp/ur5/ur5.urdf"), "base_link", "ee_link")};
}

/// Right by KDL's forward kinematics; limits are looked at apart, since KDL's solver does not know them.
class Judge {
 public:
  explicit Judge(const JointGroup& group)
      : group_(group), chain_(kdl_chain(group.robot(), group.tip_link())), fk_(chain_) {}

  bool right(const Eigen::VectorXd& q, const Pose& target) {
    if (q.size() != group_.size() || !q.allFinite()) return false;
    KDL::JntArray joints(static_cast<unsigned>(q.size()));
    joints.data = q;
    KDL::Frame frame;
    if (fk_.JntToCart(joints, frame) < 0) return false;
    const KDL::Twist error = KDL::diff(frame, to_kdl(target));
    return error.vel.Norm() <= 1.001 * kPositionTolerance && error.rot.Norm() <= 1.001 * kRotationTolerance;
  }

 private:
  JointGroup group_;
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive fk_;
};

/// What one program answered: `times` [us] of every call, solved or not; how many poses are right, and also inside
/// limits.
struct Score {
  std::vector<double> times;
  int right = 0, inside = 0;

  void add(double time, const Eigen::VectorXd& q, const Case& c, std::size_t i, Judge& judge) {
    times.push_back(time);
    const bool good = judge.right(q, c.poses[i]);
    right += good;
    inside += good && c.group.within_limits(q, 1e-6);
  }
};

void report(const Case& c, const std::string& who, Score score, const std::string& more, const std::string& settings) {
  std::vector<double>& times = score.times;
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) { return times[share * (times.size() - 1)]; };
  double sum = 0;
  for (const double time : times) sum += time;
  std::ostringstream members;
  members << std::setprecision(6) << "\"success\": " << static_cast<double>(score.inside) / times.size()
          << ", \"pose right\": " << static_cast<double>(score.right) / times.size() << ", \"p99\": " << at(0.99)
          << ", \"mean\": " << sum / times.size() << ", \"worst\": " << times.back() << more;
  bench::print({"ik", c.name, who, "us", at(0.5), members.str(), settings});
}

void run_ours(const Case& c) {
  Judge judge(c.group);
  Score score;
  Rejections causes;
  for (int i = 0; i < kPoses; ++i) {
    const double start = bench::now();
    const IkResult result = solve_ik(c.group, c.poses[i], c.seeds[i]);
    score.add(1e6 * (bench::now() - start), result.q, c, i, judge);
    if (result.outcome != Outcome::solved) causes += result.rejections;
  }
  report(c, "mmgrasp", score, ", \"failed descents\": \"" + causes.summary() + "\"",
         "defaults, random seed configuration, calls checked and confirmed");
}

void run_kdl(const Case& c) {
  Judge judge(c.group);
  const KDL::Chain chain = kdl_chain(c.group.robot(), c.group.tip_link());
  // The rotation's weight makes eps mean 1e-4 rad beside 1e-5 m.
  Eigen::Matrix<double, 6, 1> weights;
  weights << 1, 1, 1, 0.1, 0.1, 0.1;
  KDL::ChainIkSolverPos_LMA solver(chain, weights, 1e-5);
  KDL::JntArray seed(chain.getNrOfJoints()), q(chain.getNrOfJoints());
  Score score;
  for (int i = 0; i < kPoses; ++i) {
    const KDL::Frame target = to_kdl(c.poses[i]);
    seed.data = c.seeds[i];
    const double start = bench::now();
    const int code = solver.CartToJnt(seed, target, q);
    const double time = 1e6 * (bench::now() - start);
    for (Eigen::Index j = 0; j < q.data.size(); ++j) q.data[j] = std::remainder(q.data[j], 2 * M_PI);
    score.add(time, code < 0 ? Eigen::VectorXd() : q.data, c, i, judge);
  }
  report(c, "KDL LMA", score, "",
         "eps 1e-5, rotation weighted 0.1, 500 iterations; knows no limits, angles wrapped after");
}

void write_poses(const Case& c, const std::filesystem::path& folder) {
  std::ofstream file(folder / (c.name + ".poses"));
  file << std::setprecision(17);
  for (int i = 0; i < kPoses; ++i) {
    const Pose T_base_tip = c.T_world_base.inverse() * c.poses[i];
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) file << T_base_tip.matrix()(row, column) << ' ';
    for (const double value : c.seeds[i]) file << value << ' ';
    file << '\n';
  }
}

/// The lines of a file as numbers; the first, "# who|settings", says whose they are.
struct Rows {
  std::string who, settings;
  std::vector<std::vector<double>> numbers;
};

Rows read_rows(const std::filesystem::path& path) {
  std::ifstream file(path);
  Rows rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] == '#') {
      rows.who = line.substr(2, line.find('|') - 2);
      rows.settings = line.substr(line.find('|') + 1);
      continue;
    }
    std::istringstream numbers(line);
    rows.numbers.emplace_back();
    for (double value; numbers >> value;) rows.numbers.back().push_back(value);
  }
  return rows;
}

/// Files <robot>.<anything><extension>.
std::vector<std::filesystem::path> files_of(const std::string& robot, const std::filesystem::path& folder,
                                            const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == extension && entry.path().stem().string().rfind(robot + ".", 0) == 0)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void judge_answers(const Case& c, const std::filesystem::path& folder) {
  Judge judge(c.group);
  for (const auto& path : files_of(c.name, folder, ".answers")) {
    const Rows rows = read_rows(path);
    Score score;
    for (std::size_t i = 0; i < rows.numbers.size(); ++i) {
      const std::vector<double>& row = rows.numbers[i];
      score.add(row.at(0), Eigen::Map<const Eigen::VectorXd>(row.data() + 1, row.size() - 1), c, i, judge);
    }
    report(c, rows.who, score, "", rows.settings);
  }
}

/// With `all_turns` whole turns tell configurations apart.
double branch_distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, bool all_turns) {
  double largest = 0;
  for (Eigen::Index i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(all_turns ? a[i] - b[i] : std::remainder(a[i] - b[i], 2 * M_PI)));
  return largest;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Lines of a branches file: number of the pose, the pose row by row, time of the call [us], q (or nothing). For arms
/// of seven joints only times and counts are compared: both programs choose the redundant joint's values themselves.
void judge_branches(const std::string& robot, const std::filesystem::path& folder, bool all_turns) {
  const std::vector<std::filesystem::path> files = files_of(robot, folder, all_turns ? ".windings" : ".branches");
  const char* task = all_turns ? "ik, all branches in all turns" : "ik, all branches";
  if (files.empty()) return;
  RobotOptions options;
  options.load_meshes = false;
  const Robot arm = Robot::load((folder / (robot + ".urdf")).string(), "", options);
  const JointGroup group = arm.chain("l0", arm.links().back().name);
  Judge judge(group);
  for (const auto& path : files) {
    struct Theirs {
      Pose target;
      double time;
      std::vector<Eigen::VectorXd> branches;
    };
    std::map<int, Theirs> calls;
    const Rows rows = read_rows(path);
    for (const std::vector<double>& row : rows.numbers) {
      Theirs& call = calls[static_cast<int>(row.at(0))];
      call.target.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(row.data() + 1);
      call.time = row.at(17);
      const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(row.data() + 18, row.size() - 18);
      if (judge.right(q, call.target)) call.branches.push_back(q);
    }
    std::size_t found = 0, ours = 0, missed = 0, wrong = 0;
    std::vector<double> our_times, their_times;
    for (const auto& [i, call] : calls) {
      const double start = bench::now();
      const IkBranches answer = solve_ik_branches(group, call.target, {}, {}, 0, {}, all_turns);
      our_times.push_back(1e6 * (bench::now() - start));
      their_times.push_back(call.time);
      found += call.branches.size();
      ours += answer.solutions.size();
      for (const Eigen::VectorXd& q : answer.solutions) wrong += !judge.right(q, call.target);
      if (group.size() > 6) continue;
      for (const Eigen::VectorXd& q : call.branches) {
        bool known = false;
        for (const Eigen::VectorXd& other : answer.solutions)
          known = known || branch_distance(q, other, all_turns) < 1e-3;
        missed += !known;
      }
    }
    const double poses = static_cast<double>(calls.size());
    bench::print({task, robot, rows.who, "us", median(their_times), "\"branches\": " + std::to_string(found / poses),
                  rows.settings});
    bench::print({task, robot, "mmgrasp", "us", median(our_times),
                  "\"branches\": " + std::to_string(ours / poses) + ", \"missed\": " + std::to_string(missed) +
                      ", \"wrong\": " + std::to_string(wrong),
                  (all_turns ? "all_turns, on the arm of " : "defaults, on the arm of ") + rows.who});
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const Case& c : cases()) {
    if (argc == 3 && !std::strcmp(argv[1], "--poses")) {
      write_poses(c, argv[2]);
    } else if (argc == 3 && !std::strcmp(argv[1], "--answers")) {
      judge_answers(c, argv[2]);
    } else if (argc == 3 && !std::strcmp(argv[1], "--branches")) {
      for (const bool all_turns : {false, true}) judge_branches(c.name, argv[2], all_turns);
    } else {
      run_ours(c);
      run_kdl(c);
    }
  }
}
