#include "mmgrasp/core/detail/npy_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "mmgrasp/core/detail/crc32.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

std::uint64_t NpyLayout::payload_bytes() const {
  std::uint64_t bytes = item_bytes;
  for (const std::uint64_t extent : shape) bytes *= extent;
  return bytes;
}

std::string NpyLayout::header() const {
  std::string text = "{'descr': '" + dtype + "', 'fortran_order': False, 'shape': (";
  for (std::size_t i = 0; i < shape.size(); ++i) text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  text += shape.size() == 1 ? ",), }" : "), }";
  // Room for any number of rows: the count is only known once all are written.
  constexpr std::size_t kHeader = 192, kPrefix = 10;
  text.resize(std::max(kHeader - kPrefix, (text.size() + 1 + kPrefix + 63) / 64 * 64 - kPrefix) - 1, ' ');
  text += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(text.size() & 0xff);
  out += static_cast<char>(text.size() >> 8);
  return out + text;
}

NpyWriter::NpyWriter(const std::string& path, const std::string& named, const NpyLayout& layout)
    : path_(path), named_(named), layout_(layout) {
  file_ = std::fopen(path.c_str(), "wb");
  if (file_ == nullptr) throw IoError(named_ + ": cannot write (" + std::strerror(errno) + ")");
  const std::string header = layout_.header();
  header_bytes_ = header.size();
  first_chunk_.assign(header.begin(), header.end());
  if (std::fwrite(header.data(), 1, header.size(), file_) != header.size()) refuse();
  file_bytes_ = header.size();
}

NpyWriter::~NpyWriter() {
  if (file_ != nullptr) std::fclose(file_);
}

void NpyWriter::refuse() const {
  throw IoError(named_ + ": cannot write all of it (" + std::strerror(errno) + ")");
}

void NpyWriter::sum(const unsigned char* bytes, std::size_t size) {
  if (checksums_.empty()) {
    const std::size_t part = std::min(size, kChecksumChunk - first_chunk_.size());
    first_chunk_.insert(first_chunk_.end(), bytes, bytes + part);
    bytes += part;
    size -= part;
    if (first_chunk_.size() < kChecksumChunk) return;
    checksums_.push_back(0);  // filled in at the end
  }
  while (size > 0) {
    const std::size_t part = std::min(size, kChecksumChunk - open_bytes_);
    open_sum_ = crc32(bytes, part, open_sum_);
    open_bytes_ += part;
    bytes += part;
    size -= part;
    if (open_bytes_ < kChecksumChunk) return;
    checksums_.push_back(open_sum_);
    open_sum_ = 0;
    open_bytes_ = 0;
  }
}

void NpyWriter::write(const void* bytes, std::size_t size) {
  constexpr std::size_t kPiece = 8 << 20;  // [bytes] between two looks for an interruption
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t left = size; left > 0;) {
    throw_if_interrupted();
    const std::size_t piece = std::min(kPiece, left);
    sum(at, piece);
    if (std::fwrite(at, 1, piece, file_) != piece) refuse();
    file_bytes_ += piece;
    at += piece;
    left -= piece;
  }
}

void NpyWriter::finish(std::uint64_t rows) {
  layout_.shape[0] = rows;
  const std::string header = layout_.header();
  require(header.size() == header_bytes_ && file_bytes_ == header_bytes_ + layout_.payload_bytes(), "rows",
          static_cast<double>(rows), "must be what was written");
  std::copy(header.begin(), header.end(), first_chunk_.begin());
  if (checksums_.empty()) checksums_.push_back(0);
  checksums_[0] = crc32(first_chunk_.data(), first_chunk_.size());
  if (open_bytes_ > 0) checksums_.push_back(open_sum_);
  const bool written = std::fseek(file_, 0, SEEK_SET) == 0 &&
                       std::fwrite(header.data(), 1, header.size(), file_) == header.size() && std::fflush(file_) == 0;
  if (!written) refuse();
  const int closed = std::fclose(file_);
  file_ = nullptr;
  if (closed != 0) refuse();
}

FileCopy::FileCopy(const std::string& path, std::uint64_t bytes, std::uint64_t read_whole) : path_(path), size_(bytes) {
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw IoError(path + ": cannot be opened (" + std::strerror(errno) + ")");
  struct stat status;
  const bool known = ::fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
  const auto found = known ? static_cast<std::uint64_t>(status.st_size) : 0;
  if (!known || found != bytes) {
    ::close(file_);
    if (!known) throw IoError(path + ": not a file");
    throw IoError(path + ": " + (found < bytes ? "truncated: " : "bytes after the end: ") + std::to_string(found) +
                  " bytes, " + std::to_string(bytes) + " expected");
  }
  // Memory is used for what is read only.
  void* at = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) {
    const int failure = errno;
    ::close(file_);
    // Not the file's fault: who replaces damaged files must not take it for one.
    if (failure == ENOMEM) throw Error(path + ": no address space for it: " + std::strerror(failure));
    throw IoError(path + ": no memory for it (" + std::strerror(failure) + ")");
  }
  data_ = static_cast<unsigned char*>(at);
  if (bytes > read_whole) return;
  try {
    read(0, bytes);
  } catch (...) {
    ::munmap(data_, size_);
    ::close(file_);
    throw;
  }
  ::close(file_);
  file_ = -1;
}

FileCopy::~FileCopy() {
  if (file_ >= 0) ::close(file_);
  ::munmap(data_, size_);
}

void FileCopy::read(std::uint64_t first, std::uint64_t end) const {
  if (!is_whole()) read_to(data_ + first, first, end);
}

void FileCopy::read_to(unsigned char* to, std::uint64_t first, std::uint64_t end) const {
  while (first < end) {
    const ::ssize_t got = ::pread(file_, to, end - first, static_cast<::off_t>(first));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw IoError(path_ + ": cannot be read (" + std::strerror(errno) + ")");
    if (got == 0) throw IoError(path_ + ": truncated: no bytes from " + std::to_string(first) + " on any more");
    to += got;
    first += static_cast<std::uint64_t>(got);
  }
}

}  // namespace mmgrasp::detail
