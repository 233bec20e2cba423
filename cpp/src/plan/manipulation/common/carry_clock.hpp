#pragma once

#include <chrono>

namespace mmgrasp::detail {

/// Wall-clock time since it was made, without what was left out.
class CarryClock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() - left_out_;
  }
  void leave_out(double seconds) { left_out_ += seconds; }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double left_out_ = 0;
};

}  // namespace mmgrasp::detail
