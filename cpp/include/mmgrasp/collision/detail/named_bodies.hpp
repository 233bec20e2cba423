#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

/// GroupDescription::links and those of the joints that mimic theirs (the second finger of a hand).
MMGRASP_EXPORT std::vector<std::string> links_of(const Robot& robot, const GroupDescription& group);

/// The bodies a name of World::allow() or Padding::by_name means: links, objects and attached objects that bear it, and
/// the links of the SRDF group that does. Throws InvalidInput naming `field`, the name and the nearest known one when
/// nothing bears it.
MMGRASP_EXPORT std::vector<std::string> bodies_named(const Robot& robot, const World& world, const std::string& name,
                                                     const std::string& field);

/// World::allowed() for one robot, groups taken apart. Throws InvalidInput for unknown names.
class MMGRASP_EXPORT AllowedPairs {
 public:
  AllowedPairs(const Robot& robot, const World& world);

  bool empty() const { return pairs_.empty(); }
  bool operator()(const std::string& a, const std::string& b) const;  ///< Whether the pair is listed, in either order.
  const std::set<World::NamePair>& pairs() const { return pairs_; }   ///< The smaller name first.

 private:
  std::set<World::NamePair> pairs_;
};

/// The objects of `world` that none of these links or attached objects may touch, without what the world says of
/// allowed pairs and padding: for quick tests of the hand alone, which may miss collisions but must not invent any.
MMGRASP_EXPORT World objects_never_touched(const Robot& robot, const World& world, const std::set<std::string>& bodies);

/// World::padding() for one robot. Throws InvalidInput for unknown names.
class MMGRASP_EXPORT BodyPadding {
 public:
  BodyPadding(const Robot& robot, const World& world);

  double link(const std::string& name) const { return of(name, padding_.links); }
  double attached(const std::string& name) const { return of(name, padding_.attached); }
  double object(const std::string& name) const { return of(name, padding_.objects); }

 private:
  double of(const std::string& name, double otherwise) const;

  Padding padding_;
  std::map<std::string, double> by_body_;  ///< Groups taken apart.
};

}  // namespace mmgrasp::detail
