#pragma once

#include <chrono>

namespace mmgrasp::detail {

/// Wall-clock time [s] since it was made, without what was left out.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() - left_out_;
  }
  void leave_out(double seconds) { left_out_ += seconds; }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double left_out_ = 0;
};

/// Expires `limit` seconds of wall-clock time after it was made.
class TimeLimit {
 public:
  explicit TimeLimit(double limit) : limit_(limit) {}
  bool expired() const { return stopwatch_.seconds() > limit_; }
  double seconds_left() const { return limit_ - stopwatch_.seconds(); }

 private:
  double limit_;
  Stopwatch stopwatch_;
};

}  // namespace mmgrasp::detail
