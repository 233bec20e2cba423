#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

thread_local const CancelToken* innermost = nullptr;

}  // namespace

InterruptionScope::InterruptionScope(const CancelToken& stop) : stop_(stop), outer_(innermost) {
  innermost = &stop_;
}

InterruptionScope::~InterruptionScope() {
  innermost = outer_;
}

const CancelToken* interruption_token() {
  return innermost;
}

void throw_if_interrupted() {
  if (innermost != nullptr && innermost->stopped()) throw Interrupted();
}

}  // namespace mmgrasp::detail
