// STL files, ascii and binary.
#include <cstdint>
#include <cstring>

#include "geometry/readers/mesh_readers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of free text, 4 of triangle count
constexpr std::size_t kTriangleBytes = 50;

RawMesh read_binary_stl(const std::string& path, std::string_view content) {
  if (content.size() < kHeaderBytes) {
    mesh_error(path, "has " + std::to_string(content.size()) + " bytes, a binary STL needs at least 84 (truncated)");
  }
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + 80, 4);
  const std::size_t needed = kHeaderBytes + kTriangleBytes * count;
  if (content.size() < needed) {
    mesh_error(path, "has " + std::to_string(content.size()) + " bytes, its header announces " + std::to_string(count) +
                         " triangles, which need " + std::to_string(needed) + " (truncated, or no STL)");
  }
  RawMesh mesh;
  mesh.vertices.reserve(3 * std::size_t{count});
  mesh.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    float corners[9];
    std::memcpy(corners, content.data() + kHeaderBytes + kTriangleBytes * i + 12, sizeof corners);
    const int first = static_cast<int>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2]);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

void read_facet(WordReader& words, RawMesh& mesh) {
  const auto expect = [&](const char* keyword) {
    const std::string_view word = words.next();
    if (word.empty()) words.fail("ends inside a facet (truncated)");
    if (word != keyword) words.fail("'" + std::string(word.substr(0, 40)) + "' where '" + keyword + "' is due");
  };
  expect("normal");
  for (int k = 0; k < 3; ++k) words.next();  // Normals are recomputed; some writers print nan for them.
  expect("outer");
  expect("loop");
  const int first = static_cast<int>(mesh.vertices.size());
  for (int k = 0; k < 3; ++k) {
    expect("vertex");
    const double x = words.number("a vertex"), y = words.number("a vertex"), z = words.number("a vertex");
    mesh.vertices.emplace_back(x, y, z);
  }
  expect("endloop");
  expect("endfacet");
  mesh.triangles.push_back({first, first + 1, first + 2});
}

RawMesh read_ascii_stl(const std::string& path, std::string_view content) {
  RawMesh mesh;
  WordReader words(path, content);
  bool inside_solid = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "solid") {
      if (inside_solid) words.fail("'solid' inside a solid");
      inside_solid = true;
      words.skip_line();
    } else if (word == "endsolid") {
      inside_solid = false;
      words.skip_line();
    } else if (word == "facet" && inside_solid) {
      read_facet(words, mesh);
    } else {
      words.fail("'" + std::string(word.substr(0, 40)) + "' where 'facet' or 'endsolid' is due");
    }
  }
  if (inside_solid) words.fail("ends without 'endsolid' (truncated)");
  return mesh;
}

// Binary files may start with "solid" too, so the size decides first.
bool is_ascii_stl(std::string_view content) {
  if (content.size() >= kHeaderBytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + 80, 4);
    if (content.size() == kHeaderBytes + kTriangleBytes * count) return false;
  }
  const std::size_t start = content.find_first_not_of(" \t\r\n");
  return start != std::string_view::npos && content.substr(start, 5) == "solid" &&
         content.substr(0, 1000).find('\0') == std::string_view::npos;
}

}  // namespace

RawMesh read_stl(const std::string& path, std::string_view content) {
  return is_ascii_stl(content) ? read_ascii_stl(path, content) : read_binary_stl(path, content);
}

}  // namespace mmgrasp::detail
