#include "verify/robot/srdf_pairs.hpp"

#include <tinyxml.h>

#include <algorithm>

#include "verify/robot/urdf_document.hpp"

namespace mmgrasp::verify::detail {

void read_srdf_pairs(const std::string& srdf, RobotModel& model) {
  if (srdf.empty()) return;
  TiXmlDocument xml;
  parse_robot_xml(srdf, "the robot's SRDF", xml);
  const auto for_each_pair = [&](const char* kind, const auto& apply) {
    for (const TiXmlElement* e = xml.RootElement()->FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      const char *first = e->Attribute("link1"), *second = e->Attribute("link2"), *reason = e->Attribute("reason");
      const int a = first ? model.link_index(first) : -1, b = second ? model.link_index(second) : -1;
      if (a >= 0 && b >= 0 && a != b) apply(RobotModel::Pair(std::minmax(a, b)), std::string(reason ? reason : ""));
    }
  };
  for_each_pair("disable_collisions", [&](const RobotModel::Pair& pair, const std::string& reason) {
    model.disabled[pair] = reason == "Never";
  });
  for_each_pair("enable_collisions",
                [&](const RobotModel::Pair& pair, const std::string&) { model.enabled.insert(pair); });
}

}  // namespace mmgrasp::verify::detail
