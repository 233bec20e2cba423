#include "trajopt/tool_terms.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

Quaterniond pure(const Vector3d& v) {
  return {0, v.x(), v.y(), v.z()};
}

/// Steps in the order of a term's variables: the chain reads configurations by column.
VectorXd by_column(const ToolChain& chain, const double* x) {
  int size = 0;
  for (const auto& step : chain.steps()) size = std::max(size, step.column + 1);
  VectorXd q = VectorXd::Zero(size);
  for (std::size_t i = 0; i < chain.steps().size(); ++i) q[chain.steps()[i].column] = x[i];
  return q;
}

ToolChain::State placed(const ToolChain& chain, const double* x) {
  ToolChain::State state;
  chain.evaluate(by_column(chain, x).data(), state);
  return state;
}

}  // namespace

ToolPoseTerm::ToolPoseTerm(std::shared_ptr<const ToolChain> chain, const ToolConstraint& constraint)
    : chain_(std::move(chain)),
      R_target_world_(constraint.T_world_tip.linear().transpose()),
      p_target_(constraint.T_world_tip.translation()),
      target_world_(Quaterniond(constraint.T_world_tip.linear()).conjugate()) {
  kind = "task";
  waypoint = constraint.waypoint;
  for (int i = 0; i < 6; ++i)
    if (std::isfinite(constraint.lower[i]) || std::isfinite(constraint.upper[i])) axes_.push_back(i);
  lower.resize(static_cast<Eigen::Index>(axes_.size()));
  upper.resize(lower.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    lower[static_cast<Eigen::Index>(i)] = constraint.lower[axes_[i]];
    upper[static_cast<Eigen::Index>(i)] = constraint.upper[axes_[i]];
  }
}

void ToolPoseTerm::value(const double* x, double* out) const {
  const ToolChain::State s = placed(*chain_, x);
  const Vector3d p = R_target_world_ * (s.p - p_target_);
  const Vector3d r = 2 * (target_world_ * s.rotation).vec();
  for (int axis : axes_) *out++ = axis < 3 ? p[axis] : r[axis - 3];
}

void ToolPoseTerm::jacobian(const double* x, double* out) const {
  const ToolChain::State s = placed(*chain_, x);
  const std::size_t n = s.v.size();
  for (std::size_t j = 0; j < n; ++j) {
    const Vector3d p = R_target_world_ * s.v[j];
    const Vector3d r = (target_world_ * pure(s.w[j]) * s.rotation).vec();
    for (std::size_t i = 0; i < axes_.size(); ++i) out[i * n + j] = axes_[i] < 3 ? p[axes_[i]] : r[axes_[i] - 3];
  }
}

void ToolPoseTerm::hessian(const double* x, const double* multipliers, double* out) const {
  const ToolChain::State s = placed(*chain_, x);
  Vector3d along = Vector3d::Zero(), about = Vector3d::Zero();
  for (std::size_t i = 0; i < axes_.size(); ++i)
    (axes_[i] < 3 ? along[axes_[i]] : about[axes_[i] - 3]) += multipliers[i];
  const Vector3d d = R_target_world_.transpose() * along;
  const int n = static_cast<int>(s.v.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      // Step j lies nearer to the base.
      const std::size_t a = j, b = i;
      const Quaterniond turned = pure(s.w[a]) * (pure(s.w[b]) * s.rotation);
      *out++ = d.dot(ToolChain::second(s, a, b)) + 0.5 * about.dot((target_world_ * turned).vec());
    }
  }
}

/// Columns of the configuration's velocity: value of each, and for a diff-drive how x and y follow from v and theta.
struct ToolVelocityTerm::Motion {
  ToolChain::State s;
  VectorXd rate;  ///< Velocity of each step.
  double c = 1, sn = 0;
  Vector3d velocity = Vector3d::Zero();
};

ToolVelocityTerm::ToolVelocityTerm(std::shared_ptr<const ToolChain> chain, bool diff_drive,
                                   const Eigen::Matrix3Xd& directions)
    : chain_(std::move(chain)), diff_drive_(diff_drive), directions_(directions) {
  kind = "tool speed";
}

ToolVelocityTerm::Motion ToolVelocityTerm::motion(const double* x) const {
  Motion m;
  m.s = placed(*chain_, x);
  const Eigen::Index n = static_cast<Eigen::Index>(m.s.v.size());
  const double* drive = x + n;
  m.rate.resize(n);
  if (diff_drive_) {
    m.c = std::cos(x[2]);
    m.sn = std::sin(x[2]);
    m.rate[0] = drive[0] * m.c;
    m.rate[1] = drive[0] * m.sn;
    for (Eigen::Index i = 2; i < n; ++i) m.rate[i] = drive[i - 1];
  } else {
    for (Eigen::Index i = 0; i < n; ++i) m.rate[i] = drive[i];
  }
  for (Eigen::Index i = 0; i < n; ++i) m.velocity += m.s.v[i] * m.rate[i];
  return m;
}

void ToolVelocityTerm::value(const double* x, double* out) const {
  const Motion m = motion(x);
  if (directions_.cols() == 0) {
    *out = m.velocity.squaredNorm();
    return;
  }
  for (Eigen::Index i = 0; i < directions_.cols(); ++i) out[i] = directions_.col(i).dot(m.velocity);
}

namespace {

/// d velocity / d variables.
Eigen::Matrix3Xd velocity_jacobian(const ToolChain::State& s, const VectorXd& rate, bool diff_drive, double c,
                                   double sn, double v) {
  const std::size_t n = s.v.size();
  const Eigen::Index drives = static_cast<Eigen::Index>(n) - (diff_drive ? 1 : 0);
  Eigen::Matrix3Xd J = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(n) + drives);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      J.col(static_cast<Eigen::Index>(a)) +=
          ToolChain::second(s, std::min(a, b), std::max(a, b)) * rate[static_cast<Eigen::Index>(b)];
  Eigen::Index at = static_cast<Eigen::Index>(n);
  if (diff_drive) {
    J.col(2) += v * (-sn * s.v[0] + c * s.v[1]);
    J.col(at++) = c * s.v[0] + sn * s.v[1];
  }
  for (std::size_t a = diff_drive ? 2 : 0; a < n; ++a) J.col(at++) = s.v[a];
  return J;
}

}  // namespace

void ToolVelocityTerm::jacobian(const double* x, double* out) const {
  const Motion m = motion(x);
  const Eigen::Index n = m.rate.size();
  const Eigen::Matrix3Xd J = velocity_jacobian(m.s, m.rate, diff_drive_, m.c, m.sn, x[n]);
  if (directions_.cols() == 0) {
    Eigen::Map<VectorXd>(out, J.cols()) = 2 * J.transpose() * m.velocity;
    return;
  }
  for (Eigen::Index i = 0; i < directions_.cols(); ++i)
    Eigen::Map<VectorXd>(out + i * J.cols(), J.cols()) = J.transpose() * directions_.col(i);
}

MatrixXd ToolVelocityTerm::curvature(const double* x, const Motion& m, const Vector3d& d) const {
  const std::size_t n = m.s.v.size();
  const Eigen::Index N = static_cast<Eigen::Index>(n), first = diff_drive_ ? 2 : 0;
  MatrixXd H = MatrixXd::Zero(static_cast<Eigen::Index>(variables.size()), static_cast<Eigen::Index>(variables.size()));
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a; b < n; ++b) {
      double sum = 0;
      for (std::size_t c = 0; c < n; ++c) {
        std::size_t o[] = {a, b, c};
        std::sort(o, o + 3);
        sum += d.dot(ToolChain::third(m.s, o[0], o[1], o[2])) * m.rate[static_cast<Eigen::Index>(c)];
      }
      H(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) += sum;
      if (a != b) H(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) += sum;
    }
    for (std::size_t b = first; b < n; ++b) {
      const Eigen::Index row = N + static_cast<Eigen::Index>(b) - (diff_drive_ ? 1 : 0),
                         col = static_cast<Eigen::Index>(a);
      const double cross = d.dot(ToolChain::second(m.s, std::min(a, b), std::max(a, b)));
      H(row, col) += cross;
      H(col, row) += cross;
    }
  }
  if (diff_drive_) {
    const double v = x[N], across = d.dot(-m.sn * m.s.v[0] + m.c * m.s.v[1]);
    H(2, 2) += v * d.dot(-m.c * m.s.v[0] - m.sn * m.s.v[1]);
    H(2, N) += across;
    H(N, 2) += across;
  }
  return H;
}

void ToolVelocityTerm::hessian(const double* x, const double* multipliers, double* out) const {
  const Motion m = motion(x);
  MatrixXd H;
  if (directions_.cols() == 0) {
    const Eigen::Matrix3Xd J = velocity_jacobian(m.s, m.rate, diff_drive_, m.c, m.sn, x[m.rate.size()]);
    H = 2 * multipliers[0] * (J.transpose() * J) + curvature(x, m, 2 * multipliers[0] * m.velocity);
  } else {
    Vector3d d = Vector3d::Zero();
    for (Eigen::Index i = 0; i < directions_.cols(); ++i) d += multipliers[i] * directions_.col(i);
    H = curvature(x, m, d);
  }
  for (Eigen::Index i = 0; i < H.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) *out++ = H(i, j);
}

}  // namespace mmgrasp::detail
