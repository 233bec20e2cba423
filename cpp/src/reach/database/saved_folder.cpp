#include "reach/database/saved_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

namespace mmgrasp::detail {

bool exchange_places(const std::string& a, const std::string& b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  static_cast<void>(a), static_cast<void>(b);
  return false;
#endif
}

// A folder that is held keeps its number (inode) even when it was removed: none that comes later has the same.
HeldFolder::HeldFolder(const std::string& path)
    : path_(path), handle_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}

HeldFolder::~HeldFolder() {
  if (handle_ >= 0) ::close(handle_);
}

bool HeldFolder::is_still_there() const {
  struct stat now {
  }, held{};
  const bool is_there = ::stat(path_.c_str(), &now) == 0 && S_ISDIR(now.st_mode);
  if (handle_ < 0) return !is_there || ::access(path_.c_str(), R_OK) != 0;
  return is_there && ::fstat(handle_, &held) == 0 && now.st_dev == held.st_dev && now.st_ino == held.st_ino;
}

}  // namespace mmgrasp::detail
