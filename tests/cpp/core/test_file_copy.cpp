#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mmgrasp/core/detail/npy_file.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

/// A file of `size` bytes that count up, gone with this.
struct Counting {
  explicit Counting(std::size_t size)
      : path(std::filesystem::temp_directory_path() / ("counting." + std::to_string(::getpid()))) {
    std::ofstream file(path, std::ios::binary);
    for (std::size_t i = 0; i < size; ++i) file.put(static_cast<char>(i % 251));
  }
  ~Counting() { std::filesystem::remove(path); }
  std::filesystem::path path;
};

bool counts_up(const unsigned char* bytes, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    if (bytes[i] != i % 251) return false;
  }
  return true;
}

TEST(FileCopy, WhatWasCutOffIsMissedAndWhatWasReadStays) {
  constexpr std::size_t kSize = 3'000'000;
  const Counting file(kSize);
  const detail::FileCopy copy(file.path.string(), kSize, 1000);
  ASSERT_FALSE(copy.is_whole());
  copy.read(0, 1'000'000);
  std::filesystem::resize_file(file.path, 500'000);
  EXPECT_TRUE(counts_up(copy.data(), 0, 1'000'000));
  EXPECT_THROW(copy.read(1'000'000, 1'000'001), IoError);
  EXPECT_THROW(copy.read(0, 1'000'000), IoError);
  std::vector<unsigned char> piece(100);
  copy.read_to(piece.data(), 1000, 1100);
  EXPECT_EQ(std::memcmp(piece.data(), copy.data() + 1000, 100), 0);
}

TEST(FileCopy, SmallFilesAreReadAtOnce) {
  const Counting file(1000);
  const detail::FileCopy copy(file.path.string(), 1000, 1000);
  EXPECT_TRUE(copy.is_whole());
  std::filesystem::resize_file(file.path, 0);
  copy.read(0, 1000);  // there already
  EXPECT_TRUE(counts_up(copy.data(), 0, 1000));
}

TEST(FileCopy, AnotherSizeIsRefused) {
  const Counting file(1000);
  EXPECT_THROW(detail::FileCopy(file.path.string(), 999), IoError);
  EXPECT_THROW(detail::FileCopy(file.path.string(), 1001), IoError);
  EXPECT_THROW(detail::FileCopy(file.path.string() + ".none", 1000), IoError);
  EXPECT_THROW(detail::FileCopy("/dev/zero", 1000), IoError);
}

}  // namespace
}  // namespace mmgrasp
