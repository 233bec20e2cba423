// Feeds every file of the given folders to a fuzzer's function, without libFuzzer.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vector>

#include "expect.hpp"

int main(int count, char** arguments) {
  std::vector<std::filesystem::path> files;
  for (int i = 1; i < count; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(arguments[i])) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& path : files) {
    std::cout << path.filename().string() << std::endl;  // flushed: the last line names the file that broke
    std::ifstream file(path, std::ios::binary);
    std::stringstream content;
    content << file.rdbuf();
    fuzzing::expect(static_cast<bool>(file), "can be read");
    const std::string text = content.str();
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  std::cout << files.size() << " files" << std::endl;
  return files.empty() ? 1 : 0;
}
