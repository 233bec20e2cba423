#include "gripper_design/grasp_pool.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace mmgrasp::detail {

void GraspPool::add(std::vector<FreeGrasp> found, std::size_t fate) {
  for (FreeGrasp& f : found) {
    result_.fates[fate].requirements.push_back(static_cast<int>(result_.requirements.size()));
    result_.requirements.push_back(required_by(f, result_.fates[fate]));
    result_.grasps.push_back(std::move(f.grasp));
    if (with_holdings_) result_.holdings.push_back(f.held);
    ranks_.push_back(f.rank);
    in_reserve_.push_back(std::move(f.in_reserve));
    fate_of_.push_back(fate);
  }
}

void GraspPool::leave_out(int requirement) {
  left_out_.insert(requirement);
  add(undominated(std::exchange(in_reserve_[requirement], {})), fate_of_[requirement]);
}

std::vector<int> GraspPool::left() const {
  std::vector<int> out;
  for (int r = 0; r < static_cast<int>(ranks_.size()); ++r)
    if (left_out_.count(r) == 0) out.push_back(r);
  std::stable_sort(out.begin(), out.end(), [&](int a, int b) { return fate_of_[a] < fate_of_[b]; });
  return out;
}

std::vector<double> GraspPool::values(const std::vector<int>& requirements) const {
  std::vector<GraspRank> order;
  for (const int r : requirements) order.push_back(ranks_[r]);
  std::sort(order.begin(), order.end(), std::greater<>());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  std::vector<double> out;
  for (const int r : requirements) {
    const auto place = std::lower_bound(order.begin(), order.end(), ranks_[r], std::greater<>());
    out.push_back(static_cast<double>(place - order.begin()));
  }
  return out;
}

}  // namespace mmgrasp::detail
