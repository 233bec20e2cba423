#pragma once

namespace mmgrasp::detail {

/// Keeps PCL's own lines off standard error while it lives: that nothing fits some points is an answer here, no error.
/// PCL has one level for the whole process: calls in several threads share it, and the last that ends puts back what
/// was there.
class QuietPcl {
 public:
  QuietPcl();
  ~QuietPcl();
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;
};

}  // namespace mmgrasp::detail
