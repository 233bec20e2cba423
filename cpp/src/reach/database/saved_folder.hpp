#pragma once

#include <string>
#include <type_traits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

/// Lets two paths change places in one step for others; false where the file system cannot, or one of them is missing.
bool exchange_places(const std::string& a, const std::string& b);

/// The folder that stands at a path now, held so that it can be told from one that takes its place.
class HeldFolder {
 public:
  explicit HeldFolder(const std::string& path);
  ~HeldFolder();
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;

  /// Whether the path still leads to the same folder, or still to none.
  bool is_still_there() const;

 private:
  std::string path_;
  int handle_ = -1;
};

/// What `load` makes of the files of one folder: where another was saved there meanwhile, files of both may have been
/// read, and it is done again.
template <typename Load>
std::invoke_result_t<Load> load_from_one_folder(const std::string& path, const Load& load) {
  constexpr int kAttempts = 100;  // whoever saves without end leaves a load time sooner or later
  for (int attempt = 1;; ++attempt) {
    const HeldFolder folder(path);
    try {
      auto loaded = load();
      if (folder.is_still_there()) return loaded;
    } catch (const Error&) {
      if (folder.is_still_there() || attempt == kAttempts) throw;
    }
    if (attempt == kAttempts) throw IoError(path + ": was saved again each time it was being read");
  }
}

}  // namespace mmgrasp::detail
