#include "mmgrasp/core/error.hpp"

#include <cstdio>

namespace mmgrasp {

void require(bool ok, const std::string& field, const std::string& value, const std::string& rule) {
  if (!ok) throw InvalidInput(field + " = " + value + ": " + rule);
}

void require(bool ok, const std::string& field, double value, const std::string& rule) {
  if (ok) return;
  char text[32];
  std::snprintf(text, sizeof(text), "%.12g", value);
  require(false, field, std::string(text), rule);
}

}  // namespace mmgrasp
