#include "mmgrasp/core/detail/file_content.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMostLinks = 40;           // as Linux
constexpr std::size_t kPiece = 8 << 20;  // of files, read and written between two looks for an interruption [bytes]

/// Where a file is really written: links are followed, also to where nothing is yet.
std::filesystem::path link_target(const std::string& path, const std::string& kind) {
  const auto fail = [&](const char* reason) { throw IoError(kind + " '" + path + "': cannot be written: " + reason); };
  std::filesystem::path target = path;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(std::filesystem::symlink_status(target, error)); ++links) {
    if (links == kMostLinks) fail("a loop of links");
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
  }
  const auto status = std::filesystem::status(target, error);
  if (std::filesystem::is_directory(status)) fail("is a folder");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) fail("is no regular file");
  return target;
}

/// Makes an empty file of its own: two that write the same file at once must not write into each other's.
std::string create_beside(const std::filesystem::path& target, const std::string& kind, const std::string& path) {
  static std::atomic<unsigned> count{0};
  for (;;) {
    std::string name = target.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(++count) + ".part";
    const int handle = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (handle >= 0) {
      ::close(handle);
      return name;
    }
    if (errno != EEXIST)
      throw IoError(kind + " '" + path + "': cannot be written (" + std::generic_category().message(errno) + ")");
  }
}

}  // namespace

std::string file_content(const std::string& path, const std::string& kind, std::uintmax_t most) {
  const auto fail = [&](const std::string& reason) { throw IoError(kind + " '" + path + "': " + reason); };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail("does not exist");
  if (std::filesystem::is_directory(status)) fail("is a folder");
  if (!std::filesystem::is_regular_file(status)) fail("is no regular file");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail("cannot be opened");
  const std::streamoff end = file.tellg();  // of what was opened: another file may have its name by now
  if (end < 0) fail("cannot be read");
  const auto size = static_cast<std::uintmax_t>(end);
  if (size > most) fail("is larger than " + std::to_string(most) + " bytes");
  std::string text;
  text.reserve(size);
  file.seekg(0);
  while (text.size() < size && file) {  // it may have been cut short meanwhile
    throw_if_interrupted();
    const std::size_t done = text.size(), piece = std::min<std::size_t>(kPiece, size - done);
    text.resize(done + piece);
    file.read(text.data() + done, static_cast<std::streamsize>(piece));
    text.resize(done + file.gcount());
  }
  if (text.empty()) fail("is empty");
  return text;
}

void write_file(const std::string& path, const std::string& kind, std::initializer_list<std::string_view> parts) {
  const std::filesystem::path target = link_target(path, kind);
  const std::string temporary = create_beside(target, kind, path);
  const auto fail = [&](const std::string& reason) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw IoError(kind + " '" + path + "': cannot be written" + reason);
  };
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  try {
    for (const std::string_view part : parts)
      for (std::size_t at = 0; at < part.size(); at += kPiece) {
        throw_if_interrupted();
        file.write(part.data() + at, static_cast<std::streamsize>(std::min(kPiece, part.size() - at)));
      }
  } catch (const Interrupted&) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
  file.close();
  if (!file) fail(" whole (is the disk full?)");
  std::error_code error;
  std::filesystem::rename(temporary, target, error);
  if (error) fail(" (" + error.message() + ")");
}

}  // namespace mmgrasp::detail
