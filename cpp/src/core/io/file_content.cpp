#include "mmgrasp/core/detail/file_content.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

std::string file_content(const std::string& path, const std::string& kind) {
  const auto fail = [&](const char* reason) { throw IoError(kind + " '" + path + "': " + reason); };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) fail("does not exist");
  if (std::filesystem::is_directory(status)) fail("is a folder");
  if (!std::filesystem::is_regular_file(status)) fail("is no regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail("cannot be opened");
  std::ostringstream content;
  content << file.rdbuf();
  std::string text = content.str();
  if (text.empty()) fail("is empty");
  return text;
}

}  // namespace mmgrasp::detail
