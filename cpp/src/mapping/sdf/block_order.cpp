#include "mapping/sdf/block_order.hpp"

namespace mmgrasp::detail {

std::vector<int> block_order(const std::vector<int>& block, int blocks) {
  std::vector<int> begin(blocks + 2, 0), order(block.size());
  const auto bin = [&](int number) { return number < 0 ? blocks : number; };
  for (const int each : block) ++begin[bin(each) + 1];
  for (int k = 0; k <= blocks; ++k) begin[k + 1] += begin[k];
  for (std::size_t i = 0; i < block.size(); ++i) order[begin[bin(block[i])]++] = static_cast<int>(i);
  return order;
}

}  // namespace mmgrasp::detail
