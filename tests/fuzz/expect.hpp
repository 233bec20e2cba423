#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

/// What libFuzzer and the replay call. Returns when the input was read or refused as it should be, else ends the
/// process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fuzzing {

inline void expect(bool ok, const std::string& what) {
  if (ok) return;
  std::fprintf(stderr, "fuzzing: broken expectation: %s\n", what.c_str());
  std::abort();
}

/// A refusal must say which file it is about.
inline void expect_names(const std::exception& refusal, const std::string& file) {
  expect(std::string(refusal.what()).find(file) != std::string::npos,
         "the message names " + file + ": " + refusal.what());
}

}  // namespace fuzzing
