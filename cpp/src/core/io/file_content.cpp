#include "mmgrasp/core/detail/file_content.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMostLinks = 40;  // as Linux

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
  std::string text(size, '\0');
  file.seekg(0);
  file.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(file.gcount()));  // it may have been cut short meanwhile
  if (text.empty()) fail("is empty");
  return text;
}

void write_file(const std::string& path, const std::string& kind, std::initializer_list<std::string_view> parts) {
  const std::filesystem::path target = link_target(path, kind);
  // Two that write the same file at once must not write into each other's.
  std::string temporary = target.string() + ".XXXXXX";
  const int handle = ::mkstemp(temporary.data());
  const auto fail = [&](const std::string& reason) {
    std::error_code ignored;
    if (handle >= 0) std::filesystem::remove(temporary, ignored);
    throw IoError(kind + " '" + path + "': cannot be written" + reason);
  };
  if (handle < 0) fail(" (" + std::generic_category().message(errno) + ")");
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(handle, 0666 & ~mask);
  ::close(handle);
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  for (const std::string_view part : parts) file.write(part.data(), static_cast<std::streamsize>(part.size()));
  file.close();
  if (!file) fail(" whole (is the disk full?)");
  std::error_code error;
  std::filesystem::rename(temporary, target, error);
  if (error) fail(" (" + error.message() + ")");
}

}  // namespace mmgrasp::detail
