#pragma once

#include <tinyxml.h>
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <set>
#include <string>
#include <utility>

namespace mmgrasp::verify::detail {

/// A URDF as urdfdom reads it. This urdfdom knows no capsules: they stand here as cylinders and are named.
struct UrdfDocument {
  urdf::ModelInterfaceSharedPtr model;
  std::set<std::pair<std::string, std::size_t>> capsules;  ///< Link, index of the collision element.
};

/// Throws InvalidInput with the origin and urdfdom's own words. What the check does not look at (visuals, masses,
/// transmissions, ...) is cut out first, so that only what matters can be refused; limits without effort or velocity,
/// which urdfdom refuses, get 0.
UrdfDocument read_urdf(const std::string& urdf, const std::string& origin);

/// Parses a text whose root element is <robot>; throws InvalidInput naming the origin and the line.
void parse_robot_xml(const std::string& text, const std::string& origin, TiXmlDocument& document);

}  // namespace mmgrasp::verify::detail
