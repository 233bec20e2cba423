// read_pcd(): point clouds of PCL, ascii, binary and compressed.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "geometry/readers/mesh_readers.hpp"
#include "geometry/readers/pcd_reader.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr long kMostPoints = 200'000'000;

struct Field {
  std::string name;
  long size = 4;
  char type = 'F';
  long count = 1;
  long offset = 0;       // bytes in a point
  long column = 0;       // words in an ascii row
  std::size_t lane = 0;  // bytes from the start of a compressed block, where fields stand one after another
};

double field_value(const char* bytes, const Field& field) {
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  if (field.type == 'F') return field.size == 4 ? as(float()) : as(double());
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? as(std::int8_t()) : as(std::uint8_t());
    case 2:
      return is_signed ? as(std::int16_t()) : as(std::uint16_t());
    case 4:
      return is_signed ? as(std::int32_t()) : as(std::uint32_t());
    default:
      return is_signed ? as(std::int64_t()) : as(std::uint64_t());
  }
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", i);
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    i = end;
  }
  return words;
}

/// Reads the header, finds where each field lies in a point, then decodes the points in the layout the header names.
class PcdReader {
 public:
  PcdReader(const std::string& path, std::string_view content) : path_(path), content_(content) {}

  PointCloud read() {
    read_header();
    lay_out();
    if (data_ == "ascii") {
      read_ascii();
    } else if (data_ == "binary") {
      read_binary();
    } else if (data_ == "binary_compressed") {
      read_compressed();
    } else {
      fail("DATA = \"" + data_.substr(0, 40) + "\": must be ascii, binary or binary_compressed");
    }
    return std::move(cloud_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw IoError("point cloud file '" + path_ + "': " + reason);
  }

  bool next_line(std::string_view& line) {
    if (position_ >= content_.size()) return false;
    const std::size_t end = std::min(content_.find('\n', position_), content_.size());
    line = content_.substr(position_, end - position_);
    position_ = std::min(end + 1, content_.size());
    ++line_;
    return true;
  }

  long integer(std::string_view word, const char* key, long least, long most) const {
    long value = 0;
    if (!detail::parse_integer(word, value) || value < least || value > most) {
      fail(std::string(key) + " = \"" + std::string(word.substr(0, 40)) + "\": must be a whole number from " +
           std::to_string(least) + " to " + std::to_string(most));
    }
    return value;
  }

  void read_header() {
    std::string_view line;
    while (data_.empty()) {
      if (!next_line(line)) fail("has no line DATA (no point cloud, or truncated)");
      const auto words = words_of(line);
      if (words.empty() || words[0][0] == '#') continue;
      read_entry(words);
    }
    if (fields_.empty()) fail("has no line FIELDS before DATA");
    if (width_ < 0 && points_ < 0) fail("has neither WIDTH nor POINTS");
    if (width_ < 0) width_ = points_;
    if (points_ < 0) points_ = width_ * height_;
    if (width_ * height_ != points_) {
      fail("POINTS = " + std::to_string(points_) + ": must be WIDTH * HEIGHT = " + std::to_string(width_ * height_));
    }
    if (points_ > kMostPoints) fail("POINTS = " + std::to_string(points_) + ": must be at most 200000000");
  }

  void read_entry(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const auto one = [&](long least) {
      if (words.size() < 2) fail(std::string(key) + ": must have a value");
      return integer(words[1], std::string(key).c_str(), least, kMostPoints);
    };
    if (key == "FIELDS" || key == "COLUMNS") {
      fields_.clear();
      for (std::size_t i = 1; i < words.size(); ++i) fields_.push_back({std::string(words[i])});
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      if (words.size() != fields_.size() + 1) {
        fail(std::string(key) + " has " + std::to_string(words.size() - 1) + " entries for " +
             std::to_string(fields_.size()) + " fields");
      }
      for (std::size_t i = 0; i < fields_.size(); ++i) set_property(fields_[i], key, words[i + 1]);
    } else if (key == "WIDTH") {
      width_ = one(0);
    } else if (key == "HEIGHT") {
      height_ = one(1);
    } else if (key == "POINTS") {
      points_ = one(0);
    } else if (key == "VIEWPOINT") {
      read_viewpoint(words);
    } else if (key == "DATA") {
      if (words.size() < 2) fail("DATA: must have a value");
      data_ = std::string(words[1]);
    } else if (key != "VERSION") {
      fail("line " + std::to_string(line_) + ": unknown header entry \"" + std::string(key.substr(0, 40)) + "\"");
    }
  }

  void set_property(Field& field, std::string_view key, std::string_view word) {
    if (key == "SIZE") {
      field.size = integer(word, "SIZE", 1, 8);
    } else if (key == "COUNT") {
      field.count = integer(word, "COUNT", 1, 100'000);
    } else {
      field.type = word.size() == 1 ? word[0] : '?';
    }
  }

  void read_viewpoint(const std::vector<std::string_view>& words) {
    double v[7];
    bool ok = words.size() == 8;
    for (int i = 0; ok && i < 7; ++i) ok = detail::parse_number(words[i + 1], v[i]);
    for (int i = 0; ok && i < 7; ++i) ok = std::isfinite(v[i]) && std::abs(v[i]) < 1e12;
    if (!ok) fail("VIEWPOINT: must be seven numbers (position, quaternion w x y z)");
    const Eigen::Quaterniond turn(v[3], v[4], v[5], v[6]);
    if (!(turn.norm() > 1e-9)) fail("VIEWPOINT: its quaternion must not be zero");
    cloud_.T_world_sensor.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
    cloud_.T_world_sensor.linear() = turn.normalized().toRotationMatrix();
  }

  void lay_out() {
    for (Field& field : fields_) {
      const bool known = (field.type == 'F' && (field.size == 4 || field.size == 8)) ||
                         ((field.type == 'I' || field.type == 'U') &&
                          (field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8));
      if (!known) {
        fail("field " + field.name.substr(0, 40) + ": must be of the type F (4 or 8 bytes), I or U (1, 2, 4 or 8)");
      }
      field.offset = point_bytes_;
      field.column = columns_;
      field.lane = static_cast<std::size_t>(point_bytes_) * points_;
      point_bytes_ += field.size * field.count;
      columns_ += field.count;
    }
    const char* names[] = {"x", "y", "z", "label"};
    for (int k = 0; k < 4; ++k) {
      for (const Field& field : fields_) {
        if (field.name == names[k] && field.count == 1) wanted_[k] = &field;
      }
      if (wanted_[k] == nullptr && k < 3) fail(std::string("FIELDS: must hold ") + names[k] + " once");
    }
    cloud_.width = static_cast<int>(width_);
    cloud_.height = static_cast<int>(height_);
  }

  void add(const double (&value)[4]) {
    poll_();
    Eigen::Vector3d point(value[0], value[1], value[2]);
    if (!point.allFinite()) point.setConstant(std::numeric_limits<double>::quiet_NaN());
    cloud_.points.push_back(point);
    if (wanted_[3] == nullptr) return;
    const bool fits = std::abs(value[3]) <= 2147483647.0;  // false for NaN too
    if (!fits) fail("point " + std::to_string(cloud_.points.size() - 1) + ": its label must fit 32 bits");
    cloud_.labels.push_back(static_cast<int>(value[3]));
  }

  void read_ascii() {
    std::string_view line;
    while (next_line(line)) {
      const auto words = words_of(line);
      if (words.empty()) continue;
      if (static_cast<long>(words.size()) != columns_) {
        fail("line " + std::to_string(line_) + ": has " + std::to_string(words.size()) + " numbers, must have " +
             std::to_string(columns_));
      }
      double value[4] = {};
      for (int k = 0; k < 4; ++k) {
        if (wanted_[k] == nullptr) continue;
        const std::string_view word = words[wanted_[k]->column];
        if (!detail::parse_number(word, value[k])) {
          fail("line " + std::to_string(line_) + ": '" + std::string(word.substr(0, 40)) + "' is no number");
        }
      }
      add(value);
    }
    const long rows = static_cast<long>(cloud_.points.size());
    if (rows < points_) truncated(rows);
    if (rows == points_) return;
    if (height_ > 1) fail(count_message(rows) + " (an organised cloud must have as many as announced)");
    cloud_.warning = count_message(rows);
    cloud_.width = static_cast<int>(rows);
  }

  std::string count_message(long rows) const {
    return "the header announces " + std::to_string(points_) + " points, the file holds " + std::to_string(rows);
  }
  [[noreturn]] void truncated(long rows) const { fail(count_message(rows) + " (truncated)"); }

  void read_binary() {
    const std::string_view bytes = content_.substr(position_);
    const long whole = static_cast<long>(bytes.size() / point_bytes_);
    if (whole < points_) truncated(whole);
    for (long i = 0; i < points_; ++i) {
      double value[4] = {};
      for (int k = 0; k < 4; ++k) {
        if (wanted_[k] != nullptr)
          value[k] = field_value(bytes.data() + i * point_bytes_ + wanted_[k]->offset, *wanted_[k]);
      }
      add(value);
    }
  }

  void read_compressed() {
    std::uint32_t sizes[2];
    if (content_.size() - position_ < sizeof sizes) fail("ends before its compressed block (truncated)");
    std::memcpy(sizes, content_.data() + position_, sizeof sizes);
    const std::string_view packed = content_.substr(position_ + sizeof sizes);
    if (packed.size() < sizes[0]) {
      fail("announces " + std::to_string(sizes[0]) + " compressed bytes, holds " + std::to_string(packed.size()) +
           " (truncated)");
    }
    const std::size_t wanted = static_cast<std::size_t>(point_bytes_) * points_;
    if (sizes[1] != wanted) {
      fail("announces " + std::to_string(sizes[1]) + " bytes once unpacked: must be " + std::to_string(wanted) +
           " for its points");
    }
    std::string bytes;
    if (!detail::unpack_lzf(packed.substr(0, sizes[0]), wanted, bytes)) fail("its compressed block is damaged");
    for (long i = 0; i < points_; ++i) {
      double value[4] = {};
      for (int k = 0; k < 4; ++k) {
        if (wanted_[k] == nullptr) continue;
        value[k] = field_value(bytes.data() + wanted_[k]->lane + i * wanted_[k]->size, *wanted_[k]);
      }
      add(value);
    }
  }

  const std::string& path_;
  std::string_view content_;
  std::size_t position_ = 0;
  int line_ = 0;
  std::vector<Field> fields_;
  const Field* wanted_[4] = {};
  long width_ = -1, height_ = 1, points_ = -1;
  long point_bytes_ = 0, columns_ = 0;
  std::string data_;
  PointCloud cloud_;
  detail::InterruptionPoll poll_;
};

}  // namespace

bool detail::unpack_lzf(std::string_view packed, std::size_t size, std::string& out) {
  out.clear();
  // A copy of three bytes gives at most 264: what cannot fill the size is refused before memory is taken for it.
  if (size / 100 > packed.size()) return false;
  out.reserve(size);
  for (std::size_t i = 0; i < packed.size();) {
    const auto control = static_cast<unsigned char>(packed[i++]);
    if (control < 32) {
      const std::size_t run = control + 1u;
      if (packed.size() - i < run || size - out.size() < run) return false;
      out.append(packed.substr(i, run));
      i += run;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (i >= packed.size()) return false;
      length += static_cast<unsigned char>(packed[i++]);
    }
    if (i >= packed.size()) return false;
    const std::size_t distance = ((control & 31u) << 8) + static_cast<unsigned char>(packed[i++]) + 1u;
    length += 2;
    if (distance > out.size() || size - out.size() < length) return false;
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - distance]);  // may overlap itself
  }
  return out.size() == size;
}

PointCloud detail::parse_pcd(const std::string& path, std::string_view content) {
  return PcdReader(path, content).read();
}

PointCloud read_pcd(const std::string& path) {
  return detail::parse_pcd(path, detail::file_content(path, "point cloud file"));
}

}  // namespace mmgrasp
