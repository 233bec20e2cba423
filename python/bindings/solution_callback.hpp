#pragma once

#include <optional>

#include "bindings.hpp"
#include "long_call.hpp"
#include "mmgrasp/plan/improvement.hpp"
#include "options.hpp"
#include "shown.hpp"

namespace mmgrasp::python {

constexpr char kOnSolution[] = "collections.abc.Callable[[mmgrasp._core.Improvement], object] | None";
using OnSolution = Shown<kOnSolution>;

/// Calls Python's `on_solution` from the planning thread; what it raises ends the run and is raised again.
class SolutionCallback {
 public:
  explicit SolutionCallback(const py::object& callback) : callback_(function_argument(callback, "on_solution")) {
    if (callback_.is_none()) return;
    const py::module_ inspect = py::module_::import("inspect");
    try {
      const py::object signature = inspect.attr("signature")(callback_);
      signature.attr("bind")(py::none());
    } catch (const py::error_already_set& error) {
      // Built-in functions may have no signature to look at, which is a ValueError.
      if (!error.matches(PyExc_TypeError)) return;
      throw InvalidInput("on_solution = " + std::string(py::repr(callback_)) +
                         ": must take one argument, an Improvement with its path and cost (not path and cost)");
    }
  }

  /// Runs `work`, given the monitor and what to tell of better solutions, as a long call. What the callback raised goes
  /// before how the call, which it stopped, ended.
  template <typename Work>
  auto run(const Progress& progress, Work&& work) {
    try {
      auto result = LongCall(progress).run([&](const Monitor& monitor) { return work(monitor, function(monitor)); });
      raise();
      return result;
    } catch (const detail::Interrupted&) {
      raise();
      throw;
    }
  }

 private:
  ImprovementCallback function(const Monitor& monitor) {
    if (callback_.is_none()) return {};
    return [this, stop = monitor.stop](const Improvement& better) mutable {
      const py::gil_scoped_acquire gil;
      if (error_) return;
      try {
        callback_(better);
      } catch (py::error_already_set& error) {
        error_.emplace(std::move(error));
        stop.stop();
      }
    };
  }
  void raise() {
    if (error_) throw std::move(*error_);
  }

  py::object callback_;
  std::optional<py::error_already_set> error_;
};

}  // namespace mmgrasp::python
