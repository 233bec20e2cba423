#include "mmgrasp/grasp/grasp.hpp"

#include <utility>

namespace mmgrasp {

void Grasp::set_quality(std::vector<QualityFactor> factors) {
  quality_factors = std::move(factors);
  quality = 1;
  for (const QualityFactor& one : quality_factors) quality *= one.factor();
}

}  // namespace mmgrasp
