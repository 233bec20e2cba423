#include "optim/nlp/nearest_kept.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSteps = 8;
constexpr double kDamping = 1e-13;  // Share of the largest entry: rows may repeat each other.
constexpr double kAtBound = 1e-4;   // Constraints this near to a bound are kept where they are.

/// A place on the way, with its constraints.
struct Place {
  VectorXd x, c;
  VectorXd off;  // How far each constraint is beyond its bounds.
  double broken() const { return off.lpNorm<Eigen::Infinity>(); }
};

/// Newton's method for constraints that are off.
class Newton {
 public:
  explicit Newton(NonlinearProblem& problem)
      : problem_(problem), variables_(problem.variable_bounds()), bounds_(problem.constraint_bounds()) {}

  Eigen::Index constraints() const { return bounds_.lower.size(); }

  Place at(const VectorXd& x) const {
    Place place{x, VectorXd(constraints()), {}};
    problem_.constraints(x, place.c);
    place.off = place.c - place.c.cwiseMax(bounds_.lower).cwiseMin(bounds_.upper);
    return place;
  }

  /// Where one step leads; the place itself where it does not help.
  Place next(const Place& from) const {
    Place best = from;
    // Held ones may leave no room to move, free ones may be pushed beyond.
    for (const double hold : {kAtBound, 0.0}) {
      Place place = at(stepped(from, hold));
      if (place.broken() < best.broken()) best = std::move(place);
    }
    return best;
  }

 private:
  /// One step of least length on what is off, with the constraints nearer than `hold` to a bound kept there.
  VectorXd stepped(const Place& from, double hold) const {
    MatrixXd J = movable_jacobian(from.x);
    for (Eigen::Index i = 0; i < constraints(); ++i) {
      const double room = std::min(from.c[i] - bounds_.lower[i], bounds_.upper[i] - from.c[i]);
      if (from.off[i] == 0 && room >= hold) J.row(i).setZero();
    }
    MatrixXd gram = J * J.transpose();
    gram.diagonal().array() += kDamping * gram.diagonal().maxCoeff();
    for (Eigen::Index i = 0; i < constraints(); ++i)
      if (J.row(i).isZero(0)) gram(i, i) = 1;
    return (from.x - J.transpose() * gram.ldlt().solve(from.off)).cwiseMax(variables_.lower).cwiseMin(variables_.upper);
  }

  /// All rows; zero where the variable is at a bound.
  MatrixXd movable_jacobian(const VectorXd& x) const {
    const SparsePattern& pattern = problem_.jacobian_pattern();
    VectorXd values(static_cast<Eigen::Index>(pattern.size()));
    problem_.jacobian(x, values);
    MatrixXd J = MatrixXd::Zero(constraints(), x.size());
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      const int k = pattern.columns[i];
      if (x[k] > variables_.lower[k] && x[k] < variables_.upper[k])
        J(pattern.rows[i], k) += values[static_cast<Eigen::Index>(i)];
    }
    return J;
  }

  NonlinearProblem& problem_;
  const Bounds variables_, bounds_;
};

}  // namespace

VectorXd nearest_kept(NonlinearProblem& problem, const VectorXd& x) {
  const Newton newton(problem);
  if (newton.constraints() == 0) return x;
  Place place = newton.at(x);
  for (int step = 0; step < kSteps && place.broken() > 0; ++step) {
    Place next = newton.next(place);
    if (!(next.broken() < place.broken())) break;
    place = std::move(next);
  }
  return place.x;
}

}  // namespace mmgrasp::detail
