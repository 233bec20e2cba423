#pragma once

#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mmgrasp/core/limits.hpp"
#include "options.hpp"

namespace mmgrasp::python {

/// Least and largest value of a number, and its unit. What else must hold is in the options' own check().
struct Bounds {
  double least, most;
  std::string unit;
};

/// An option table that files may set: every number in it has both bounds, or the module does not load. Beyond them
/// nothing useful comes out, and counts fill memory or last for days.
template <typename Options>
class BoundedOptions {
 public:
  BoundedOptions(const std::vector<OptionField<Options>>& fields, std::map<std::string, Bounds> bounds)
      : fields_(fields), bounds_(std::move(bounds)) {
    std::size_t numbers = 0;
    for (const OptionField<Options>& field : fields_) {
      if (field.type != "int" && field.type != "float") continue;
      ++numbers;
      if (bounds_.count(field.name) == 0) throw std::logic_error("option " + field.name + " has no bounds");
    }
    if (numbers != bounds_.size()) throw std::logic_error("bounds of options that are none");
  }

  const std::map<std::string, Bounds>& all() const { return bounds_; }

  /// read_options(), then the bounds.
  Options read(const py::kwargs& keywords, const char* function) const {
    const Options options = read_options(fields_, keywords, function);
    for (const OptionField<Options>& field : fields_) {
      const auto found = bounds_.find(field.name);
      if (found == bounds_.end() || !keywords.contains(field.name.c_str())) continue;
      const double value = py::cast<double>(field.get(options));
      require_within(value, found->second.least, found->second.most, field.name, found->second.unit);
    }
    return options;
  }

  /// {name: (least, most)}.
  py::dict bounds() const {
    py::dict out;
    for (const OptionField<Options>& field : fields_) {
      const auto found = bounds_.find(field.name);
      if (found != bounds_.end()) out[field.name.c_str()] = py::make_tuple(found->second.least, found->second.most);
    }
    return out;
  }

 private:
  const std::vector<OptionField<Options>>& fields_;
  std::map<std::string, Bounds> bounds_;
};

inline constexpr double kMostSeed = std::numeric_limits<unsigned>::max();

}  // namespace mmgrasp::python
