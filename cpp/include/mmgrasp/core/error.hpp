#pragma once

#include <stdexcept>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Base of every exception thrown by mmgrasp.
class MMGRASP_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A caller passed something that breaks a rule. The message names field (or file), value and rule.
class MMGRASP_EXPORT InvalidInput : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read, parsed or written. The message names the file and, where known, the place in it.
class MMGRASP_EXPORT IoError : public Error {
 public:
  using Error::Error;
};

/// Throws InvalidInput("<field> = <value>: <rule>") unless `ok`.
MMGRASP_EXPORT void require(bool ok, const std::string& field, const std::string& value, const std::string& rule);
MMGRASP_EXPORT void require(bool ok, const std::string& field, double value, const std::string& rule);

}  // namespace mmgrasp
