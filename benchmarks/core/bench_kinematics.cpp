/// FK + Jacobian of one arm: ours one configuration at a time and in batches, pinocchio and KDL beside it. All are
/// given the same configurations in the same round, and their values are compared before anything is timed.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <memory>
#include <string>
#include <vector>

#include "core/report.hpp"
#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/kinematics_batch.hpp"
#include "support/robot_support.hpp"
#ifdef MMGRASP_WITH_PINOCCHIO
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>
#endif

namespace {

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

constexpr int kConfigurations = 1000;
constexpr int kRounds = 400;
constexpr double kAgree = 1e-10;

/// Values of every configuration, so that no program can leave work out.
struct Answers {
  Poses T{kConfigurations};
  Matrix6Xd J;
};

struct Program {
  std::string who, settings;
  std::function<void(const Eigen::MatrixXd& Q, Answers& answers)> run;
  std::vector<double> times;
};

Program ours_single(const JointGroup& group) {
  return {"mmgrasp", "fk_jacobian, one configuration at a time, " + detail::instruction_sets().front(),
          [group](const Eigen::MatrixXd& Q, Answers& answers) {
            const Eigen::Index n = Q.rows();
            for (Eigen::Index i = 0; i < Q.cols(); ++i)
              group.fk_jacobian(Q.col(i), answers.T[i], answers.J.middleCols(n * i, n));
          }};
}

Program ours_batch(const JointGroup& group) {
  return {"mmgrasp batch", "fk_jacobian_batch of 1000, " + detail::instruction_sets().front(),
          [group](const Eigen::MatrixXd& Q, Answers& answers) { fk_jacobian_batch(group, Q, answers.T, answers.J); }};
}

/// The same on one of the slower instruction sets.
Program on(const std::string& set, Program program) {
  const std::string fastest = detail::instruction_sets().front();
  program.who += ", " + set;
  program.settings = set;
  program.run = [run = program.run, set, fastest](const Eigen::MatrixXd& Q, Answers& answers) {
    detail::use_instruction_set(set);
    run(Q, answers);
    detail::use_instruction_set(fastest);
  };
  return program;
}

Program kdl(const JointGroup& group) {
  const auto chain =
      std::make_shared<const KDL::Chain>(kdl_chain(group.robot(), group.tip_link()));  // solvers refer to it
  const auto fk = std::make_shared<KDL::ChainFkSolverPos_recursive>(*chain);
  const auto jacobian = std::make_shared<KDL::ChainJntToJacSolver>(*chain);
  return {"KDL", "ChainFkSolverPos_recursive and ChainJntToJacSolver 1.5.1",
          [chain, fk, jacobian, q = KDL::JntArray(chain->getNrOfJoints()), J = KDL::Jacobian(chain->getNrOfJoints())](
              const Eigen::MatrixXd& Q, Answers& answers) mutable {
            const Eigen::Index n = Q.rows();
            KDL::Frame frame;
            for (Eigen::Index i = 0; i < Q.cols(); ++i) {
              q.data = Q.col(i);
              fk->JntToCart(q, frame);
              jacobian->JntToJac(q, J);
              Pose& T = answers.T[i];
              T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.M.data);
              T.translation() = Eigen::Map<const Eigen::Vector3d>(frame.p.data);
              T.makeAffine();
              answers.J.middleCols(n * i, n) = J.data;
            }
          }};
}

#ifdef MMGRASP_WITH_PINOCCHIO
/// The arm as pinocchio's own URDF reader would make it, without the joints that the group does not move.
pinocchio::Model arm_model(const JointGroup& group) {
  const Robot& robot = group.robot();
  pinocchio::Model model;
  pinocchio::JointIndex parent = 0;
  Pose fixed = Pose::Identity();  // since the last joint
  const auto placement = [](const Pose& T) { return pinocchio::SE3(T.linear(), T.translation()); };
  std::vector<int> way;
  for (int link = group.tip_link(); link > 0; link = robot.joints()[way.back()].parent_link)
    way.push_back(robot.links()[link].parent_joint);
  for (auto index = way.rbegin(); index != way.rend(); ++index) {
    const Joint& joint = robot.joints()[*index];
    fixed = fixed * joint.T_parent_joint;
    if (joint.type == JointType::fixed) continue;
    const pinocchio::SE3 at = placement(fixed);
    if (joint.axis.isApprox(Eigen::Vector3d::UnitX()))
      parent = model.addJoint(parent, pinocchio::JointModelRX(), at, joint.name);
    else if (joint.axis.isApprox(Eigen::Vector3d::UnitY()))
      parent = model.addJoint(parent, pinocchio::JointModelRY(), at, joint.name);
    else if (joint.axis.isApprox(Eigen::Vector3d::UnitZ()))
      parent = model.addJoint(parent, pinocchio::JointModelRZ(), at, joint.name);
    else
      parent = model.addJoint(parent, pinocchio::JointModelRevoluteUnaligned(joint.axis), at, joint.name);
    fixed = Pose::Identity();
  }
  model.addFrame(pinocchio::Frame("tip", parent, 0, placement(fixed), pinocchio::OP_FRAME));
  return model;
}

/// Two ways to the same values; the table takes the faster one, which differs from machine to machine.
std::vector<Program> pinocchio_programs(const JointGroup& group) {
  const auto model = std::make_shared<pinocchio::Model>(arm_model(group));
  const auto data = std::make_shared<pinocchio::Data>(*model);
  const pinocchio::FrameIndex frame = model->getFrameId("tip");
  const auto finish = [model, data, frame](Eigen::Index i, Answers& answers) {
    Pose& T = answers.T[i];
    T.linear() = data->oMf[frame].rotation();
    T.translation() = data->oMf[frame].translation();
    T.makeAffine();
  };
  const auto with_all_joints = [=](const Eigen::MatrixXd& Q, Answers& answers) {
    const Eigen::Index n = Q.rows();
    for (Eigen::Index i = 0; i < Q.cols(); ++i) {
      pinocchio::computeJointJacobians(*model, *data, Q.col(i));
      pinocchio::updateFramePlacement(*model, *data, frame);
      auto J = answers.J.middleCols(n * i, n);
      J.setZero();
      pinocchio::getFrameJacobian(*model, *data, frame, pinocchio::LOCAL_WORLD_ALIGNED, J);
      finish(i, answers);
    }
  };
  const auto with_support = [=](const Eigen::MatrixXd& Q, Answers& answers) {
    const Eigen::Index n = Q.rows();
    for (Eigen::Index i = 0; i < Q.cols(); ++i) {
      auto J = answers.J.middleCols(n * i, n);
      J.setZero();
      pinocchio::computeFrameJacobian(*model, *data, Q.col(i), frame, pinocchio::LOCAL_WORLD_ALIGNED, J);
      finish(i, answers);  // computeFrameJacobian has placed the frame
    }
  };
  return {{"pinocchio", "computeJointJacobians, updateFramePlacement, getFrameJacobian", with_all_joints},
          {"pinocchio", "computeFrameJacobian", with_support}};
}
#endif

/// Ends the program when two disagree: a wrong answer has no speed.
void compare(const Program& a, const Program& b, const Answers& x, const Answers& y) {
  double worst = (x.J - y.J).cwiseAbs().maxCoeff();
  for (int i = 0; i < kConfigurations; ++i)
    worst = std::max(worst, (x.T[i].matrix() - y.T[i].matrix()).cwiseAbs().maxCoeff());
  if (worst < kAgree) return;
  std::fprintf(stderr, "%s and %s (%s) differ by %g\n", a.who.c_str(), b.who.c_str(), b.settings.c_str(), worst);
  std::exit(1);
}

void measure(const std::string& on_what, const JointGroup& group) {
  std::vector<Program> programs{ours_single(group), ours_batch(group), kdl(group)};
#ifdef MMGRASP_WITH_PINOCCHIO
  for (Program& each : pinocchio_programs(group)) programs.push_back(std::move(each));
#endif
  for (const std::string& set : detail::instruction_sets()) {
    if (set == detail::instruction_sets().front()) continue;
    programs.push_back(on(set, ours_single(group)));
    programs.push_back(on(set, ours_batch(group)));
  }
  Rng rng(1);
  Eigen::MatrixXd Q(group.size(), kConfigurations);
  for (int i = 0; i < kConfigurations; ++i) Q.col(i) = rng.uniform(group.sample_lower(), group.sample_upper());
  std::vector<Answers> answers(programs.size());
  for (std::size_t i = 0; i < programs.size(); ++i) {
    answers[i].J.resize(6, group.size() * kConfigurations);
    programs[i].run(Q, answers[i]);
    compare(programs[0], programs[i], answers[0], answers[i]);
  }
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 0; i < programs.size(); ++i) {
      const double start = bench::now();
      programs[i].run(Q, answers[i]);
      programs[i].times.push_back(bench::now() - start);
    }
  const auto median = [](std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
  };
  std::sort(programs.begin(), programs.end(), [&](const Program& a, const Program& b) {
    return a.who != b.who ? a.who < b.who : median(a.times) < median(b.times);
  });
  for (std::size_t i = 0; i < programs.size(); ++i) {
    Program& program = programs[i];
    if (i > 0 && programs[i - 1].who == program.who) continue;
    const double least = *std::min_element(program.times.begin(), program.times.end());
    bench::print({"FK + Jacobian", on_what, program.who, "us", median(program.times) / kConfigurations * 1e6,
                  "\"least\": " + std::to_string(least / kConfigurations * 1e6), program.settings});
  }
}

}  // namespace

int main() {
  measure("Panda", panda().group("panda_arm"));
  measure("UR5", load_kinematics("robots/ur5_vamp/ur5/ur5.urdf").chain("base_link", "ee_link"));
  measure("UR5e", load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0"));
  return 0;
}
