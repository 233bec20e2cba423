// Checks the list of picks: every target once, nothing that is not there.
#include <algorithm>
#include <set>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// One pick by itself; true when it takes away a part it may take.
bool check_one(const Context& context, std::size_t index, Faults& faults) {
  const CheckedPick& pick = context.plan.picks[index];
  const std::string where = context.pick_name(index);
  const int part_index = context.pick_part[index];
  if (part_index < 0) {
    faults.push_back({"part-unknown", where, "the scene has no part '" + pick.part + "'"});
    return false;
  }
  const CheckedPart& part = context.plan.parts[part_index];
  if (!part.target) faults.push_back({"part-not-target", where, "'" + pick.part + "' is to stay where it is"});
  if (part.tray != pick.tray) {
    faults.push_back(
        {"wrong-tray", where, "the part lies in tray '" + part.tray + "', the pick says '" + pick.tray + "'"});
  }
  if (pick.grasp < 0 || pick.grasp >= static_cast<int>(part.grasps.size())) {
    faults.push_back(
        {"grasp-invalid", where,
         "grasp index " + std::to_string(pick.grasp) + " is outside [0, " + std::to_string(part.grasps.size()) + ")"});
  }
  if (pick.stop < 0 || pick.stop >= static_cast<int>(context.plan.stops.size())) {
    faults.push_back({"wrong-stop", where,
                      "stop index " + std::to_string(pick.stop) + " is outside [0, " +
                          std::to_string(context.plan.stops.size()) + ")"});
  } else if (!contains(context.plan.stops[pick.stop].trays, part.tray)) {
    faults.push_back(
        {"wrong-stop", where, "stop " + std::to_string(pick.stop) + " does not serve tray '" + part.tray + "'"});
  }
  return true;
}

void check_trays(const Context& context, Faults& faults) {
  std::map<std::string, int> served;
  for (std::size_t i = 0; i < context.plan.stops.size(); ++i) {
    for (const std::string& tray : context.plan.stops[i].trays) {
      if (!contains(context.plan.trays, tray)) {
        faults.push_back({"tray-unknown", "stop " + std::to_string(i), "there is no tray '" + tray + "'"});
      }
      if (++served[tray] == 2)
        faults.push_back({"tray-repeated", "stop " + std::to_string(i), "tray '" + tray + "' is served twice"});
    }
  }
  std::set<std::string> wanted;
  for (const CheckedPart& part : context.plan.parts) {
    if (part.target) wanted.insert(part.tray);
  }
  for (const std::string& tray : wanted) {
    if (!served.count(tray))
      faults.push_back({"tray-forgotten", "stops", "no stop serves tray '" + tray + "', which holds target parts"});
  }
}

}  // namespace

double Context::pregrasp_opening(double width) const {
  return std::min(width + 2 * plan.clearance, plan.max_opening);
}

std::string Context::pick_name(std::size_t pick) const {
  return "pick " + std::to_string(pick) + " (" + plan.picks[pick].part + ")";
}

void Context::set_parts_before(Judge& judge, std::size_t pick) const {
  for (std::size_t part = 0; part < plan.parts.size(); ++part) {
    const bool removed = picked_by[part] >= 0 && static_cast<std::size_t>(picked_by[part]) < pick;
    judge.set_present(body_of_part(static_cast<int>(part)), !removed);
  }
}

void check_pick_list(Context& context, Faults& faults) {
  context.pick_part.clear();
  context.picked_by.assign(context.plan.parts.size(), -1);
  int last_stop = -1;
  for (std::size_t i = 0; i < context.plan.picks.size(); ++i) {
    const CheckedPick& pick = context.plan.picks[i];
    const auto found = context.part_index.find(pick.part);
    context.pick_part.push_back(found == context.part_index.end() ? -1 : found->second);
    if (pick.stop < last_stop) {
      faults.push_back({"stop-order", context.pick_name(i),
                        "stop " + std::to_string(pick.stop) + " comes after stop " + std::to_string(last_stop)});
    }
    last_stop = std::max(last_stop, pick.stop);
    if (!check_one(context, i, faults)) continue;
    int& by = context.picked_by[context.pick_part[i]];
    if (by >= 0) {
      faults.push_back(
          {"part-repeated", context.pick_name(i), "the part was already taken by pick " + std::to_string(by)});
    } else {
      by = static_cast<int>(i);
    }
  }
  for (std::size_t part = 0; part < context.plan.parts.size(); ++part) {
    if (context.plan.parts[part].target && context.picked_by[part] < 0) {
      faults.push_back(
          {"part-forgotten", "picks", "target part '" + context.plan.parts[part].body.name + "' is never picked"});
    }
  }
  check_trays(context, faults);
}

}  // namespace mmgrasp::verify::detail
