// What would help an operation that no gripper can do: single changes, each tried before it is told.
#include "gripper_design/advice.hpp"

#include <algorithm>
#include <optional>

#include "gripper_design/millimetres.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSlightly = 1e-4;   // The least of something does not help when it is smaller by this [m].
constexpr double kThinnest = 1e-3;   // Thinner fingers are not advised [m].
constexpr double kPrinted = 1e-5;    // Lengths are printed to this [m].
constexpr double kAirBeside = 2e-5;  // Fingers that just touch a wall beside them are refused by a rehearsal [m].
constexpr int kPrintedDigits = 8;

std::string printed(double length) {
  return millimetres(length, kPrintedDigits);
}

std::string of_fingers(int fingers) {
  return "with " + std::to_string(fingers) + " fingers";
}

/// One operation, and whether it can be done with something changed.
class Advice {
 public:
  Advice(const Judgement& by, const Monitor& monitor) : by_(by), monitor_(monitor) {}

  bool helps(const PlanGrippersOptions& options) const { return can_be_done(by(options, by_.actuators), monitor_); }

  bool helps(const std::vector<GripperActuator>& actuators) const {
    return can_be_done(by(by_.options, actuators), monitor_);
  }

  /// An option of another value, where that is no nonsense and helps.
  void try_option(double PlanGrippersOptions::*option, double value, const std::string& text) {
    if (value < 0) return;
    PlanGrippersOptions changed = by_.options;
    changed.*option = value;
    if (changed.longest_finger < changed.shortest_finger || changed.shortest_finger <= 0 || changed.min_contact <= 0)
      return;
    if (helps(changed)) say(text);
  }

  void say(const std::string& text) { said_.push_back(by_.operation.name + ": " + text); }

  std::vector<std::string> said() const { return said_; }

 private:
  Judgement by(const PlanGrippersOptions& options, const std::vector<GripperActuator>& actuators) const {
    return {by_.operation, actuators, options, by_.load, by_.parts, by_.keep_off, by_.untouchable};
  }

  const Judgement& by_;
  const Monitor& monitor_;
  std::vector<std::string> said_;
};

GripperActuator as_printed(GripperActuator drive) {
  drive.name = "that would do";
  drive.stroke = hundredths_up(drive.stroke);
  drive.max_opening = std::max(hundredths_up(drive.max_opening), drive.stroke);
  return drive;
}

std::string text_of(const GripperActuator& drive) {
  return "a drive " + of_fingers(drive.fingers) + ", a stroke of " + printed(drive.stroke) +
         " and an opening of up to " + printed(drive.max_opening) + " would do";
}

std::vector<GripperActuator> with(std::vector<GripperActuator> drives, const GripperActuator& one) {
  drives.push_back(one);
  return drives;
}

/// Whether neither a slightly shorter stroke nor a slightly narrower opening would do.
bool is_least(const Judgement& by, const Advice& advice, const GripperActuator& drive) {
  GripperActuator shorter = drive, narrower = drive;
  shorter.stroke -= kSlightly;
  narrower.max_opening -= kSlightly;
  return !(shorter.stroke > 0 && advice.helps(with(by.actuators, shorter))) &&
         !(narrower.max_opening >= narrower.stroke && advice.helps(with(by.actuators, narrower)));
}

void advise_drives(const Judgement& by, const Remedy& remedy, Advice& advice) {
  for (const auto& [fingers, narrowest] : remedy.drives) {
    const GripperActuator drive = as_printed(narrowest);
    if (advice.helps(with(by.actuators, drive))) advice.say(text_of(drive));
  }
  for (const auto& [fingers, narrowest] : remedy.short_drives) {
    const GripperActuator drive = as_printed(narrowest);
    if (!advice.helps(with(by.actuators, drive))) continue;
    std::string text = text_of(drive);
    if (is_least(by, advice, drive)) text += ", the least";
    advice.say(text + ": its fingers open by " + printed(kept_clearance({drive}, by.options)) + ", not by " +
               printed(by.options.clearance));
  }
}

/// Longer strokes, first the shortest that the margins allow, then that for the whole clearance.
void advise_strokes(const Judgement& by, Advice& advice) {
  const double margin = by.options.opening_margin;
  const double whole = margin + kept_above(by.options.clearance, margin);
  for (std::size_t i = 0; i < by.actuators.size(); ++i) {
    std::vector<GripperActuator> changed = by.actuators;
    GripperActuator& drive = changed[i];
    for (const double stroke : {hundredths_up(2 * margin), hundredths_up(whole)}) {
      if (at_most(stroke, by.actuators[i].stroke) || !at_most(stroke, drive.max_opening)) continue;
      drive.stroke = stroke;
      if (!advice.helps(changed)) continue;
      advice.say("a stroke of " + printed(stroke) + " for '" + drive.name + "' would do");
      break;
    }
  }
}

std::vector<double> smaller(double length) {
  std::vector<double> out;
  for (const double share : {0.5, 0.25, 0.125}) out.push_back(hundredths_down(share * length));
  return out;
}

/// The largest of some values that are smaller than the option's, if one helps.
void advise_less(const Judgement& by, double PlanGrippersOptions::*option, const std::string& name,
                 std::vector<double> values, Advice& advice) {
  std::sort(values.begin(), values.end(), std::greater<>());
  for (const double value : values) {
    if (at_most(by.options.*option, value)) continue;
    const std::size_t before = advice.said().size();
    advice.try_option(option, value, name + printed(value) + " would do");
    if (advice.said().size() > before) return;
  }
}

/// The largest width or thickness of fingers with which the operation can be done, if one does: less of either meets
/// less, so it is found by bisection. `air` is left beside the fingers.
void advise_slimmer(const Judgement& by, double PlanGrippersOptions::*option, const std::string& name, double air,
                    Advice& advice) {
  PlanGrippersOptions changed = by.options;
  const auto helps = [&](double length) {
    changed.*option = length;
    return advice.helps(changed);
  };
  double slim = kThinnest, thick = by.options.*option;
  if (slim >= thick || !helps(slim)) return;
  while (thick - slim > 1.5 * kPrinted) {
    const double between = hundredths_down((slim + thick) / 2);
    (helps(between) ? slim : thick) = between;
  }
  slim = hundredths_down(slim - air);
  if (slim >= kThinnest && helps(slim)) advice.say("fingers " + printed(slim) + " " + name + " would do");
}

}  // namespace

std::vector<std::string> advice_without_grasp(const Judgement& by, const Remedy& remedy, const Monitor& monitor) {
  using O = PlanGrippersOptions;
  Advice advice(by, monitor);
  const double longest = hundredths_up(remedy.longest_finger), shortest = hundredths_down(remedy.shortest_finger);
  const double contact = hundredths_down(remedy.min_contact);
  if (remedy.longest_finger >= 0)
    advice.try_option(&O::longest_finger, longest, "fingers of " + printed(longest) + " would do");
  if (remedy.shortest_finger > 0)
    advice.try_option(&O::shortest_finger, shortest, "fingers as short as " + printed(shortest) + " would do");
  if (remedy.min_contact > 0)
    advice.try_option(&O::min_contact, contact, "a min_contact of " + printed(contact) + " would do");
  advise_slimmer(by, &O::finger_thickness, "thick", 0, advice);
  advise_slimmer(by, &O::finger_width, "wide", kAirBeside, advice);
  advise_drives(by, remedy, advice);
  if (remedy.min_contact <= 0)
    advise_less(by, &O::min_contact, "a min_contact of ", smaller(by.options.min_contact), advice);
  advise_less(by, &O::clearance, "a clearance of ", smaller(by.options.clearance), advice);
  return advice.said();
}

std::vector<std::string> advice_without_drive(const Judgement& by, const Monitor& monitor) {
  using O = PlanGrippersOptions;
  Advice advice(by, monitor);
  advise_strokes(by, advice);
  std::vector<double> margins;
  for (const GripperActuator& a : by.actuators) margins.push_back(hundredths_down(a.stroke / 2));
  advise_less(by, &O::opening_margin, "opening_margin = ", margins, advice);
  return advice.said();
}

}  // namespace mmgrasp::detail
