// PLY files, ascii and binary.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>

#include "geometry/readers/mesh_readers.hpp"

namespace mmgrasp::detail {

namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little, big };

struct Property {
  std::string name;
  Scalar type = Scalar::float32;
  bool is_list = false;
  Scalar count_type = Scalar::uint8;
};

struct Element {
  std::string name;
  long count = 0;
  std::vector<Property> properties;
};

bool parse_scalar(std::string_view word, Scalar& type) {
  constexpr const char* names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                      {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                      {"float", "float32"}, {"double", "float64"}};
  for (int i = 0; i < 8; ++i) {
    if (word == names[i][0] || word == names[i][1]) {
      type = static_cast<Scalar>(i);
      return true;
    }
  }
  return false;
}

template <class T>
double decode(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap) std::reverse(copy, copy + sizeof(T));
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

/// Reads the header, then the elements it announces one after another; only vertices and faces are kept.
class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view content)
      : path_(path), content_(content), words_(path, content) {}

  RawMesh read() {
    read_header();
    for (const Element& element : elements_) {
      if (element.properties.empty()) continue;
      for (long i = 0; i < element.count; ++i) read_record(element);
    }
    for (const auto& triangle : mesh_.triangles) {
      for (const int corner : triangle) {
        if (corner < 0 || corner >= static_cast<int>(mesh_.vertices.size())) {
          mesh_error(path_,
                     "a face names vertex " + std::to_string(corner) + " of " + std::to_string(mesh_.vertices.size()));
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  /// One entry a line, as PLY has it: assimp, by which a plan is checked, does not end on some that run on.
  void read_header() {
    if (words_.next() != "ply") mesh_error(path_, "does not start with 'ply'");
    end_entry();
    while (true) {
      const std::string_view word = words_.next();
      if (word.empty()) words_.fail("header ends without 'end_header' (truncated)");
      if (word == "end_header") break;
      if (word == "comment" || word == "obj_info") {
        words_.skip_line();
      } else if (word == "format") {
        read_format();
      } else if (word == "element") {
        Element element;
        element.name = std::string(words_.next_in_line());
        if (element.name.empty() || !std::isalpha(static_cast<unsigned char>(element.name.front()))) {
          words_.fail("element '" + element.name.substr(0, 40) + "' must begin with a letter");  // assimp counts by it
        }
        if (!parse_integer(words_.next_in_line(), element.count) || element.count < 0) {
          words_.fail("element '" + element.name + "' has no count");
        }
        elements_.push_back(element);
      } else if (word == "property") {
        read_property();
      } else {
        words_.fail("'" + std::string(word.substr(0, 40)) + "' is no PLY header word");
      }
      end_entry();
    }
    end_entry();
    at_ = std::min(words_.position() + 1, content_.size());
  }

  /// Refuses what the line says beyond its entry, and characters that some readers take for its end.
  void end_entry() {
    const std::string_view more = words_.next_in_line();
    if (!more.empty()) words_.fail("'" + std::string(more.substr(0, 40)) + "' is more than the line may say");
    const std::string_view until = content_.substr(0, words_.position());
    std::string_view line = until.substr(until.rfind('\n') + 1);  // npos + 1 is 0
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' && c != '\t'; };
    if (std::any_of(line.begin(), line.end(), is_control)) words_.fail("a control character in the header");
  }

  void read_format() {
    const std::string_view word = words_.next_in_line();
    if (word == "ascii")
      encoding_ = Encoding::ascii;
    else if (word == "binary_little_endian")
      encoding_ = Encoding::little;
    else if (word == "binary_big_endian")
      encoding_ = Encoding::big;
    else
      words_.fail("format '" + std::string(word.substr(0, 40)) + "' is unknown");
    words_.skip_line();
  }

  void read_property() {
    if (elements_.empty()) words_.fail("a property before the first element");
    Property property;
    std::string_view word = words_.next_in_line();
    property.is_list = word == "list";
    if (property.is_list) {
      if (!parse_scalar(words_.next_in_line(), property.count_type)) words_.fail("unknown list count type");
      word = words_.next_in_line();
    }
    if (!parse_scalar(word, property.type))
      words_.fail("property type '" + std::string(word.substr(0, 40)) + "' is unknown");
    property.name = std::string(words_.next_in_line());
    if (property.name.empty()) words_.fail("a property has no name");
    elements_.back().properties.push_back(property);
  }

  double read_value(Scalar type, const Element& element) {
    if (encoding_ == Encoding::ascii) return words_.number(("element '" + element.name + "'").c_str());
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t size = sizes[static_cast<int>(type)];
    if (at_ + size > content_.size()) mesh_error(path_, "ends in element '" + element.name + "' (truncated)");
    const char* bytes = content_.data() + at_;
    at_ += size;
    const bool swap = encoding_ == Encoding::big;
    switch (type) {
      case Scalar::int8:
        return decode<std::int8_t>(bytes, swap);
      case Scalar::uint8:
        return decode<std::uint8_t>(bytes, swap);
      case Scalar::int16:
        return decode<std::int16_t>(bytes, swap);
      case Scalar::uint16:
        return decode<std::uint16_t>(bytes, swap);
      case Scalar::int32:
        return decode<std::int32_t>(bytes, swap);
      case Scalar::uint32:
        return decode<std::uint32_t>(bytes, swap);
      case Scalar::float32:
        return decode<float>(bytes, swap);
      case Scalar::float64:
        return decode<double>(bytes, swap);
    }
    return 0;
  }

  int read_count(const Property& property, const Element& element) {
    const double count = read_value(property.count_type, element);
    if (!(count >= 0 && count <= 1e6)) mesh_error(path_, "a list in element '" + element.name + "' has a bad length");
    return static_cast<int>(count);
  }

  void read_record(const Element& element) {
    poll_();
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    Eigen::Vector3d vertex = Eigen::Vector3d::Zero();
    for (const Property& property : element.properties) {
      if (property.is_list) {
        std::vector<int> list(read_count(property, element));
        for (int& index : list) index = static_cast<int>(std::clamp(read_value(property.type, element), -1.0, 2e9));
        if (!is_face || (property.name != "vertex_indices" && property.name != "vertex_index")) continue;
        if (list.size() < 3) mesh_error(path_, "a face has " + std::to_string(list.size()) + " corners, needs three");
        add_polygon(mesh_, list);
      } else {
        const double value = read_value(property.type, element);
        if (!is_vertex) continue;
        if (property.name == "x") vertex.x() = value;
        if (property.name == "y") vertex.y() = value;
        if (property.name == "z") vertex.z() = value;
      }
    }
    if (is_vertex) mesh_.vertices.push_back(vertex);
    // Writers exist that append undeclared values; a new record starts on a new line.
    if (encoding_ == Encoding::ascii) words_.skip_line();
  }

  const std::string& path_;
  std::string_view content_;
  WordReader words_;
  InterruptionPoll poll_;
  std::size_t at_ = 0;
  Encoding encoding_ = Encoding::ascii;
  std::vector<Element> elements_;
  RawMesh mesh_;
};

}  // namespace

RawMesh read_ply(const std::string& path, std::string_view content) {
  return PlyReader(path, content).read();
}

}  // namespace mmgrasp::detail
