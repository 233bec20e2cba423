#include "mmgrasp/geometry/detail/checked_dae.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "geometry/readers/dae_instances.hpp"
#include "geometry/readers/mesh_readers.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/xml_markup.hpp"
#include "mmgrasp/core/detail/xml_tags.hpp"

namespace mmgrasp::detail {
namespace {

using Names = std::set<std::string_view>;

/// What shapes are made of; all other elements are left out with what is in them.
const Names kKept = {"COLLADA",
                     "asset",
                     "unit",
                     "up_axis",
                     "library_geometries",
                     "geometry",
                     "mesh",
                     "source",
                     "accessor",
                     "technique_common",
                     "param",
                     "float_array",
                     "vertices",
                     "input",
                     "triangles",
                     "polylist",
                     "polygons",
                     "tristrips",
                     "trifans",
                     "p",
                     "vcount",
                     "library_nodes",
                     "node",
                     "scene",
                     "library_visual_scenes",
                     "visual_scene",
                     "matrix",
                     "translate",
                     "rotate",
                     "scale",
                     "skew",
                     "lookat",
                     "instance_node",
                     "ph",
                     "instance_geometry",
                     "instance_controller",
                     "instance_visual_scene"};
const Names kKeptAttributes = {"id",     "url",      "source", "count", "stride",
                               "offset", "semantic", "set",    "meter", "version"};
const Names kPrimitives = {"triangles", "polylist", "polygons", "tristrips", "trifans"};
/// Those that the importer stores; it forgets others, and the places that they take in <p> with them.
const Names kSemantics = {"VERTEX",  "POSITION",   "NORMAL",   "TEXCOORD",   "COLOR",
                          "TANGENT", "TEXTANGENT", "BINORMAL", "TEXBINORMAL"};
const std::map<std::string_view, std::size_t> kTransforms = {
    {"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}, {"lookat", 9}};

struct DaeAccessor {
  std::string_view array;
  std::size_t count = 0, stride = 1, offset = 0, params = 0;
};

struct DaeInput {
  std::string_view semantic, source;
  std::size_t offset = 0;
};

/// One pass over the tags. A list of numbers is judged where its element ends.
class DaeCheck {
 public:
  DaeCheck(const std::string& path, std::string_view content) : path_(path), content_(content) {}

  std::string run() {
    if (const auto found = find_markup_fault(content_))
      mesh_error(path_, "line " + std::to_string(found->line) + ": no valid DAE: " + found->reason);
    out_ = "<?xml version=\"1.0\"?>\n";
    XmlTags tags(content_);
    XmlTag tag;
    while (tags.next(tag)) {
      poll_();
      if (!begins_with_root_)
        begins_with_root_ = true, require(tag.name == "COLLADA", tag, "must be <COLLADA>: no valid DAE");
      if (is_left_out(tag)) continue;
      if (!tag.closes) open(tag);
      if (tag.closes || tag.is_empty) close(tag);
    }
    if (!begins_with_root_) mesh_error(path_, "no valid DAE: holds no <COLLADA>");
    const std::size_t largest = std::max<std::size_t>(content_.size(), 1'000'000);
    if (const std::string fault = instances_.fault(largest); !fault.empty()) mesh_error(path_, fault);
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const XmlTag& tag, const std::string& reason) const {
    const auto line = 1 + std::count(content_.begin(), content_.begin() + static_cast<long>(tag.begin), '\n');
    mesh_error(path_, "line " + std::to_string(line) + ": <" + std::string(tag.name.substr(0, 40)) + "> " + reason);
  }
  void require(bool holds, const XmlTag& tag, const std::string& reason) const {
    if (!holds) fail(tag, reason);
  }

  bool is_left_out(const XmlTag& tag) {
    if (left_out_ == 0 && kKept.count(tag.name)) return false;
    if (tag.closes)
      --left_out_;
    else if (!tag.is_empty)
      ++left_out_;
    return true;
  }

  /// Attributes that are compared or counted hold no references: the importer would read others than are judged here.
  std::string_view plain(const XmlTag& tag, std::string_view key) const {
    const std::string_view value = tag.attribute(key);
    require(value.find_first_of("&<") == std::string_view::npos, tag, std::string(key) + " must hold no '&' or '<'");
    return value;
  }

  std::string_view reference(const XmlTag& tag, std::string_view key) const {
    const std::string_view value = plain(tag, key);
    require(value.size() > 1 && value.front() == '#', tag, std::string(key) + " must be '#' and an id");
    return value.substr(1);
  }

  std::size_t count(const XmlTag& tag, std::string_view key, std::size_t fallback) const {
    const std::string_view value = tag.attribute(key);
    if (value.empty()) return fallback;
    const auto number = index(value);
    require(number.has_value(), tag,
            std::string(key) + " = '" + std::string(value.substr(0, 40)) + "' must be a whole number below 1e9");
    return *number;
  }

  /// Digits only: the importer does not get past anything else.
  static std::optional<std::size_t> index(std::string_view word) {
    long value = 0;
    if (word.size() > 9 || word.find_first_not_of("0123456789") != std::string_view::npos ||
        !parse_integer(word, value))
      return std::nullopt;
    return static_cast<std::size_t>(value);
  }

  void open(const XmlTag& tag) {
    require(tag.name != "instance_controller", tag, "a skin that bends with its bones is no link of a robot");
    require(tag.name != "ph", tag, "polygons with holes are not read");
    require(tag.name != "skew", tag, "of a node is not read: a <matrix> says the same");
    for (const std::string_view key : {"id", "url", "source"}) plain(tag, key);
    const std::string_view id = tag.attribute("id");
    require(id.empty() || ids_.insert(id).second, tag,
            "has the id of another: '" + std::string(id.substr(0, 40)) + "'");
    open_ = tag;
    if (tag.name == "geometry") instances_.begin_geometry(tag.attribute("id"));
    if (tag.name == "mesh") vertex_inputs_.clear(), vertex_id_ = {};
    if (tag.name == "source") source_ = tag.attribute("id");
    if (tag.name == "accessor") read_accessor(tag);
    if (tag.name == "param") ++accessors_[source_].params;
    if (tag.name == "vertices") vertex_id_ = tag.attribute("id");
    if (kPrimitives.count(tag.name)) {
      primitive_ = tag.name;
      primitives_ = count(tag, "count", 0);
      found_ = 0;
      inputs_.clear();
      corners_.reset();
    }
    if (tag.name == "input") read_input(tag);
    if (tag.name == "node" || tag.name == "visual_scene") instances_.begin_node(tag.attribute("id"));
    if (tag.name == "instance_node") instances_.place_node(reference(tag, "url"));
    if (tag.name == "instance_geometry") instances_.place_geometry(reference(tag, "url"));
    within_.push_back(tag.name);
    write(tag);
  }

  void write(const XmlTag& tag) {
    out_ += "<" + std::string(tag.name);
    for (const auto& [key, value] : tag.attributes) {
      if (!kKeptAttributes.count(key) && !(tag.name == "param" && key == "name")) continue;
      const char quote = value.find('"') == std::string_view::npos ? '"' : '\'';
      out_ += " " + std::string(key) + "=" + quote + std::string(value) + quote;
    }
    out_ += ">";
  }

  void close(const XmlTag& tag) {
    within_.pop_back();
    const auto transform = kTransforms.find(tag.name);
    if (tag.name == "float_array") {
      arrays_[open_.attribute("id")] = count(open_, "count", 0);
      require_numbers(tag, count(open_, "count", 0));
    } else if (transform != kTransforms.end()) {
      require_numbers(tag, transform->second);
    } else if (tag.name == "vcount") {
      read_vcount(tag);
    } else if (tag.name == "p") {
      read_indices(tag);
    } else if (kPrimitives.count(tag.name)) {
      const bool is_counted = tag.name != "tristrips" && tag.name != "trifans";  // many write what they like there
      require(!is_counted || found_ == primitives_, tag,
              "holds " + std::to_string(found_) + " where count is " + std::to_string(primitives_));
    } else if (tag.name == "up_axis") {
      out_ += text(tag);
    } else if (tag.name == "node" || tag.name == "visual_scene") {
      instances_.end_node();
    }
    out_ += "</" + std::string(tag.name) + ">\n";
  }

  /// What stands in the element that ends here: nothing but text.
  std::string_view text(const XmlTag& end) const {
    if (end.is_empty) return {};
    const std::string_view found = content_.substr(open_.end, end.begin - open_.end);
    require(found.find_first_of("<&") == std::string_view::npos, open_, "must hold text only");
    return found;
  }

  void require_numbers(const XmlTag& end, std::size_t expected) {
    const std::string_view list = text(end);
    WordReader words(path_, list);
    std::size_t found = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++found) {
      double value = 0;
      if (!parse_number(word, value)) fail(open_, "'" + std::string(word.substr(0, 40)) + "' is no number");
    }
    require(found == expected, open_,
            "holds " + std::to_string(found) + " numbers where " + std::to_string(expected) + " are due");
    out_ += list;
  }

  std::vector<std::size_t> read_indices_of(const XmlTag& end) {
    const std::string_view list = text(end);
    WordReader words(path_, list);
    std::vector<std::size_t> found;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto value = index(word);
      if (!value) fail(open_, "'" + std::string(word.substr(0, 40)) + "' is no index");
      found.push_back(*value);
    }
    out_ += list;
    return found;
  }

  void read_accessor(const XmlTag& tag) {
    accessors_[source_] = {reference(tag, "source"), count(tag, "count", 0), count(tag, "stride", 1),
                           count(tag, "offset", 0), 0};
  }

  void read_input(const XmlTag& tag) {
    const DaeInput input{plain(tag, "semantic"), reference(tag, "source"), count(tag, "offset", 0)};
    if (!kSemantics.count(input.semantic)) return;
    const bool is_of_vertices = !within_.empty() && within_.back() == "vertices";
    (is_of_vertices ? vertex_inputs_ : inputs_).push_back(input);
  }

  void read_vcount(const XmlTag& end) {
    const std::vector<std::size_t> sizes = read_indices_of(end);
    require(!corners_ && sizes.size() == primitives_, open_,
            "holds " + std::to_string(sizes.size()) + " numbers where count is " + std::to_string(primitives_));
    corners_ = 0;
    for (const std::size_t size : sizes) {
      require(size > 0, open_, "names a polygon without corners");
      *corners_ += size;
    }
  }

  void read_indices(const XmlTag& end) {
    const std::size_t found = read_indices_of(end).size();
    if (found == 0) return;
    require(primitives_ > 0, open_, "holds " + std::to_string(found) + " indices where count is 0");
    std::size_t stride = 1, positions = 0;
    bool has_vertices = false;
    for (const auto* inputs : {&vertex_inputs_, &inputs_}) {
      for (const DaeInput& input : *inputs) {
        if (inputs == &inputs_) stride = std::max(stride, input.offset + 1);
        positions += input.semantic == "POSITION";
        if (input.semantic != "VERTEX") require_within_array(input);
      }
    }
    for (const DaeInput& input : inputs_) has_vertices |= input.semantic == "VERTEX" && input.source == vertex_id_;
    require(has_vertices && positions == 1, open_, "has no vertices with one list of positions");
    if (primitive_ == "polylist") require(corners_.has_value(), open_, "must follow a <vcount>");
    const std::size_t corners = found / stride;
    const std::size_t due = primitive_ == "triangles"  ? 3 * primitives_
                            : primitive_ == "polylist" ? corners_.value_or(0)
                                                       : corners;
    require(found == due * stride, open_,
            "holds " + std::to_string(found) + " indices where " + std::to_string(due * stride) + " are due");
    found_ += primitive_ == "polygons" ? 1 : primitives_;
    instances_.add_corners(primitive_ == "tristrips" ? 3 * corners : corners);
  }

  void require_within_array(const DaeInput& input) const {
    const auto accessor = accessors_.find(input.source);
    const std::string name = "source '" + std::string(input.source.substr(0, 40)) + "' ";
    require(accessor != accessors_.end(), open_, name + "is not there");
    const DaeAccessor& a = accessor->second;
    const auto array = arrays_.find(a.array);
    require(array != arrays_.end(), open_, name + "has no <float_array>");
    const std::size_t last = a.offset + (a.count - 1) * a.stride + std::max<std::size_t>(a.params, 1);
    require(a.count == 0 || last <= array->second, open_, name + "reaches beyond its <float_array>");
  }

  const std::string& path_;
  std::string_view content_;
  std::string out_;
  XmlTag open_;                           ///< The last one: lists hold no elements.
  std::vector<std::string_view> within_;  ///< Elements that are open, those left out not among them.
  Names ids_;                             ///< Those seen, each once.
  int left_out_ = 0;                      ///< How deep in what is left out.
  bool begins_with_root_ = false;
  std::map<std::string_view, std::size_t> arrays_;  ///< Numbers of each <float_array>.
  std::map<std::string_view, DaeAccessor> accessors_;
  std::string_view source_, vertex_id_, primitive_;
  std::size_t primitives_ = 0, found_ = 0;  ///< Said by `count`, and held by <p>.
  std::optional<std::size_t> corners_;      ///< Sum of <vcount>.
  std::vector<DaeInput> vertex_inputs_, inputs_;
  DaeInstances instances_;
  InterruptionPoll poll_;
};

}  // namespace

std::string checked_dae(const std::string& path, std::string_view content) {
  return DaeCheck(path, content).run();
}

}  // namespace mmgrasp::detail
