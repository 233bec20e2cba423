#include "verify/robot/urdf_document.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>
#include <initializer_list>
#include <mutex>
#include <vector>

#include "mmgrasp/core/detail/xml_markup.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::verify::detail {
namespace {

/// Collects what urdfdom would print, which is the only place where it says why it refuses a file.
class ErrorCollector : public console_bridge::OutputHandler {
 public:
  ErrorCollector() : before_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~ErrorCollector() override { console_bridge::useOutputHandler(before_); }
  ErrorCollector(const ErrorCollector&) = delete;
  ErrorCollector& operator=(const ErrorCollector&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors += (errors.empty() ? "" : "; ") + text;
  }

  std::string errors;

 private:
  console_bridge::OutputHandler* before_;
};

void keep_children(TiXmlElement& element, const std::set<std::string>& names) {
  for (TiXmlNode* node = element.FirstChild(); node;) {
    TiXmlNode* next = node->NextSibling();
    if (!node->ToElement() || !names.count(node->ValueStr())) element.RemoveChild(node);
    node = next;
  }
}

/// XML says that line breaks and tabs in an attribute are blanks; tinyxml leaves them, and urdfdom stumbles over them.
void clean_attributes(TiXmlElement& element) {
  for (TiXmlAttribute* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next()) {
    std::string value = attribute->ValueStr();
    for (char& c : value) {
      if (c == '\t' || c == '\r' || c == '\n') c = ' ';
    }
    const std::size_t first = value.find_first_not_of(' ');
    value = first == std::string::npos ? "" : value.substr(first, value.find_last_not_of(' ') - first + 1);
    attribute->SetValue(value);
  }
  for (TiXmlElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) clean_attributes(*e);
}

void prepare_link(TiXmlElement& link, UrdfDocument& out) {
  keep_children(link, {"collision"});
  std::size_t index = 0;
  for (TiXmlElement* e = link.FirstChildElement(); e; e = e->NextSiblingElement(), ++index) {
    keep_children(*e, {"origin", "geometry"});
    TiXmlElement* geometry = e->FirstChildElement("geometry");
    TiXmlElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
    if (!shape || shape->ValueStr() != "capsule") continue;
    shape->SetValue("cylinder");
    if (const char* name = link.Attribute("name")) out.capsules.emplace(name, index);
  }
}

void prepare_joint(TiXmlElement& joint) {
  keep_children(joint, {"parent", "child", "origin", "axis", "limit", "mimic"});
  const char* type = joint.Attribute("type");
  const std::string kind = type ? type : "";
  if (kind == "fixed" || kind == "floating") keep_children(joint, {"parent", "child", "origin"});
  for (TiXmlElement* e = joint.FirstChildElement("limit"); e; e = e->NextSiblingElement("limit")) {
    for (const char* attribute : {"effort", "velocity"}) {
      if (!e->Attribute(attribute)) e->SetAttribute(attribute, "0");
    }
  }
}

}  // namespace

void parse_robot_xml(const std::string& text, const std::string& origin, TiXmlDocument& document) {
  if (const auto fault = mmgrasp::detail::find_markup_fault(text))
    throw InvalidInput(origin + ":" + std::to_string(fault->line) + ": not well-formed XML: " + fault->reason);
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error())
    throw InvalidInput(origin + ":" + std::to_string(document.ErrorRow()) +
                       ": not well-formed XML: " + document.ErrorDesc());
  const TiXmlElement* root = document.RootElement();
  if (!root || root->ValueStr() != "robot") throw InvalidInput(origin + ": has no root element <robot>");
}

UrdfDocument read_urdf(const std::string& urdf, const std::string& origin) {
  TiXmlDocument xml;
  parse_robot_xml(urdf, origin, xml);
  UrdfDocument out;
  TiXmlElement& root = *xml.RootElement();
  clean_attributes(root);
  keep_children(root, {"link", "joint"});
  for (TiXmlElement* e = root.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) prepare_link(*e, out);
  for (TiXmlElement* e = root.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) prepare_joint(*e);
  TiXmlPrinter printer;
  xml.Accept(&printer);

  static std::mutex one_at_a_time;  // urdfdom's messages go through one place for the whole process
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  ErrorCollector collector;
  try {
    out.model = urdf::parseURDF(printer.CStr());
  } catch (const std::exception& error) {
    collector.log(error.what(), console_bridge::CONSOLE_BRIDGE_LOG_ERROR, "", 0);
  }
  if (!out.model || !out.model->getRoot()) {
    throw InvalidInput(origin +
                       ": urdfdom refuses it: " + (collector.errors.empty() ? "it gives no reason" : collector.errors));
  }
  return out;
}

}  // namespace mmgrasp::verify::detail
