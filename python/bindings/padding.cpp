#include "padding.hpp"

namespace mmgrasp::python {
namespace {

bool is_mapping(const py::handle& value) {
  return PyMapping_Check(value.ptr()) != 0 && py::hasattr(value, "keys");
}

std::map<std::string, double> by_name_argument(const py::handle& value) {
  if (!is_mapping(value)) refuse_value("padding['by_name']", value, "a dict of names and numbers");
  std::map<std::string, double> by_name;
  for (const auto& [key, padding] : py::dict(py::reinterpret_borrow<py::object>(value))) {
    const std::string name = py::str(key);
    convert(padding, "padding['by_name']['" + name + "']", by_name[name]);
  }
  return by_name;
}

}  // namespace

Padding padding_argument(const py::object& value) {
  Padding padding;
  if (!is_mapping(value)) {
    convert(value, "padding", padding.links);
    padding.check();
    return padding;
  }
  for (const auto& [key, entry] : py::dict(value)) {
    const std::string name = py::str(key);
    if (name == "links")
      convert(entry, "padding['links']", padding.links);
    else if (name == "attached")
      convert(entry, "padding['attached']", padding.attached);
    else if (name == "objects")
      convert(entry, "padding['objects']", padding.objects);
    else if (name == "by_name")
      padding.by_name = by_name_argument(entry);
    else
      throw InvalidInput("padding['" + name + "']: unknown key" +
                         nearest_name(name, {"links", "attached", "objects", "by_name"}));
  }
  padding.check();
  return padding;
}

PaddingDict padding_dict(const Padding& padding) {
  using namespace py::literals;
  const py::dict out("links"_a = padding.links, "attached"_a = padding.attached, "objects"_a = padding.objects,
                     "by_name"_a = padding.by_name);
  return py::reinterpret_borrow<PaddingDict>(out);
}

World padded(const World& world, const OptionalPadding& padding) {
  World out = world;
  if (!padding.is_none()) out.set_padding(padding_argument(padding));
  return out;
}

}  // namespace mmgrasp::python
