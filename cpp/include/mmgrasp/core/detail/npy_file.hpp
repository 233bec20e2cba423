#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// What an array file of a database holds: numpy's name of the type and its shape, rows first.
struct NpyLayout {
  std::string dtype;
  std::size_t item_bytes = 0;
  std::vector<std::uint64_t> shape;

  std::uint64_t payload_bytes() const;
  /// Version 1.0 of numpy's format: magic, version, length, dictionary, padded to 64 bytes.
  std::string header() const;
};

/// CRC-32 of each piece of this many bytes of a file, its header included.
constexpr std::size_t kChecksumChunk = std::size_t{1} << 18;

/// Writes an array piece by piece and sums as it goes. Throws IoError naming `named`.
class NpyWriter {
 public:
  NpyWriter(const std::string& path, const std::string& named, const NpyLayout& layout);
  ~NpyWriter();
  NpyWriter(const NpyWriter&) = delete;
  NpyWriter& operator=(const NpyWriter&) = delete;

  void write(const void* bytes, std::size_t size);
  /// Writes the header again with the number of rows that came and closes.
  void finish(std::uint64_t rows);

  const NpyLayout& layout() const { return layout_; }
  std::uint64_t file_bytes() const { return file_bytes_; }
  const std::vector<std::uint32_t>& checksums() const { return checksums_; }

 private:
  void sum(const unsigned char* bytes, std::size_t size);
  [[noreturn]] void refuse() const;

  std::string path_, named_;
  NpyLayout layout_;
  std::FILE* file_ = nullptr;
  std::size_t header_bytes_ = 0;
  std::uint64_t file_bytes_ = 0;
  std::vector<unsigned char> first_chunk_;  ///< Kept: its header is only known at the end.
  std::vector<std::uint32_t> checksums_;
  std::uint32_t open_sum_ = 0;
  std::size_t open_bytes_ = 0;
};

/// Files up to this size are read whole when they are opened.
constexpr std::uint64_t kReadWhole = 256'000'000;

/// The bytes of a file in memory of its own, read whole or, of a larger file, piece by piece when asked for: who cuts
/// the file short or writes into it changes nothing that was read, and what was not is missed by read(). (Of a mapped
/// file, touching what was cut off would end the process.)
class MMGRASP_EXPORT FileCopy {
 public:
  /// Throws IoError when the file is missing or not `bytes` long.
  FileCopy(const std::string& path, std::uint64_t bytes, std::uint64_t read_whole = kReadWhole);
  ~FileCopy();
  FileCopy(const FileCopy&) = delete;
  FileCopy& operator=(const FileCopy&) = delete;

  bool is_whole() const { return file_ < 0; }
  /// Puts these bytes in their place, unless the file was read whole; not while others look at them. Throws IoError
  /// when they are there no longer.
  void read(std::uint64_t first, std::uint64_t end) const;
  /// The same into a buffer, of a file that was not read whole.
  void read_to(unsigned char* to, std::uint64_t first, std::uint64_t end) const;
  const unsigned char* data() const { return data_; }
  std::uint64_t size() const { return size_; }

 private:
  std::string path_;
  unsigned char* data_ = nullptr;
  std::uint64_t size_ = 0;
  int file_ = -1;  ///< Open as long as there is something to read.
};

}  // namespace mmgrasp::detail
