#include "mmgrasp/grasp/grasp.hpp"

#include <utility>

namespace mmgrasp {

void Grasp::set_quality(std::vector<QualityPart> by_name) {
  parts = std::move(by_name);
  quality = 1;
  for (const QualityPart& part : parts) quality *= part.factor();
}

}  // namespace mmgrasp
