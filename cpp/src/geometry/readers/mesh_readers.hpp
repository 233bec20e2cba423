#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/mesh_cleaning.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

[[noreturn]] inline void mesh_error(const std::string& path, const std::string& reason) {
  throw IoError("mesh file '" + path + "': " + reason);
}

/// Each reads the whole content of a file; `path` is for messages only (and for `read_dae`, which reads it itself).
RawMesh read_stl(const std::string& path, std::string_view content);
RawMesh read_obj(const std::string& path, std::string_view content);
RawMesh read_ply(const std::string& path, std::string_view content);
RawMesh read_dae(const std::string& path, std::string_view content);

/// load_mesh for a file's content already in memory; the extension of `path` names the format.
std::shared_ptr<const TriangleMesh> parse_mesh(const std::string& path, std::string_view content,
                                               const Eigen::Vector3d& scale, MeshReport* report,
                                               MeshFaults* faults = nullptr);

/// Adds the polygon as a fan of triangles.
void add_polygon(RawMesh& mesh, const std::vector<int>& corners);

/// Splits text into blank-separated words and counts lines on the way.
class WordReader {
 public:
  WordReader(const std::string& path, std::string_view text, int first_line = 1)
      : path_(path), text_(text), line_(first_line) {}

  /// Next word, or an empty view at the end.
  std::string_view next();
  /// Next word of the line that the last one stood in, or an empty view at its end.
  std::string_view next_in_line();
  /// Next word read as a number; anything else is an IoError naming the line.
  double number(const char* what);
  /// Skips the rest of the line the last word stood in.
  void skip_line();
  std::size_t position() const { return position_; }
  int line() const { return line_; }
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const std::string& path_;
  std::string_view text_;
  std::size_t position_ = 0;
  int line_ = 1;
  InterruptionPoll poll_;
};

/// Parses the whole word as a number; false when it is none.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, long& value);

}  // namespace mmgrasp::detail
