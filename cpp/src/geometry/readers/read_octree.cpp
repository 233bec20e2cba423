// load_octree(): OctoMap files, binary (.bt) and full (.ot).
#include "mmgrasp/geometry/octree.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

#include "geometry/readers/mesh_readers.hpp"
#include "geometry/readers/octree_reader.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr int kDepth = 16;  // OctoMap's trees end here
constexpr std::string_view kBinaryTree = "# Octomap OcTree binary file";
constexpr std::string_view kFullTree = "# Octomap OcTree file";

struct Cell {
  int depth = 0;
  int x = 0, y = 0, z = 0;  // in cells of this depth from the tree's corner

  Cell child(int i) const { return {depth + 1, 2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2 & 1)}; }
};

/// Goes through the tree depth first, as it is stored, and collects the occupied leaves by their depth.
class OctreeReader {
 public:
  OctreeReader(const std::string& path, std::string_view content) : path_(path), content_(content) {}

  std::vector<Voxels> read() {
    check();
    if (leaves_.empty()) fail("holds no occupied leaf");
    std::vector<Voxels> result;
    for (auto it = leaves_.rbegin(); it != leaves_.rend(); ++it) {
      result.push_back({std::make_shared<const std::vector<Eigen::Vector3d>>(std::move(it->second)), edge(it->first)});
    }
    return result;
  }

  /// Goes through the tree.
  void check() {
    read_header();
    if (announced_ == 0) return;
    nodes_ = 1;
    binary_ ? read_binary({}) : read_full({});
    if (nodes_ != announced_) {
      fail("its header announces " + std::to_string(announced_) + " nodes, it holds " + std::to_string(nodes_));
    }
  }

  double resolution() const { return resolution_; }
  bool binary() const { return binary_; }
  long nodes() const { return nodes_; }
  std::size_t data() const { return data_; }

 private:
  [[noreturn]] void fail(const std::string& reason) const { throw IoError("octree file '" + path_ + "': " + reason); }

  double edge(int depth) const { return resolution_ * (1 << (kDepth - depth)); }

  void read_header() {
    const std::string_view first = content_.substr(0, content_.find('\n'));
    binary_ = first.substr(0, kBinaryTree.size()) == kBinaryTree;
    if (!binary_ && first.substr(0, kFullTree.size()) != kFullTree) {
      fail("its first line is neither '" + std::string(kBinaryTree) + "' nor '" + std::string(kFullTree) + "'");
    }
    std::string_view id;
    for (std::size_t begin = first.size() + 1;;) {
      const std::size_t end = content_.find('\n', begin);
      if (end == std::string_view::npos) fail("has no line 'data' after its header (truncated)");
      std::string_view line = content_.substr(begin, end - begin);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      begin = end + 1;
      const std::size_t blank = line.find(' ');
      const std::string_view key = line.substr(0, blank);
      const std::string_view value = blank == std::string_view::npos ? std::string_view() : line.substr(blank + 1);
      if (key == "data") {
        data_ = position_ = begin;
        break;
      }
      if (key == "id") id = value;
      if (key == "res" && !detail::parse_number(value, resolution_)) bad_field(key, value, "must be a number");
      if (key == "size" && !detail::parse_integer(value, announced_)) bad_field(key, value, "must be a whole number");
    }
    if (id != "OcTree") bad_field("id", id, "must be OcTree");
    if (!(resolution_ > 1e-9 && resolution_ < 1e6)) {
      bad_field("res", std::to_string(resolution_), "must be above 1e-9 and below 1e6 m");
    }
  }

  [[noreturn]] void bad_field(std::string_view key, std::string_view value, const char* rule) const {
    fail("header field " + std::string(key) + " = \"" + std::string(value.substr(0, 40)) + "\": " + rule);
  }

  template <typename Value>
  Value next() {
    if (content_.size() - position_ < sizeof(Value)) {
      fail("ends inside the tree, after " + std::to_string(nodes_) + " of " + std::to_string(announced_) +
           " nodes (truncated)");
    }
    Value value;
    std::memcpy(&value, content_.data() + position_, sizeof value);
    position_ += sizeof value;
    return value;
  }

  void enter(const Cell& cell) {
    poll_();
    if (cell.depth == kDepth) fail("has more than 16 levels (damaged)");
  }

  void keep(const Cell& cell) {
    const int half = cell.depth > 0 ? 1 << (cell.depth - 1) : 0;
    const double offset = cell.depth > 0 ? 0.5 : 0.0;
    const Eigen::Vector3d index(cell.x - half + offset, cell.y - half + offset, cell.z - half + offset);
    const Eigen::Vector3d centre = index * edge(cell.depth);
    check_leaf("has an edge of ", edge(cell.depth));
    check_leaf("lies off by ", centre.cwiseAbs().maxCoeff());
    leaves_[cell.depth].push_back(centre);
  }

  void check_leaf(const char* what, double length) const {
    if (length <= kLargestLength) return;
    std::ostringstream text;
    text << "an occupied leaf " << what << length << " m at res = " << resolution_ << " m: must be at most 1e6 m";
    fail(text.str());
  }

  /// Two bits a child: 0 unknown, 1 free, 2 occupied, 3 an inner node that follows.
  void read_binary(const Cell& cell) {
    enter(cell);
    const auto codes = next<std::uint16_t>();
    for (int i = 0; i < 8; ++i) nodes_ += (codes >> 2 * i & 3) != 0;
    for (int i = 0; i < 8; ++i) {
      const int code = codes >> 2 * i & 3;
      if (code == 2) keep(cell.child(i));
      if (code == 3) read_binary(cell.child(i));
    }
  }

  /// Log odds and one bit a child, the children follow.
  void read_full(const Cell& cell) {
    const auto log_odds = next<float>();
    const auto children = next<std::uint8_t>();
    if (!std::isfinite(log_odds)) fail("node " + std::to_string(nodes_) + " holds log odds that are not finite");
    if (children == 0) {
      if (log_odds >= 0) keep(cell);
      return;
    }
    enter(cell);
    for (int i = 0; i < 8; ++i) {
      if ((children >> i & 1) == 0) continue;
      ++nodes_;
      read_full(cell.child(i));
    }
  }

  const std::string& path_;
  std::string_view content_;
  std::size_t position_ = 0, data_ = 0;
  bool binary_ = true;
  double resolution_ = 0;
  long announced_ = -1;
  long nodes_ = 0;
  std::map<int, std::vector<Eigen::Vector3d>> leaves_;  // by depth
  detail::InterruptionPoll poll_;
};

}  // namespace

std::vector<Voxels> detail::parse_octree(const std::string& path, std::string_view content) {
  return OctreeReader(path, content).read();
}

std::vector<Voxels> load_octree(const std::string& path) {
  return detail::parse_octree(path, detail::file_content(path, "octree file"));
}

OctreeFile read_octree_file(const std::string& path) {
  OctreeFile out;
  out.content = detail::file_content(path, "octree file");
  OctreeReader reader(path, out.content);
  reader.check();
  out.resolution = reader.resolution();
  out.binary = reader.binary();
  out.nodes = reader.nodes();
  out.data = reader.data();
  return out;
}

}  // namespace mmgrasp
