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

void write_file(const std::string& path, const std::string& kind, std::initializer_list<std::string_view> parts) {
  const std::string temporary = path + ".part";
  const auto fail = [&](const std::string& reason) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw IoError(kind + " '" + path + "': " + reason);
  };
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  if (!file) throw IoError(kind + " '" + path + "': cannot be written");
  for (const std::string_view part : parts) file.write(part.data(), static_cast<std::streamsize>(part.size()));
  file.close();
  if (!file) fail("cannot be written whole");
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) fail("cannot be written (" + error.message() + ")");
}

}  // namespace mmgrasp::detail
