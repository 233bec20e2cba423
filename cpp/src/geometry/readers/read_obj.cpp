// Wavefront OBJ files.
#include <algorithm>
#include <limits>

#include "geometry/readers/mesh_readers.hpp"

namespace mmgrasp::detail {

namespace {

// Statements that carry no triangles. A word outside this list means that the file is no OBJ or is damaged.
constexpr const char* kIgnored[] = {
    "vt",     "vn",         "vp",        "p",      "l",     "g",    "o",    "s",     "mg",       "usemtl",
    "mtllib", "usemap",     "maplib",    "cstype", "deg",   "bmat", "step", "curv",  "curv2",    "surf",
    "parm",   "trim",       "hole",      "scrv",   "sp",    "end",  "con",  "bevel", "c_interp", "d_interp",
    "lod",    "shadow_obj", "trace_obj", "ctech",  "stech", "call", "csh"};

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Collects vertices and faces line by line; faces with more corners become fans of triangles.
class ObjReader {
 public:
  explicit ObjReader(const std::string& path) : path_(path) {}

  RawMesh read(std::string_view content) {
    std::size_t at = 0;
    while (at < content.size()) {
      const std::size_t end = std::min(content.find('\n', at), content.size());
      ++line_;
      add_line(content.substr(at, end - at));
      at = end + 1;
    }
    if (!continued_.empty()) fail("ends in a continued line (truncated)");
    check_indices();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    mesh_error(path_, "line " + std::to_string(line_) + ": " + reason);
  }

  // A backslash at the end joins a line with the next.
  void add_line(std::string_view line) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    const bool continues = !line.empty() && line.back() == '\\' && line.front() != '#';
    if (continues) line.remove_suffix(1);
    if (!continues && continued_.empty()) return read_line(line);
    continued_ += std::string(line) + ' ';
    if (continues) return;
    const std::string whole = std::move(continued_);
    continued_.clear();
    read_line(whole);
  }

  void read_line(std::string_view line) {
    poll_();
    const std::vector<std::string_view> words = split(line);
    if (words.empty() || words[0][0] == '#') return;
    if (words[0] == "v") {
      read_vertex(words);
    } else if (words[0] == "f") {
      read_face(words);
    } else if (std::find(std::begin(kIgnored), std::end(kIgnored), words[0]) == std::end(kIgnored)) {
      fail("'" + std::string(words[0].substr(0, 40)) + "' is no OBJ statement");
    }
  }

  void read_vertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) fail("a vertex needs three numbers");
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) {
      if (!parse_number(words[k + 1], v[k])) fail("'" + std::string(words[k + 1].substr(0, 40)) + "' is no number");
    }
    mesh_.vertices.push_back(v);
  }

  void read_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) fail("a face needs three corners");
    std::vector<int> corners;
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[i][0] == '#') break;
      const std::string_view index = words[i].substr(0, words[i].find('/'));
      long value = 0;
      if (!parse_integer(index, value) || value == 0)
        fail("'" + std::string(words[i].substr(0, 40)) + "' is no corner");
      // Negative indices count back from the latest vertex.
      const long corner = value > 0 ? value - 1 : static_cast<long>(mesh_.vertices.size()) + value;
      if (corner < 0) fail("corner " + std::to_string(value) + " points before the first vertex");
      if (corner >= std::numeric_limits<int>::max())
        fail("corner " + std::to_string(value) + " is beyond all vertices");
      corners.push_back(static_cast<int>(corner));
    }
    add_polygon(mesh_, corners);
  }

  // Faces may stand before their vertices, hence only at the end.
  void check_indices() const {
    for (const auto& triangle : mesh_.triangles) {
      for (const int corner : triangle) {
        if (corner >= static_cast<int>(mesh_.vertices.size())) {
          mesh_error(path_, "a face names vertex " + std::to_string(corner + 1) + " of " +
                                std::to_string(mesh_.vertices.size()) + " (truncated or damaged)");
        }
      }
    }
  }

  const std::string& path_;
  RawMesh mesh_;
  std::string continued_;
  int line_ = 0;
  InterruptionPoll poll_;
};

}  // namespace

RawMesh read_obj(const std::string& path, std::string_view content) {
  return ObjReader(path).read(content);
}

}  // namespace mmgrasp::detail
