#include "long_call.hpp"

#include <chrono>

namespace mmgrasp::python {

bool LongCall::wait() {
  while (true) {
    bool done = false;
    {
      py::gil_scoped_release release;
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(30), [this] { return done_; });
      done = done_;
    }
    if (done) return true;
    if (PyErr_CheckSignals() != 0) break;
    try {
      hand_over_progress();
    } catch (py::error_already_set& error) {
      error.restore();
      break;
    }
  }
  monitor_.stop.stop();
  return false;
}

void LongCall::hand_over_progress() {
  std::optional<std::pair<std::string, double>> latest;
  {
    std::lock_guard lock(mutex_);
    std::swap(latest, latest_);
  }
  if (latest && !progress_.is_none()) progress_(latest->first, latest->second);
}

}  // namespace mmgrasp::python
