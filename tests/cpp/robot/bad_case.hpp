#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::test {

/// A text that a reader must refuse, or warn of.
struct BadCase {
  const char* what;
  std::string text;
  std::vector<std::string> reported;  ///< Every one must stand in the message.
};

inline std::string robot_element(const std::string& inside) {
  return "<robot name=\"r\">\n" + inside + "\n</robot>";
}

inline bool holds_all(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == std::string::npos) return false;
  return true;
}

/// Expects that `read(text)` throws InvalidInput for each case, naming the file and all that is to be reported.
template <typename Read>
void expect_refused(const std::vector<BadCase>& cases, const std::string& file, const Read& read) {
  for (const BadCase& bad : cases) {
    std::string message;
    try {
      read(bad.text);
    } catch (const InvalidInput& error) {
      message = error.what();
    }
    ASSERT_NE(message, "") << bad.what << " was accepted";
    EXPECT_TRUE(holds_all(message, {file})) << bad.what << ": " << message;
    EXPECT_TRUE(holds_all(message, bad.reported)) << bad.what << ": " << message;
  }
}

}  // namespace mmgrasp::test
