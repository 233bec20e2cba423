#include "structure/object_path/grasp_front.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>

namespace mmgrasp::detail {
namespace {

using Eigen::Array3d;

/// FeasibleGrasp and ObjectPathResult call them alike.
template <typename Costs>
Array3d objectives(const Costs& found) {
  return {found.joint_motion, found.deflection, found.force_manipulability};
}

/// The n-th of van der Corput's numbers in (0, 1).
double halton(int n, int base) {
  double value = 0, digit = 1;
  for (; n > 0; n /= base) value += (digit /= base) * (n % base);
  return value;
}

/// Evenly over all weights that sum to one; the corners first.
Array3d weights_of(int number) {
  if (number < 3) return Eigen::Vector3d::Unit(number).array();
  const double a = halton(number - 2, 2), b = halton(number - 2, 3);
  return {std::min(a, b), std::abs(a - b), 1 - std::max(a, b)};
}

}  // namespace

std::vector<int> pareto_front(const std::vector<FeasibleGrasp>& all) {
  std::vector<Array3d> costs;
  for (const FeasibleGrasp& each : all) costs.push_back(objectives(each));
  std::vector<int> order(all.size());
  std::iota(order.begin(), order.end(), 0);
  // Whoever beats another comes before it in this order.
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::lexicographical_compare(costs[a].begin(), costs[a].end(), costs[b].begin(), costs[b].end());
  });
  std::vector<int> front;
  for (const int i : order) {
    const bool beaten = std::any_of(front.begin(), front.end(),
                                    [&](int k) { return (costs[k] <= costs[i]).all() && (costs[k] < costs[i]).any(); });
    if (!beaten) front.push_back(i);
  }
  return front;
}

std::vector<std::function<double(const ObjectPathResult&)>> front_objectives(const std::vector<FeasibleGrasp>& known,
                                                                             int count) {
  Array3d least = objectives(known.front()), most = least;
  for (const FeasibleGrasp& each : known) {
    least = least.min(objectives(each));
    most = most.max(objectives(each));
  }
  const Array3d scale = (most > least).select((most - least).max(1e-300).inverse(), 0.0);
  std::vector<std::function<double(const ObjectPathResult&)>> out;
  for (int i = 0; i < count; ++i) {
    out.emplace_back([least, scale, weights = weights_of(i)](const ObjectPathResult& found) {
      constexpr double kOthers = 0.01;  // share of the plain sum, so that nothing is given away for nothing
      const Array3d away = (objectives(found) - least) * scale;
      return (weights * away).maxCoeff() + kOthers * away.sum();
    });
  }
  return out;
}

}  // namespace mmgrasp::detail
